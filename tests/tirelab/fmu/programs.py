"""What the tests of programs without Python in them share: inputs with the law's forces, and a bare environment."""

from __future__ import annotations

import math
import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

HOSTS = Path(__file__).parent / "hosts"
INPUTS = [(0.02, 1e5), (0.02, 0.254), (0.01, -0.381)]
FORCES = [
    550.9 * 2**1.422,
    (550.9 - 337.8 * math.exp(-0.2519 * 25.4)) * 2 ** (1.422 - 0.2469 * math.exp(-0.1651 * 25.4)),
    550.9 + 7822.0 * math.exp(-0.1398 * 38.1),
]
"""Equations 2, 5 and 6 of the article on flat, convex and concave ground."""

ROWS = "".join(f"{deflection!r} {radius!r}\n" for deflection, radius in INPUTS)
NOT_A_NUMBER = "0.01 1e5\nnan 1e5\n"
TOOLS = ("rm", "unzip")
REFUSAL = "deflection = nan m is not allowed"


def run(
    command: Sequence[str | Path],
    folder: Path,
    *,
    python: bool,
    said: str = "",
    more: Mapping[str, str] | None = None,
) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder; with a native FMU it finds on PATH nothing but what some programs call: `TOOLS`.

    more: variables of the environment
    """
    environment = {**os.environ, **(more or {})}
    if not python:
        (folder / "bin").mkdir(exist_ok=True)
        for tool in TOOLS:
            if not (folder / "bin" / tool).is_symlink():
                (folder / "bin" / tool).symlink_to(shutil.which(tool) or f"/bin/{tool}")
        environment = {"PATH": str(folder / "bin"), "HOME": str(folder), **(more or {})}
    return subprocess.run(
        command, input=said, cwd=folder, capture_output=True, text=True, timeout=120, env=environment
    )


def printed(done: subprocess.CompletedProcess[str], word: str = "forces") -> list[float]:
    """Return the numbers that a host printed behind a word."""
    assert done.returncode == 0, done.stdout + done.stderr
    (line,) = [line for line in done.stdout.splitlines() if line.startswith(f"{word} ")]
    return [float(number) for number in line.split()[1:]]


def compiled(source: str, program: Path, *flags: str, missing: str) -> Path:
    """Compile a host of ours; skip with `missing` where the compiler does not find what it includes or links."""
    compiler = "g++" if source.endswith(".cpp") else "gcc"
    if shutil.which(compiler) is None:
        pytest.skip(f"{compiler} is not on PATH")
    command = [compiler, "-Wall", "-Wextra", "-o", program, HOSTS / source, *flags]
    done = subprocess.run(
        [*command, "-std=c++17"] if compiler == "g++" else command, capture_output=True, text=True
    )
    if "No such file or directory" in done.stderr:
        pytest.skip(missing)
    assert done.returncode == 0, done.stderr
    return program
