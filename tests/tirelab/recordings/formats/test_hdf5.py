"""Packed values of HDF5 and netCDF files are what they stand for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.recording import read_recording

h5py = pytest.importorskip("h5py")

TIME = np.arange(400) / 100.0
DEFLECTION = 5.0 * (1.0 - np.cos(2.0 * np.pi * TIME))
FORCE = np.round(80.0 * DEFLECTION) * 5.0 + 20.0


def packed(path: Path, **attributes: float) -> Path:
    """A file whose force counts steps of 5 N from 20 N on."""
    counts = np.round((FORCE - 20.0) / 5.0).astype(np.int16)
    with h5py.File(path, "w") as file:
        for name, unit, values in (
            ("time", "s", TIME),
            ("deflection", "mm", DEFLECTION),
            ("force", "N", counts),
        ):
            file[name] = values
            file[name].attrs["units"] = unit
        for name, value in attributes.items():
            file["force"].attrs[name] = value
        if "_FillValue" in attributes:
            file["force"][7] = attributes["_FillValue"]
    return path


def test_scale_and_offset_are_applied_and_told(tmp_path: Path) -> None:
    """CF Conventions, 8.1: the value is the packed one times scale_factor plus add_offset."""
    found = read_recording(packed(tmp_path / "a.h5", scale_factor=5.0, add_offset=20.0), radius="flat")
    np.testing.assert_allclose(found.force, FORCE)
    assert "force: scale_factor 5 applied, add_offset 20 applied" in found.notes
    np.testing.assert_allclose(found.deflection, 1e-3 * DEFLECTION)


def test_a_blank_is_skipped(tmp_path: Path) -> None:
    attributes = {"scale_factor": 5.0, "add_offset": 20.0, "_FillValue": -9999}
    found = read_recording(packed(tmp_path / "a.h5", **attributes), radius="flat")
    np.testing.assert_allclose(found.force, np.delete(FORCE, 7))
    assert "skipped for want of force: sample 8" in found.notes


def test_without_attributes_values_are_as_written(tmp_path: Path) -> None:
    found = read_recording(packed(tmp_path / "a.h5"), radius="flat")
    np.testing.assert_allclose(found.force, (FORCE - 20.0) / 5.0)
    assert not any("applied" in note for note in found.notes)


def test_a_vector_of_another_length_is_left_out_where_it_can_be_done_without(tmp_path: Path) -> None:
    path = packed(tmp_path / "a.h5")
    with h5py.File(path, "r+") as file:
        file["slow/temperature"] = np.full(40, 21.0)
        file["slow/temperature"].attrs["units"] = "degC"
    found = read_recording(path, radius="flat")
    np.testing.assert_allclose(found.deflection, 1e-3 * DEFLECTION)
    assert found.temperature is None
    assert "'slow/temperature' not read: it has 40 samples, the others 400" in found.notes
