"""Recordings that no fit has seen: error of the believed tire, of the corrected one, and of the truth itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from radialtire import TireModel

from ..explain.motion import motion_of
from ..held_out import without_reading_noise
from ..recording import Recording
from ..replay import replay
from ..simulate import simulate

REPLAYED = 1000
"""Samples at the start of a held-out recording on which the corrected FMU itself is run."""


@dataclass(frozen=True)
class HeldOut:
    """Root mean square errors [N] over all held-out recordings of a trial, pooled by samples.

    before: the believed tire; after: the corrected one; floor: what the true tire with all that was hidden misses
    cleared: the corrected tire told the motion without the noise of its reading, as a simulation tells it
    fmu_difference [N]: largest difference between the corrected FMU and the corrected tire on the first samples of
    every recording, None where there is no FMU
    """

    before: float
    after: float
    floor: float
    fmu_difference: float | None
    cleared: float = float("nan")


@dataclass(frozen=True)
class _Start:
    """The first samples of a recording."""

    time: np.ndarray[Any, np.dtype[np.float64]]
    deflection: np.ndarray[Any, np.dtype[np.float64]]
    surface_radius: np.ndarray[Any, np.dtype[np.float64]]


def held_out(
    believed: TireModel,
    corrected: TireModel,
    fmu: Path | None,
    recordings: Sequence[Recording],
    truths: Mapping[str, Mapping[str, Any]],
) -> HeldOut:
    """Return the errors; truths: `{FILE: {"floor_rmse": [N], ...}}` of the opened answer."""
    sizes = np.array([len(r) for r in recordings])
    squares = np.array(
        [[np.mean((r.force - simulate(tire, r)) ** 2) for r in recordings] for tire in (believed, corrected)]
    )
    cleared = [
        np.mean(without_reading_noise(corrected, r, motion_of(r.time, r.deflection)) ** 2) for r in recordings
    ]
    floors = np.array([float(truths[f"{r.name}.csv"]["floor_rmse"]) for r in recordings])
    pooled = np.sqrt(np.stack([*squares, cleared, floors**2]) @ sizes / np.sum(sizes))
    before, after, clear, floor = pooled.tolist()
    return HeldOut(before, after, floor, _fmu_difference(fmu, corrected, recordings), clear)


def _fmu_difference(fmu: Path | None, corrected: TireModel, recordings: Sequence[Recording]) -> float | None:
    if fmu is None:
        return None
    largest = 0.0
    for r in recordings:
        start = _Start(r.time[:REPLAYED], r.deflection[:REPLAYED], r.surface_radius[:REPLAYED])
        largest = max(largest, float(np.max(np.abs(replay(fmu, start) - simulate(corrected, start)))))
    return largest
