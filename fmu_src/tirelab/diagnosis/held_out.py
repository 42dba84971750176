"""The errors of a correction on held-out data.

Held-out recordings are used where there are any. Without any, the accepted effects are fitted once more without one
part, simulated from its true history: a recording, the last one first, or of each recording the end that holds the last
part of the misfit. Such a part has to be driven as what stays fitted, or its error is one of extrapolation and refutes
nothing: on the surfaces, and at depths and speeds within a factor of two. Where no part is, the end of each way of
driving is held out, surface by surface. The effects were chosen on all of the data; the parameters were fitted without
the held-out part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from radialtire import TireModel

from ..estimation.explanation import Explanation
from ..preprocessing.dataset import Dataset, Experiment, Recorded, dataset_of
from ..preprocessing.kinematics import STILL, BoolArray, FloatArray, IndexArray, Motion
from ..regressors.law import MOST_SURFACES
from ..simulation.simulate import simulate, smoothed_motion
from .untimed import is_timed

FITTED, LEAST = 0.7, 0.1
"""Part of the baseline's squared misfit that is fitted where the end of a recording is held out: by time, one side
could lack what is to be explained. It is also the part of the held-out misfit that has to be driven as what is fitted.
And the part of its samples that is fitted at least."""

HALVINGS = int(np.ceil(-np.log2(STILL)))
"""Depths and speeds below a sixty-fourth of the largest are one: there the tire rests."""


@dataclass(frozen=True)
class Part:
    """The samples `chosen` of one recording, and all residuals [N] of the baseline and of the corrected tire.

    noise_free [N]: residual of the corrected tire where it is given the noise-free deflection
    """

    experiment: Experiment
    before: FloatArray
    after: FloatArray
    noise_free: FloatArray
    chosen: BoolArray


@dataclass(frozen=True)
class HeldOut:
    """What was fitted and what was held out.

    by: "recordings given", "recording NAME", "time block A-B s" or, without a clock, "samples A-B"; where surfaces,
    depths or speeds are driven once "the end of each motion"
    """

    by: str
    fitted: tuple[Part, ...]
    held_out: tuple[Part, ...]

    @property
    def before(self) -> float:
        """RMSE [N] of the baseline on what was held out."""
        return rmse([p.before[p.chosen] for p in self.held_out])

    @property
    def after(self) -> float:
        """RMSE [N] of the corrected tire on what was held out."""
        return rmse([p.after[p.chosen] for p in self.held_out])

    @property
    def noise_free(self) -> float:
        """The same where the tire is given the noise-free deflection, as a simulation gives it."""
        return rmse([p.noise_free[p.chosen] for p in self.held_out])


def rmse(parts: Sequence[FloatArray]) -> float:
    """Return the root mean square of all `parts` together."""
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def noise_free_residual(tire: TireModel, recording: Recorded, motion: Motion) -> FloatArray:
    """Return the residual [N] of `tire` where it is given the smoothed motion in place of the readings."""
    smooth = smoothed_motion(recording, motion)
    return recording.force - simulate(tire, smooth, smooth)


def given(
    held_out: Sequence[Recorded],
    recordings: Sequence[Recorded],
    dataset: Dataset,
    before: Sequence[FloatArray],
    explanation: Explanation,
) -> HeldOut:
    """Return the errors on the held-out recordings; before [N]: residuals of the fitted ones."""
    corrected, baseline = explanation.model.tire, explanation.model.baseline
    fitted = zip(dataset.experiments, recordings, before, explanation.residuals, strict=True)
    others = zip(dataset_of(held_out, baseline).experiments, held_out, strict=True)
    return HeldOut(
        "recordings given",
        tuple(
            Part(e, b, a, noise_free_residual(corrected, r, e.motion), np.ones(b.size, dtype=bool))
            for e, r, b, a in fitted
        ),
        tuple(
            Part(
                e,
                r.force - simulate(baseline, r),
                r.force - simulate(corrected, r),
                noise_free_residual(corrected, r, e.motion),
                np.ones(r.time.size, dtype=bool),
            )
            for e, r in others
        ),
    )


def split(
    recordings: Sequence[Recorded],
    dataset: Dataset,
    before: Sequence[FloatArray],
    explanation: Explanation,
) -> HeldOut:
    """Return the errors on a part of the recordings after a fit to the rest; before [N]: residuals of the baseline."""
    motions = [e.motion for e in dataset.experiments]
    kept, by = _parts(recordings, before, _ways(recordings, motions))
    refitted = explanation.refitted(kept)
    noise_free = [
        noise_free_residual(refitted.tire, r, e.motion)
        for e, r in zip(dataset.experiments, recordings, strict=True)
    ]
    parts = list(zip(dataset.experiments, before, refitted.residuals, noise_free, kept, strict=True))
    return HeldOut(
        by,
        tuple(Part(e, b, a, n, k) for e, b, a, n, k in parts if k.any()),
        tuple(Part(e, b, a, n, ~k) for e, b, a, n, k in parts if not k.all()),
    )


def _ways(recordings: Sequence[Recorded], motions: Sequence[Motion]) -> list[IndexArray]:
    """Return a number of the way in which the tire is driven, for each sample: the same on one surface, at depths and
    speeds within one factor of two.
    """
    deepest = max(float(np.abs(m.deflection).max()) for m in motions)
    fastest = max(float(np.abs(m.rate).max()) for m in motions)
    radii = np.unique(np.concatenate([np.unique(r.surface_radius) for r in recordings]))
    told_apart = radii.size <= MOST_SURFACES
    found = []
    for recording, motion in zip(recordings, motions, strict=True):
        surface = np.searchsorted(radii, recording.surface_radius) if told_apart else 0
        speed = _halvings(motion.rate, fastest) if is_timed([recording]) else 0
        found.append(
            np.asarray((surface * HALVINGS + speed) * HALVINGS + _halvings(motion.deflection, deepest))
        )
    return found


def _halvings(values: FloatArray, largest: float) -> IndexArray:
    """Return how often the largest value is halved to have each; less than HALVINGS."""
    parts = np.abs(values) / max(largest, 1e-300)
    return np.asarray(np.minimum(-np.log2(np.maximum(parts, 2.0**-HALVINGS)), HALVINGS - 1), dtype=np.intp)


def _parts(
    recordings: Sequence[Recorded], before: Sequence[FloatArray], ways: Sequence[IndexArray]
) -> tuple[list[BoolArray], str]:
    """Return which samples stay fitted, and the name of the held-out part."""
    for number in reversed(range(len(recordings))) if len(recordings) > 1 else ():
        kept = [np.full(r.time.size, i != number) for i, r in enumerate(recordings)]
        if _is_driven_alike(kept, before, ways):
            return kept, f"recording {recordings[number].name}"
    kept = [_beginning(b, np.zeros_like(w)) for b, w in zip(before, ways, strict=True)]
    if not _is_driven_alike(kept, before, ways):
        kept = [_beginning(b, w) for b, w in zip(before, ways, strict=True)]
        return kept, "the end of each motion"
    r, count = recordings[0], int(np.sum(~kept[0]))
    more = " and the ends of the others" if len(recordings) > 1 else ""
    first = kept[0].size - count
    if not is_timed([r]):
        return kept, f"samples {first + 1}-{r.time.size}{more}"
    return kept, f"time block {float(r.time[first]):.4g}-{float(r.time[-1]):.4g} s{more}"


def _is_driven_alike(
    kept: Sequence[BoolArray], before: Sequence[FloatArray], ways: Sequence[IndexArray]
) -> bool:
    """Return whether most of the misfit that is held out belongs to ways of driving that stay fitted."""
    fitted = np.unique(np.concatenate([w[k] for w, k in zip(ways, kept, strict=True)]))
    misfit = np.concatenate([b[~k] ** 2 for b, k in zip(before, kept, strict=True)])
    alike = np.isin(np.concatenate([w[~k] for w, k in zip(ways, kept, strict=True)]), fitted)
    return float(misfit[alike].sum()) >= FITTED * float(misfit.sum())


def _beginning(before: FloatArray, way: IndexArray) -> BoolArray:
    """Return the samples that stay fitted of a recording; before [N] (n,): what the baseline leaves of it; way (n,): a
    number, of each of which the beginning is fitted.
    """
    kept = np.ones(before.size, dtype=bool)
    for one in np.unique(way):
        own = way == one
        missed = np.cumsum(before[own] ** 2) / max(float(before[own] @ before[own]), 1e-300)
        kept[own] = (missed < FITTED) | (np.arange(missed.size) < LEAST * missed.size)
    return kept
