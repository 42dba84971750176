"""Where tirelab stores compiled code between runs.

The folder of the environment variable TIRELAB_CACHE, else in the virtual environment, else in the user's cache folder
(XDG_CACHE_HOME or ~/.cache). What lies there is run, so a folder that anyone else may write to is not used.
"""

from __future__ import annotations

import contextlib
import os
import stat
import sys
import tempfile
from pathlib import Path

PRIVATE = 0o700
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH


def cache_folder() -> Path:
    """Return the folder, whether it exists or not; RuntimeError where the user has no home."""
    own = os.environ.get("TIRELAB_CACHE")
    if own:
        return Path(own)
    if sys.prefix != sys.base_prefix:  # a virtual environment keeps what belongs to it
        return Path(sys.prefix) / "var" / "tirelab"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "tirelab"


def private_folder(name: str) -> Path | None:
    """Return the cache's folder `name`, made where it is missing, or None where it cannot be trusted or written to."""
    try:
        cache = cache_folder()
        cache.parent.mkdir(parents=True, exist_ok=True)
        for folder in (cache, cache / name):
            folder.mkdir(PRIVATE, exist_ok=True)
            if not _only_ours(folder):
                return None
    except (OSError, RuntimeError):
        return None
    return cache / name if os.access(cache / name, os.W_OK) else None


def keep(path: Path, content: bytes) -> bool:
    """Write `content` to `path` so that nobody ever sees half of it, and return whether that was possible."""
    partial = None
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".partial", delete=False) as file:
            partial = Path(file.name)
            file.write(content)
        partial.replace(path)
    except OSError:
        if partial is not None:
            with contextlib.suppress(OSError):
                partial.unlink()
        return False
    return True


def _only_ours(folder: Path) -> bool:
    """Return whether `folder` is the user's own and nobody else may write to it; Windows keeps homes apart itself."""
    if sys.platform == "win32":
        return True
    status = folder.stat()
    return status.st_uid == os.getuid() and not status.st_mode & OTHERS_WRITE
