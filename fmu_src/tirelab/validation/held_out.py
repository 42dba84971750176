"""Held-out recordings: errors of the baseline tire, of the corrected tire, and of the true one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from radialtire import TireModel

from ..diagnosis.held_out import noise_free_residual
from ..fmu.replay import replay
from ..preprocessing.motion import motion_of
from ..recordings.recording import Recording
from ..simulation.simulate import simulate

REPLAYED_SAMPLES = 1000
"""Samples at the start of a held-out recording on which the corrected FMU itself is run."""


@dataclass(frozen=True)
class Errors:
    """Root mean square errors [N] over some recordings of a trial, pooled by samples.

    before: the baseline tire; after: the corrected tire; reading_noise_floor: the true tire on the same readings
    noise_free: the corrected tire given the noise-free deflection, as in a simulation; noise_floor: the true tire with
    rate and acceleration known (see `concealed.FileTruth`)
    """

    before: float
    after: float
    noise_free: float
    noise_floor: float
    reading_noise_floor: float

    def near(self, within: float, *, noise_free: bool = False) -> bool:
        """Whether the corrected tire's error is at most 1 + `within` times its noise floor."""
        error, floor = (
            (self.noise_free, self.noise_floor) if noise_free else (self.after, self.reading_noise_floor)
        )
        return error <= (1.0 + within) * floor


@dataclass(frozen=True)
class HeldOut:
    """Errors on the held-out recordings of a trial.

    alike: new tests of a kind that was diagnosed; other: tests of another kind
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
    baseline: TireModel,
    corrected: TireModel,
    fmu: Path | None,
    recordings: Sequence[Recording],
    truths: Mapping[str, Mapping[str, Any]],
) -> HeldOut:
    """Return the errors; truths: what is known of each file (`concealed.FileTruth`), from the opened answer."""
    diagnosed = {truth["excitation"] for file, truth in truths.items() if file.startswith("train_")}
    alike = [r for r in recordings if truths[f"{r.name}.csv"]["excitation"] in diagnosed]
    other = [r for r in recordings if truths[f"{r.name}.csv"]["excitation"] not in diagnosed]
    return HeldOut(
        errors_on(baseline, corrected, alike, truths),
        errors_on(baseline, corrected, other, truths),
        _fmu_difference(fmu, corrected, recordings),
    )


def errors_on(
    baseline: TireModel,
    corrected: TireModel,
    recordings: Sequence[Recording],
    truths: Mapping[str, Mapping[str, Any]],
) -> Errors:
    """Return the errors on some recordings, pooled by samples; truths: see `held_out`."""
    sizes = np.array([len(r) for r in recordings])
    squares = np.array(
        [
            (
                np.mean((r.force - simulate(baseline, r)) ** 2),
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
        start = _Start(
            r.time[:REPLAYED_SAMPLES], r.deflection[:REPLAYED_SAMPLES], r.surface_radius[:REPLAYED_SAMPLES]
        )
        largest = max(largest, float(np.max(np.abs(replay(fmu, start) - simulate(corrected, start)))))
    return largest
