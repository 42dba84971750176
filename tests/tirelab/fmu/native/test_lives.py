"""The native FMU in a host in C: its memory over many lives, threads without a lock.

`pytest -s -n 0 tests/benchmarks/bench_native.py` measures its speed.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from loader_bench import Bench, numbers, unpacked_archive
from radialtire import TireModel
from tirelab.fmu.native.make import PLATFORMS
from tirelab.fmu.native.pack import build_native_fmu

NOWHERE = {"PATH": "", "PYTHONHOME": "", "PYTHONPATH": ""}
"""An environment in which no Python is found."""


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bare")
    return unpacked_archive(build_native_fmu(TireModel(), folder).path, folder / "fmu")


def test_lives_twice_and_exits_well(bench: Bench, bare: Path) -> None:
    # one power, rounded once by either C library
    expected = pytest.approx([550.9, 550.9 * 2**1.422, 0.0] * 2, rel=1e-15, abs=0)
    assert numbers(bench.run("run", 0.01, 0.02, -0.01, fmu=bare, environment=NOWHERE)) == expected


def test_four_threads_each_with_its_tires(bench: Bench, bare: Path) -> None:
    bench.run("threads", 4, fmu=bare, environment=NOWHERE)


def test_no_memory_is_lost_over_many_steps(bench: Bench, bare: Path) -> None:
    assert (
        int(bench.run("steps", 200_000, fmu=bare, environment=NOWHERE)) < 500
    )  # kB; 16 bytes a step were 3.2 MB


@pytest.mark.slow
def test_no_memory_is_lost_over_a_million_instances(bench: Bench, bare: Path) -> None:
    """Ten turns of 100 000; from the first one's end to the last one's the process has grown by less than 1 MB.

    One lost allocation a life, of 16 bytes at least, were 14 MB.
    """
    nanoseconds, lost = numbers(bench.run("lives", 100_000, fmu=bare, environment=NOWHERE, seconds=1200))
    print(f"{1e-3 * nanoseconds:.1f} us an instance, {lost:.0f} kB")
    assert lost < 1000


def test_a_thousand_instances_in_two_threads(bench: Bench, bare: Path) -> None:
    """A million steps of a thousand instances, half of them in each thread; the binary knows no lock to wait for."""
    bench.run("crowd", 1_000_000, 1000, fmu=bare, environment=NOWHERE)
    for platform in PLATFORMS[:2]:
        content = platform.library(2).read_bytes()
        assert b"calloc" in content
        assert b"pthread" not in content
