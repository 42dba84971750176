"""Calls of the Python FMU in any order with any values, also with NULL for every argument."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from loader_bench import HERE, LIBRARY, Bench, guid_of
from tirelab.fmu.loader import Compiler

SECONDS, LONG = 2, 150


@pytest.fixture(scope="module")
def program(bench: Bench, compiler: Compiler, tmp_path_factory: pytest.TempPathFactory) -> Path:
    bench.run("run", 0.01)  # skips where there is no Python library
    found = tmp_path_factory.mktemp("fuzz") / "program"
    library = bench.fmu / LIBRARY
    flags = ["-std=c11", "-g", "-O1", "-DCO_SIMULATION_ONLY", f"-Wl,-rpath,{library.parent}"]
    subprocess.run([*compiler.command, *flags, "-o", found, HERE / "fuzz.c", library, "-lm"], check=True)
    return found


def check(program: Path, fmu: Path, seconds: int) -> None:
    """It lives, takes and refuses, and each refused call told why."""
    command = [program, (fmu / "resources").as_uri(), guid_of(fmu), str(seconds), "1"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-3000:]
    calls, taken, refused, messages = (int(part.split()[0]) for part in done.stdout.split(", "))
    assert calls > 1000
    assert min(taken, refused) > calls // 10
    assert messages > refused // 2


def test_some_seconds(bench: Bench, program: Path) -> None:
    check(program, bench.fmu, SECONDS)


@pytest.mark.slow
def test_some_minutes(bench: Bench, program: Path) -> None:
    check(program, bench.fmu, LONG)
