"""Calls in any order with any values in both versions of FMI, under the sanitizers (addresses, undefined behaviour)."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from loader_bench import guid_of, unpacked_archive
from native_tires import tires
from radialtire import TireModel
from tirelab.fmu.native.make import VERSIONS, c_files, source_files
from tirelab.fmu.native.pack import build_native_fmu

PROGRAMS = {2: "fuzz.c", 3: "fuzz3.c"}
SECONDS, LONG = 2, 150
"""[s] of each of the four runs: some, and ten minutes together."""

Fuzz = Callable[[TireModel, int], list[int]]


@pytest.fixture(scope="module", params=VERSIONS, ids="FMI {}".format)
def fuzz(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Fuzz:
    """Runs the fuzzer on a tire for some seconds; it returns how many calls, taken, refused and messages there were."""
    if os.name == "nt":
        pytest.skip("the sanitizers are gcc's and clang's")
    fmi, folder = int(request.param), tmp_path_factory.mktemp("fuzz")
    for name, content in source_files(fmi).items():
        (folder / name).write_bytes(content)
    flags = ["-std=c11", "-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    source = Path(__file__).parents[1] / PROGRAMS[fmi]
    compiled = subprocess.run(
        ["gcc", *flags, "-I", ".", "-o", "fuzz", source, *c_files(fmi), "-lm"],
        capture_output=True,
        text=True,
        cwd=folder,
    )
    if compiled.returncode and "asan" in compiled.stderr:
        pytest.skip("gcc has no sanitizers here")
    assert compiled.returncode == 0, compiled.stderr

    def run(tire: TireModel, seconds: int) -> list[int]:
        place = folder / f"{len(tire.effects)} effects"
        if not place.is_dir():
            unpacked_archive(build_native_fmu(tire, place, fmi=fmi).path, place)
        resources = place / "resources"
        where = resources.as_uri() if fmi == 2 else f"{resources}{os.sep}"
        command = [folder / "fuzz", where, guid_of(place), str(seconds), "1"]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr[-3000:]
        return [int(part.split()[0]) for part in done.stdout.split(", ")]

    return run


def check(counts: list[int]) -> None:
    """Calls of both kinds were made, and each refused one told why."""
    calls, taken, refused, messages = counts
    print(f"{calls} calls, {taken} taken, {refused} refused, {messages} messages")
    assert calls > 1000
    assert min(taken, refused) > calls // 10
    assert messages > refused // 2


@pytest.mark.parametrize("tire", [TireModel(), [*tires(0)][-1][1]], ids=["bare", "every effect"])
class TestFuzz:
    def test_some_seconds(self, fuzz: Fuzz, tire: TireModel) -> None:
        check(fuzz(tire, SECONDS))

    @pytest.mark.slow
    def test_ten_minutes(self, fuzz: Fuzz, tire: TireModel) -> None:
        check(fuzz(tire, LONG))
