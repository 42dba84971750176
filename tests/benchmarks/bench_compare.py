"""How much CPU time `tirelab compare` takes for a million samples: `python tests/benchmarks/bench_compare.py`.

Reading the CSV, packing the tire, the replay of the FMU step by step and the picture, in processes of their own; the
least of several rounds, since a busy machine slows each. At most 5 s are asserted, and 1 GB of memory.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from aims import beside

ROWS = 1_000_000
ROUNDS = 3
MOST_SECONDS = 5.0
MOST_BYTES = 1e9


def write(path: Path) -> None:
    """Write a million samples of one second's cycles to 25 mm, in the house form."""
    time = np.arange(ROWS) / 1000.0
    deflection = 1.25 * (1.0 - np.cos(2.0 * np.pi * time))
    table = np.column_stack([time, deflection, 2000.0 * (deflection / 2.5) ** 1.42])
    np.savetxt(path, table, "%.6g", ",", header="time [s],deflection [cm],force [N]", comments="")


def cpu_seconds(path: Path, out: Path) -> float:
    """Return the CPU time, user and system, of one comparison."""
    before = os.times()
    command = [sys.executable, "-m", "tirelab", "compare", str(path), "--radius", "flat", "--out", str(out)]
    subprocess.run(command, check=True, capture_output=True)
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def main() -> None:
    """Measure, print and assert."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "million.csv"
        write(path)
        seconds = min(cpu_seconds(path, Path(folder)) for _ in range(ROUNDS))
    size = 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    print(f"compare of {ROWS} samples: {beside(seconds, 's', MOST_SECONDS)} of CPU")
    print(f"memory {beside(size / 1e9, 'GB', MOST_BYTES / 1e9)}")
    assert seconds < MOST_SECONDS
    assert size < MOST_BYTES


if __name__ == "__main__":
    main()
