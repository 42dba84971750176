"""What the native FMU refuses: data of another version, cut off or changed; wrong inputs."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from loader_bench import unpacked_archive
from native_me import Unit
from radialtire import TireModel
from tirelab.fmu.native.pack import build_native_fmu, checksum


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return unpacked_archive(build_native_fmu(TireModel(), tmp_path).path, tmp_path / "fmu")


def summed(text: str) -> str:
    """Data with the sum that belongs to it."""
    body = text.rpartition("end ")[0]
    return f"{body}end {checksum(body.encode()):016x}\n"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text[: len(text) // 2], "is cut off or was changed"),
        (lambda text: text[:-2], "is cut off or was changed"),
        (lambda text: "", "is cut off or was changed"),
        (lambda text: text.replace("law 20", "law 21"), "is cut off or was changed"),
        (lambda text: summed(text.replace("law 20", "law 21")), "is cut off or was changed"),
        (lambda text: summed(text.replace("parameters 10", "parameters 9")), "is cut off or was changed"),
        (lambda text: summed(text.replace(" q 1 ", " q 19 ")), "is cut off or was changed"),
        (lambda text: summed(text.replace("effects ", "effects 1", 1)), "is cut off or was changed"),
        (lambda text: text.replace("tirelab-tire 1", "tirelab-tire 2"), "was written for another version"),
        (lambda text: summed(text[:15] + "0" * 16 + text[31:]), "was written for another version"),
    ],
)
def test_data_that_is_not_this_versions_or_not_whole(folder: Path, change: object, words: str) -> None:
    data = folder / "resources" / "tire.dat"
    data.write_text(change(data.read_text()))  # type: ignore[operator]
    with pytest.raises(AssertionError, match=words):
        Unit(folder, [0.0, 1e5], exchange=False)


def test_data_that_is_not_there(folder: Path) -> None:
    (folder / "resources" / "tire.dat").unlink()
    with pytest.raises(AssertionError, match=r"no tire\.dat in the resource location"):
        Unit(folder, [0.0, 1e5], exchange=False)


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        ([math.nan, 1e5], "deflection = nan m is not allowed"),
        ([math.inf, 1e5], "deflection = inf m is not allowed"),
        ([22.0, 1e5], "deflection = 22 m is not allowed; it must lie between -1000 m"),
        ([0.01, 0.0], "surface_radius = 0 m is not allowed"),
        ([0.01, math.nan], "surface_radius = nan m is not allowed"),
    ],
)
def test_inputs_that_no_tire_has_are_refused_at_the_start(
    folder: Path, inputs: list[float], words: str
) -> None:
    with pytest.raises(AssertionError, match=words):
        Unit(folder, inputs, exchange=False)
