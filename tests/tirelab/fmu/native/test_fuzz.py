"""Calls in any order with any values in both versions of FMI, under the sanitizers (addresses, undefined behaviour)."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from loader_bench import guid_of, unpacked_archive
from native_tires import tires
from radialtire import TireModel
from tirelab.fmu.native.make import VERSIONS, c_files, source_files
from tirelab.fmu.native.pack import build_native_fmu, checksum

PROGRAMS = {2: "fuzz.c", 3: "fuzz3.c"}
SECONDS, LONG = 2, 150
"""[s] of each of the four runs: some, and ten minutes together."""

Fuzz = Callable[[TireModel, int], list[int]]


def sanitized(source: str, fmi: int, folder: Path) -> Path:
    """Compile a program of this folder with the FMU's sources, under the sanitizers."""
    if shutil.which("gcc") is None:
        pytest.skip("the sanitizers are gcc's")
    for name, content in source_files(fmi).items():
        (folder / name).write_bytes(content)
    flags = ["-std=c11", "-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    compiled = subprocess.run(
        ["gcc", *flags, "-I", ".", "-o", "program", Path(__file__).parents[1] / source, *c_files(fmi), "-lm"],
        capture_output=True,
        text=True,
        cwd=folder,
    )
    if compiled.returncode and "asan" in compiled.stderr:
        pytest.skip("gcc has no sanitizers here")
    assert compiled.returncode == 0, compiled.stderr
    return folder / "program"


@pytest.fixture(scope="module", params=VERSIONS, ids="FMI {}".format)
def fuzz(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Fuzz:
    """Runs the fuzzer on a tire for some seconds; it returns how many calls, taken, refused and messages there were."""
    fmi, folder = int(request.param), tmp_path_factory.mktemp("fuzz")
    program = sanitized(PROGRAMS[fmi], fmi, folder)

    def run(tire: TireModel, seconds: int) -> list[int]:
        place = folder / f"{len(tire.effects)} effects"
        if not place.is_dir():
            unpacked_archive(build_native_fmu(tire, place, fmi=fmi).path, place)
        resources = place / "resources"
        where = resources.as_uri() if fmi == 2 else f"{resources}{os.sep}"
        command = [program, where, guid_of(place), str(seconds), "1"]
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


BROKEN = 300
ODD = (
    "7ff8000000000000",
    "fff0000000000000",
    "bff0000000000000",
    "7fe1ccf385ebc8a0",
    "-1",
    "99999999999",
    "x",
    "",
)
"""NaN, -inf, -1 and 1e308 as the data write them; counts that nothing has; no number; nothing."""


def broken(text: str, numbers: random.Random) -> str:
    """Tire data with one to three words changed, moved or cut off; most often the sum at the end is right again."""
    words = text.rpartition("end ")[0].split(" ")
    for _ in range(numbers.randint(1, 3)):
        at = numbers.randrange(len(words))
        kind = numbers.randrange(4)
        if kind == 0:
            words[at] = numbers.choice(ODD)
        elif kind == 1:
            words[at] = f"{numbers.getrandbits(64):016x}"
        elif kind == 2:
            del words[at : at + numbers.randint(1, 5)]
            words.append("")
        else:
            words.insert(at, words[numbers.randrange(len(words))])
    body = " ".join(words)
    return f"{body}end {checksum(body.encode()):016x}\n" if numbers.random() < 0.8 else body[: len(body) // 2]


def test_broken_tire_data_are_refused_or_run(tmp_path: Path) -> None:
    """No fault under the sanitizers, a message for each that is refused; the data that are whole are taken."""
    program = sanitized("broken_tires.c", 2, tmp_path)
    numbers = random.Random(1)
    places = []
    for name, tire in (("bare", TireModel()), ("every effect", [*tires(0)][-1][1])):
        place = unpacked_archive(build_native_fmu(tire, tmp_path / name).path, tmp_path / name / "fmu")
        guid, text = guid_of(place), (place / "resources" / "tire.dat").read_text()
        for number in range(BROKEN):
            folder = tmp_path / name / str(number)
            folder.mkdir()
            (folder / "tire.dat").write_text(broken(text, numbers))
            places.append(folder.as_uri())
        places = [(place / "resources").as_uri(), *places]
        done = subprocess.run([program, guid, *places], capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr[-3000:]
        taken, refused, messages = (int(part.split()[0]) for part in done.stdout.split(", "))
        print(done.stdout)
        assert taken >= 1
        assert refused > BROKEN // 4
        assert messages >= refused
        places = []
