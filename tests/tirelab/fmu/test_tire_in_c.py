"""The article's tire in a host written in C, without Python in the process: lives, threads, memory."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from loader_bench import FORCE_1_CM, FORCE_2_CM, Bench, numbers


@pytest.fixture(scope="module")
def tire(article_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the article's tire, unpacked in a folder whose name needs care."""
    folder = tmp_path_factory.mktemp("tire") / "ä #"
    with zipfile.ZipFile(article_fmu) as archive:
        archive.extractall(folder)
    return folder


@pytest.fixture(scope="module")
def run(bench: Bench, tire: Path) -> Callable[..., str]:
    def run_mode(*mode: Any) -> str:
        return bench.run(*mode, fmu=tire, uri=f"file://{quote(str(tire / 'resources'))}")

    return run_mode


def test_lives_twice_and_exits_well(run: Callable[..., str]) -> None:
    # two powers, each rounded once by either C library: 4 units in the last place
    expected = pytest.approx([FORCE_1_CM, FORCE_2_CM, 0.0] * 2, rel=1e-15, abs=0)
    assert numbers(run("run", 0.01, 0.02, -0.01)) == expected


def test_four_threads_each_with_its_tire(run: Callable[..., str]) -> None:
    run("threads", 4)


def test_memory_of_1000_instances(run: Callable[..., str]) -> None:
    assert int(run("cycles", 1000)) < 15_000  # kB


def test_memory_of_many_steps(run: Callable[..., str]) -> None:
    # one lost reference a step would be at least 16 bytes: 3.2 MB
    assert int(run("steps", 200_000)) < 500
