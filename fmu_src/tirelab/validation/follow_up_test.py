"""The test that the diagnosis recommends, run on the rig of the trial."""

from __future__ import annotations

from pathlib import Path

import concealed
import numpy as np
import polars as pl
from concealed.__main__ import trial_seed
from numpy.typing import NDArray

from ..errors import TirelabError
from ..recordings.recording import Recording
from ..recordings.units import conversion, split_header
from ..recordings.writing import write_recording
from .commitment import trial_key
from .folders import Folders

FloatArray = NDArray[np.float64]

SAME_SURFACE = 1e-6
"""Curvatures [1/m] that differ by less are one surface of the rig, written with fewer digits."""

TEST_CHANNELS = {"time": "s", "deflection": "m", "radius": "m"}


def run_recommended_test(folders: Folders, seed: int, number: int, kind: str | None, test: Path) -> Path:
    """Run a test on the rig of a trial, and return the file of its recording.

    test: CSV with columns time, deflection and radius, each with its unit in brackets; flat is inf
    Raises TirelabError where the file cannot be read or the rig refuses it.
    """
    trial = concealed.draw(trial_seed(seed, number), kind=kind)
    time, deflection, radius = read_test(test)
    surfaces = np.unique(np.concatenate([record.radius for record in trial.train]))
    try:
        record = concealed.rerun(trial, time, deflection, _snapped(radius, surfaces), seed=1)
    except ValueError as error:
        raise TirelabError(f"{test}: the rig refuses it: {error}") from None
    path = folders.test(trial_key(number))
    path.parent.mkdir(parents=True, exist_ok=True)
    made = Recording(
        "test", record.time, record.deflection, record.radius, record.force, pressure=record.pressure
    )
    write_recording(made, path)
    return path


def read_test(path: Path) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return time [s], deflection [m] and surface's radius [m] of a test file."""
    try:
        table = pl.read_csv(path, infer_schema_length=None)
    except (OSError, pl.exceptions.PolarsError) as error:
        raise TirelabError(f"{path}: no test can be read from it ({error})") from None
    found: dict[str, FloatArray] = {}
    for column in table.columns:
        name, unit = split_header(column)
        channel = name.strip().lower().removeprefix("surface").strip(" _")
        if channel in TEST_CHANNELS and unit:
            values = table[column].cast(pl.Float64, strict=False).to_numpy()
            found[channel] = conversion(unit, TEST_CHANNELS[channel]).to_si(
                np.asarray(values, dtype=np.float64)
            )
    missing = [name for name in TEST_CHANNELS if name not in found]
    if missing:
        raise TirelabError(f"{path}: lacks the columns {', '.join(missing)}, each with its unit in brackets")
    return found["time"], found["deflection"], found["radius"]


def _snapped(radius: FloatArray, surfaces: FloatArray) -> FloatArray:
    """The radii, with those of the rig's own surfaces in full precision."""
    snapped = np.array(radius)
    for surface in surfaces:
        snapped[np.abs(1.0 / radius - 1.0 / surface) < SAME_SURFACE] = surface
    return snapped
