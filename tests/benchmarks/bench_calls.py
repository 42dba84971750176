"""The Python FMU's calls beside the same law in C (`pytest -s -n 0 tests/benchmarks/bench_calls.py`).

Set two inputs, step, get one output; the least of turns side by side in one run, since a loaded machine only adds to a
time. Each bar is asserted.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from loader_bench import HERE, Bench, numbers, unpacked, unpacked_archive
from radialtire import TireModel
from tirelab.fmu.build import build_fmu
from tirelab.fmu.loader import compile_loader, find_compiler

IN_C, THROUGH_FMPY = 60.0, 1.7
"""The bars: the Python FMU against the law in C, called from C and through fmpy."""

FIRST = 0.15
"""Bar [s] of the first instance in a process; a shell and a second interpreter would take 0.3 to 1.3 s."""


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """The C host, the law in C and a plain slave behind the loader."""
    compiler = find_compiler()
    assert compiler is not None
    folder = tmp_path_factory.mktemp("host")
    program, reference, loader = folder / "host", folder / "native.so", folder / "loader.so"
    flags = [*compiler.command, "-std=c11", "-O2", "-pthread"]
    subprocess.run([*flags, "-o", program, HERE / "host.c", "-ldl", "-lm"], check=True)
    subprocess.run([*flags, "-shared", "-fPIC", "-o", reference, HERE / "native.c", "-lm"], check=True)
    compile_loader(loader, compiler)
    return Bench(program, reference, loader, unpacked(folder / "fmu", loader))


@pytest.fixture(scope="module")
def tire(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the article's tire, unpacked."""
    folder = tmp_path_factory.mktemp("tire")
    return unpacked_archive(build_fmu(TireModel(), folder).path, folder / "fmu")


def test_calls_from_c(host: Bench, tire: Path) -> None:
    for title, fmu in (("plain slave", host.fmu), ("the article's tire", tire)):
        ours, reference, ratio = numbers(host.run("bench", 30_000, host.native, fmu=fmu))
        print(f"\n{title}: {1e9 * ours:.0f} ns, the law in C {1e9 * reference:.0f} ns, ratio {ratio:.1f}")
        assert ratio <= IN_C


def test_calls_through_fmpy(host: Bench, tire: Path, tmp_path: Path) -> None:
    reference = unpacked(tmp_path / "reference", host.native)
    for title, fmu in (("plain slave", host.fmu), ("the article's tire", tire)):
        command = [sys.executable, "-I", HERE / "hosts" / "time_with_fmpy.py", fmu, reference]
        ratio = float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
        print(f"\n{title} through fmpy: ratio {ratio:.2f}")
        assert ratio <= THROUGH_FMPY


def test_the_first_instance(host: Bench, tire: Path) -> None:
    seconds = min(float(host.run("first", fmu=tire)) for _ in range(7))
    print(f"\nfirst instance: {seconds:.3f} s")
    assert seconds <= FIRST
