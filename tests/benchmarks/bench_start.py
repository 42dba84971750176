"""CPU time of an answer without work: `pytest -s tests/benchmarks/bench_start.py` prints the median of nine runs."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import pytest

RUNS = 9


def cpu_seconds(*arguments: str) -> float:
    """Return the CPU time, user and system, of one run of the program."""
    before = os.times()
    subprocess.run([sys.executable, "-m", "tirelab", *arguments], capture_output=True, check=False)
    after = os.times()
    return (after.children_user - before.children_user) + (after.children_system - before.children_system)


@pytest.mark.parametrize("arguments", [("--version",), ("--help",), ("diagnose", "nosuch.csv")], ids=" ".join)
def test_an_answer_without_work_comes_at_once(arguments: tuple[str, ...]) -> None:
    cpu_seconds(*arguments)  # the first run writes bytecode
    median = statistics.median(cpu_seconds(*arguments) for _ in range(RUNS))
    print(f"\ntirelab {' '.join(arguments)}: {median:.3f} s of CPU, median of {RUNS} runs")
    assert median < 0.4


def test_the_local_page_starts_soon(tmp_path: Path) -> None:
    """The address is printed before a heavy library is loaded: soon after a program that does nothing would end."""

    def spent(*words: str) -> float:
        start = time.perf_counter()
        with subprocess.Popen(
            [sys.executable, "-m", "tirelab", *words], stdout=subprocess.PIPE, text=True
        ) as program:
            assert program.stdout is not None
            program.stdout.readline()
            took = time.perf_counter() - start
            program.kill()
        return took

    least = min(spent("--version") for _ in range(3))
    opened = min(spent("open", str(tmp_path / "desk"), "--no-browser") for _ in range(3))
    print(f"\ntirelab --version {least:.2f} s, tirelab open {opened:.2f} s")
    assert opened < 2.0 * least + 0.3
