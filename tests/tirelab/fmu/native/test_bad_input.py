"""What the native FMU refuses: data of another version, cut off or changed; wrong inputs."""

from __future__ import annotations

import math
import struct
from ctypes import byref, c_char, c_size_t, c_void_p
from pathlib import Path

import pytest
from loader_bench import unpacked_archive
from native_me import Unit
from radialtire import Recalibrated, TireModel, flat_law
from tirelab.fmu.native import kernel
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
        (lambda text: text.replace("tirelab-tire 2", "tirelab-tire 3"), "was written for another version"),
        (lambda text: summed(text[:15] + "0" * 16 + text[31:]), "was written for another version"),
    ],
)
def test_data_that_is_not_this_versions_or_not_whole(folder: Path, change: object, words: str) -> None:
    data = folder / "resources" / "tire.dat"
    data.write_text(change(data.read_text()))  # type: ignore[operator]
    with pytest.raises(AssertionError, match=words):
        Unit(folder, [0.0, 1e5], exchange=False)


def forged(data: bytes) -> bytes:
    """A state with the sum that belongs to it."""
    return data[:-8] + struct.pack("<Q", checksum(data[:-8]))


def serialized(one: Unit) -> bytes:
    state, size = c_void_p(), c_size_t()
    one("GetFMUstate", byref(state))
    one("SerializedFMUstateSize", state, byref(size))
    row = (c_char * size.value)()
    one("SerializeFMUstate", state, row, size)
    one("FreeFMUstate", byref(state))
    return bytes(row)


def taken(one: Unit, data: bytes) -> None:
    state = c_void_p()
    one("DeSerializeFMUstate", data, c_size_t(len(data)), byref(state))
    one("SetFMUstate", state)
    one("FreeFMUstate", byref(state))


def test_a_state_whose_tables_would_end_elsewhere_is_refused(tmp_path: Path) -> None:
    """Its sum is right; the tire's law would read behind its numbers."""
    tire = TireModel(law=Recalibrated(TireModel().law, ((0.3, 0.1, 0.0), (math.inf, 0.2, 0.0))))
    fmu = unpacked_archive(build_native_fmu(tire, tmp_path).path, tmp_path / "fmu")
    one = Unit(fmu, [0.01, 1e5], exchange=False)
    data = serialized(one)
    taken(one, data)
    law, effects = flat_law.laid_out(tire.law), kernel.parameters_of(tire)
    at = len(data) - 8 * (1 + len(effects) + len(law))
    assert data[at : at + 8 * len(law)] == struct.pack(f"<{len(law)}d", *law)
    for index in (0, flat_law.TABLES, flat_law.TABLES + 1):
        changed = bytearray(data)
        changed[at + 8 * index : at + 8 * index + 8] = struct.pack("<d", 1e4)
        with pytest.raises(AssertionError, match="a state of another tire"):
            taken(one, forged(bytes(changed)))
    assert one.get() > 0.0


@pytest.mark.parametrize("exchange", [True, False])
def test_a_state_of_the_other_kind_is_refused(folder: Path, exchange: bool) -> None:
    """An instance of Co-Simulation in Event Mode could never step again."""
    one, other = (Unit(folder, [0.01, 1e5], exchange=kind) for kind in (exchange, not exchange))
    with pytest.raises(AssertionError, match="restore it in an instance of its own kind"):
        taken(other, serialized(one))
    taken(one, serialized(one))


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
