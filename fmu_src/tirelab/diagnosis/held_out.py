"""The errors of a correction on held-out data.

Held-out recordings are used where there are any. Without any, the accepted effects are fitted once more without one
part: the last recording whose surfaces the others drive too, or of each recording and surface the end that holds the
last part of the misfit there, simulated from its true history. The effects were chosen on all of the data; the
parameters were fitted without the held-out part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from radialtire import TireModel

from ..estimation.explanation import Explanation
from ..preprocessing.dataset import Dataset, Experiment, Recorded, dataset_of
from ..preprocessing.kinematics import BoolArray, FloatArray, Motion
from ..regressors.law import MOST_SURFACES
from ..simulation.simulate import simulate, smoothed_motion
from .untimed import is_timed

FITTED, LEAST = 0.7, 0.1
"""Part of the baseline's squared misfit that is fitted where the end of a recording is held out: by time, one side
could lack what is to be explained. And the part of its samples that is fitted at least."""


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

    by: "recordings given", "recording NAME", "time block A-B s" or, without a clock, "samples A-B"; of several surfaces
    in one recording "the end on each surface"; with " of each recording" where there are several
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
    kept, by = _parts(recordings, before)
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


def _parts(recordings: Sequence[Recorded], before: Sequence[FloatArray]) -> tuple[list[BoolArray], str]:
    """Return which samples stay fitted, and the name of the held-out part."""
    surfaces = [set(np.unique(r.surface_radius).tolist()) for r in recordings]
    for number in reversed(range(len(recordings))):
        others = set().union(*(s for i, s in enumerate(surfaces) if i != number))
        if surfaces[number] <= others:
            kept = [np.full(r.time.size, i != number) for i, r in enumerate(recordings)]
            return kept, f"recording {recordings[number].name}"
    told_apart = len(set().union(*surfaces)) <= MOST_SURFACES
    kept = [
        _beginning(b, r.surface_radius if told_apart else np.zeros(b.size))
        for b, r in zip(before, recordings, strict=True)
    ]
    r, count = recordings[0], int(np.sum(~kept[0]))
    more = " and the ends of the others" if len(recordings) > 1 else ""
    first = kept[0].size - count
    if kept[0][first:].any():
        return kept, "the end on each surface" + (" of each recording" if len(recordings) > 1 else "")
    if not is_timed([r]):
        return kept, f"samples {first + 1}-{r.time.size}{more}"
    return kept, f"time block {float(r.time[first]):.4g}-{float(r.time[-1]):.4g} s{more}"


def _beginning(before: FloatArray, surface: FloatArray) -> BoolArray:
    """Return the samples that stay fitted of a recording; before [N] (n,): what the baseline leaves of it; surface
    (n,): a number of the surface, on each of which the beginning is fitted: a law is fitted to each.
    """
    kept = np.ones(before.size, dtype=bool)
    for one in np.unique(surface):
        own = surface == one
        missed = np.cumsum(before[own] ** 2) / max(float(before[own] @ before[own]), 1e-300)
        kept[own] = (missed < FITTED) | (np.arange(missed.size) < LEAST * missed.size)
    return kept
