"""Recordings that no fit has seen: error of the believed tire, of the corrected one, and of the truth itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from radialtire import TireModel

from ..diagnosis.held_out import noise_free_residual
from ..fmu.replay import replay
from ..preprocessing.kinematics import motion_of
from ..recordings.recording import Recording
from ..simulation.simulate import simulate

REPLAYED = 1000
"""Samples at the start of a held-out recording on which the corrected FMU itself is run."""


@dataclass(frozen=True)
class Errors:
    """Root mean square errors [N] over some held-out recordings of a trial, pooled by samples.

    before: the believed tire; after: the corrected one; read_floor: what the truth would miss on the same readings
    cleared: the corrected tire told the motion without the noise of its reading, as a simulation tells it; floor: what
    the truth would still miss if it knew rate and acceleration (see `concealed.FileTruth`)
    """

    before: float
    after: float
    cleared: float
    floor: float
    read_floor: float

    def near(self, within: float, *, cleared: bool = False) -> bool:
        """Whether the corrected tire's error, `cleared` or as read, is at most 1 + `within` times its floor."""
        error, floor = (self.cleared, self.floor) if cleared else (self.after, self.read_floor)
        return error <= (1.0 + within) * floor


@dataclass(frozen=True)
class HeldOut:
    """Errors on the held-out recordings of a trial.

    alike: tests of a kind that was diagnosed, driven anew; other: tests of another kind
    fmu_difference [N]: largest difference between the corrected FMU and the corrected tire on the first samples of
    every recording, None where there is no FMU
    """

    alike: Errors
    other: Errors
    fmu_difference: float | None


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
    """Return the errors; truths: what is known of each file (`concealed.FileTruth`), from the opened answer."""
    shown = {truth["excitation"] for file, truth in truths.items() if file.startswith("train_")}
    alike = [r for r in recordings if truths[f"{r.name}.csv"]["excitation"] in shown]
    other = [r for r in recordings if truths[f"{r.name}.csv"]["excitation"] not in shown]
    return HeldOut(
        _errors(believed, corrected, alike, truths),
        _errors(believed, corrected, other, truths),
        _fmu_difference(fmu, corrected, recordings),
    )


def _errors(
    believed: TireModel,
    corrected: TireModel,
    recordings: Sequence[Recording],
    truths: Mapping[str, Mapping[str, Any]],
) -> Errors:
    sizes = np.array([len(r) for r in recordings])
    squares = np.array(
        [
            (
                np.mean((r.force - simulate(believed, r)) ** 2),
                np.mean((r.force - simulate(corrected, r)) ** 2),
                np.mean(noise_free_residual(corrected, r, motion_of(r.time, r.deflection)) ** 2),
                float(truths[f"{r.name}.csv"]["floor_rmse"]) ** 2,
                float(truths[f"{r.name}.csv"]["read_floor_rmse"]) ** 2,
            )
            for r in recordings
        ]
    )
    return Errors(*np.sqrt(sizes @ squares / np.sum(sizes)).tolist())


def _fmu_difference(fmu: Path | None, corrected: TireModel, recordings: Sequence[Recording]) -> float | None:
    if fmu is None:
        return None
    largest = 0.0
    for r in recordings:
        start = _Start(r.time[:REPLAYED], r.deflection[:REPLAYED], r.surface_radius[:REPLAYED])
        largest = max(largest, float(np.max(np.abs(replay(fmu, start) - simulate(corrected, start)))))
    return largest
