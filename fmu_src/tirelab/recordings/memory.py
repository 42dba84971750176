"""How much memory there is, so that a file too large for it is refused before it is read."""

import os
from pathlib import Path

ASSUMED = 4 * 2**30
"""The memory [B] counted on where the system does not tell."""


def memory_available() -> int:
    """The memory [B] to be had without swapping: what Linux reports, elsewhere half of what is installed."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, ValueError, OSError):
        return ASSUMED


def readable_size(size: float) -> str:
    """A number of bytes as people write it: 2.1 GB."""
    for unit in ("B", "kB", "MB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size /= 1000
    return f"{size:.3g} GB"
