"""What of the recordings is held out, and the errors of the baseline and of a corrected tire on it.

Recordings given as held-out are used where there are any; they had a part in the ranking too, though nothing is fitted
to them (`estimation.ranking`). Without any, the accepted effects are fitted once more without one part of the data,
which is then simulated from its true history: a whole recording, the last one first, or the end of each recording that
holds the last part of the misfit. The part has to be driven like the data that stay fitted: on the same surfaces, in
the same direction, at depths and speeds and after rests within a factor of two, and where the set explains at least
half as much; otherwise its error is one of extrapolation and refutes nothing. So do samples deeper than all that stay
fitted on their surface: those of a recording's end are fitted too. The set also has to change the force in the part, or
it proves nothing. Where no part fulfils this, the end of each kind of driving is held out, surface by surface. The
effects were chosen on all of the data; the parameters were fitted without the held-out part.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from radialtire import TireModel

from ..estimation.explanation import Explanation
from ..names import plain
from ..preprocessing.data_checks import MAJORITY, compared
from ..preprocessing.driven import FEWEST_EVENTS
from ..preprocessing.motion import BoolArray, FloatArray, IndexArray, Motion, motion_of
from ..preprocessing.noise import NEGLIGIBLE, STILL
from ..preprocessing.samples import (
    RawDataset,
    RawExperiment,
    Recorded,
    is_timed,
    raw_dataset_of,
    surface_numbers,
    within,
)
from ..selection.search import EFFECTIVE
from ..simulation.channels import begun
from ..simulation.simulate import simulate, smoothed_motion

Forces = Sequence[FloatArray]
Chosen = Sequence[BoolArray]
"""Forces [N] of all samples of each recording; which samples of each are chosen."""

GIVEN = "recordings given"
"""What is held out where recordings are given for that."""

FITTED = 0.7
"""Part of the baseline's squared misfit that stays fitted where the end of a recording is held out (split by time, one
side could lack the misfit to be explained). It is also the part of the explained misfit in the held-out data that has
to be driven like the fitted data."""

HALVINGS = int(np.ceil(-np.log2(STILL)))
"""Depths and speeds are classed by how often the largest one is halved to reach them. Those below a sixty-fourth of it
are one class: there the tire rests."""


@dataclass(frozen=True)
class Part:
    """The samples `chosen` of one recording, and all residuals [N] of the baseline and of the corrected tire.

    noise_free [N]: residual of the corrected tire where it is given the noise-free deflection
    """

    experiment: RawExperiment
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
    def evidence(self) -> float:
        """Log odds of the corrected tire over the baseline by what was held out, as a part of the effective samples.

        Recordings that were given took part in the ranking already.
        """
        if self.by == GIVEN or not self.before > 0.0:
            return 0.0
        held_out, fitted = (sum(int(p.chosen.sum()) for p in own) for own in (self.held_out, self.fitted))
        part = held_out / (held_out + fitted)
        return EFFECTIVE * part * float(np.log(self.before / max(self.after, 1e-300)))

    @property
    def noise_free(self) -> float:
        """The same where the tire is given the noise-free deflection, as a simulation gives it."""
        return rmse([p.noise_free[p.chosen] for p in self.held_out])


def rmse(parts: Forces) -> float:
    """Return the root mean square of all `parts` together."""
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def noise_free_residual(tire: TireModel, recording: Recorded, motion: Motion) -> FloatArray:
    """Return the residual [N] of `tire` where it is given the smoothed motion in place of the readings."""
    whole, before = begun(recording)
    if before:
        motion = motion_of(whole.time, whole.deflection, timed=is_timed([recording]))
    smooth = smoothed_motion(whole, motion)
    return recording.force - simulate(tire, smooth, smooth)[before:]


def given(
    held_out: Sequence[Recorded], dataset: RawDataset, before: Forces, explanation: Explanation
) -> HeldOut:
    """Return the errors on the held-out recordings; before [N]: residuals of the fitted ones.

    Samples at which a gauge does not follow count nowhere.
    """
    corrected, baseline = explanation.model.tire, explanation.model.baseline
    own = explanation.residuals, explanation.noise_free, explanation.compared
    fitted = zip(dataset.experiments, before, *own, strict=True)
    others = zip(raw_dataset_of(held_out, baseline).experiments, held_out, compared(held_out), strict=True)
    return HeldOut(
        GIVEN,
        tuple(Part(*part) for part in fitted),
        tuple(
            Part(
                e,
                r.force - simulate(baseline, r),
                r.force - simulate(corrected, r),
                noise_free_residual(corrected, r, e.motion),
                seen,
            )
            for e, r, seen in others
        ),
    )


def split(
    recordings: Sequence[Recorded], dataset: RawDataset, before: Forces, explanation: Explanation
) -> HeldOut:
    """Return the errors on a part of the recordings after a fit to the rest; before [N]: residuals of the baseline."""
    motions = [e.motion for e in dataset.experiments]
    kept, by = _parts(recordings, motions, before, explanation)
    refitted = explanation.refitted(kept)
    noise_free = [
        noise_free_residual(refitted.tire, r, e.motion)
        for e, r in zip(dataset.experiments, recordings, strict=True)
    ]
    parts = list(zip(dataset.experiments, before, refitted.residuals, noise_free, strict=True))
    masks = list(zip(kept, explanation.compared, strict=True))
    fitted = [Part(*part, k & seen) for part, (k, seen) in zip(parts, masks, strict=True)]
    others = [Part(*part, ~k & seen) for part, (k, seen) in zip(parts, masks, strict=True)]
    return HeldOut(by, *(tuple(p for p in side if p.chosen.any()) for side in (fitted, others)))


def _ways(
    recordings: Sequence[Recorded], motions: Sequence[Motion], surfaces: Sequence[IndexArray]
) -> list[IndexArray]:
    """Return a number for the kind of driving at each sample: the same on one surface in one direction, at depths and
    speeds within one factor of two and, at rest, after rests within one factor of two.
    """
    deepest = max(float(np.abs(m.deflection).max()) for m in motions)
    fastest = max(float(np.abs(m.rate).max()) for m in motions)
    timed = is_timed(recordings)
    speeds = [_halvings(m.rate, fastest) for m in motions]
    rested = [_rested(r.time, s == HALVINGS - 1) for r, s in zip(recordings, speeds, strict=True)]
    longest = max(float(r.max()) for r in rested)
    found = []
    for surface, motion, speed, rest in zip(surfaces, motions, speeds, rested, strict=True):
        way = 2 * surface + (motion.direction > 0.0)
        for part in (speed, _halvings(rest, longest)) if timed else ():
            way = way * HALVINGS + part
        found.append(np.asarray(way * HALVINGS + _halvings(motion.deflection, deepest)))
    return found


def _within(kept: Chosen, motions: Sequence[Motion], surfaces: Sequence[IndexArray]) -> list[BoolArray]:
    """Return which samples lie within the deflections of those that are kept."""
    placed = [(m.deflection, number) for m, number in zip(motions, surfaces, strict=True)]
    return within(((x[k], n[k]) for (x, n), k in zip(placed, kept, strict=True)), placed)


def _rested(time: FloatArray, rests: BoolArray) -> FloatArray:
    """Return how long the tire has rested at each sample [s]; time (n,) [s], rests (n,): where it does."""
    moved = np.where(rests, -np.inf, time)
    moved[0] = time[0]
    return np.asarray(time - np.maximum.accumulate(moved))


def _halvings(values: FloatArray, largest: float) -> IndexArray:
    """Return how often the largest value is halved to have each; less than HALVINGS."""
    parts = np.abs(values) / max(largest, 1e-300)
    return np.asarray(np.minimum(-np.log2(np.maximum(parts, 2.0**-HALVINGS)), HALVINGS - 1), dtype=np.intp)


def _parts(
    recordings: Sequence[Recorded], motions: Sequence[Motion], before: Forces, explanation: Explanation
) -> tuple[list[BoolArray], str]:
    """Return which samples stay fitted, and the name of the held-out part, in which enough samples are compared.

    before [N]: what the baseline leaves of each recording; explanation: the set
    """
    surfaces = surface_numbers([r.surface_radius for r in recordings])
    seen = explanation.compared
    ways = _ways(recordings, motions, surfaces)
    # A sample that is not compared shows nothing of either side.
    before, after = (
        [np.where(s, left, 0.0) for s, left in zip(seen, residuals, strict=True)]
        for residuals in (before, explanation.residuals)
    )

    def inside_of(kept: Chosen) -> list[BoolArray]:
        return [w & s for w, s in zip(_within(kept, motions, surfaces), seen, strict=True)]

    for number in reversed(range(len(recordings))) if len(recordings) > 1 else ():
        kept = [np.full(r.time.size, i != number) for i, r in enumerate(recordings)]
        if _shows_as_much(kept, before, after, ways, inside_of(kept)):
            return kept, f"recording {recordings[number].name}"
    kept = [_beginning(b, np.zeros_like(w)) for b, w in zip(before, ways, strict=True)]
    inside = inside_of(kept)
    if _shows_as_much(kept, before, after, ways, inside):
        kept = [k | ~w for k, w in zip(kept, inside, strict=True)]
        return kept, _name_of(kept, recordings)
    ends = [_beginning(b, w) for b, w in zip(before, ways, strict=True)]
    kept = [k | ~w for k, w in zip(ends, inside_of(ends), strict=True)]
    few = sum(int(np.sum(~k)) for k in kept) < FEWEST_EVENTS
    return ends if few else kept, "the end of each motion"


def _name_of(kept: Chosen, recordings: Sequence[Recorded]) -> str:
    """Return the name of what is held out of the first recording that is not all kept, and of the others."""
    r, own = next((r, k) for r, k in zip(recordings, kept, strict=True) if not k.all())
    first, last = np.flatnonzero(~own)[[0, -1]]
    more = " and the ends of the others" if len(recordings) > 1 else ""
    if not is_timed([r]):
        return f"samples {first + 1}-{last + 1}{more}"
    return f"time block {plain(float(r.time[first]), 4)}-{plain(float(r.time[last]), 4)} s{more}"


def _shows_as_much(
    kept: Chosen, before: Forces, after: Forces, ways: Sequence[IndexArray], within: Chosen
) -> bool:
    """Return whether the held-out part can refute a set.

    It can if the set changes the force in it, and if most of what the set explains there lies within the deflections
    that are also fitted, and belongs to kinds of driving that are, in which it explains at least half as much. What
    shows only in the held-out part cannot be fitted without it.
    """
    fits, way, inside = np.concatenate(kept), np.concatenate(ways), np.concatenate(within)
    missed, left = np.concatenate(before), np.concatenate(after)
    changed, explained = (missed - left) ** 2, missed**2 - left**2
    count = int(way.max()) + 1
    fitted, held_out, all_of_it = (
        np.bincount(way[own], explained[own], count) for own in (fits, ~fits & inside, ~fits)
    )
    samples = [np.bincount(way[own], minlength=count) for own in (fits, ~fits & inside)]
    each, other = (
        np.maximum(e, 0.0) / np.maximum(n, 1) for e, n in zip((fitted, held_out), samples, strict=True)
    )
    # The way back of one loop is not driven like what stays fitted of it, its first few samples.
    alike = (each >= MAJORITY**2 * other) & (samples[0] >= NEGLIGIBLE * samples[1])
    whole = np.maximum(all_of_it, 0.0).sum()
    return bool(
        np.sum(~fits & inside) >= FEWEST_EVENTS
        and changed[~fits].sum() >= NEGLIGIBLE * changed.sum()
        and np.maximum(held_out, 0.0)[alike].sum() >= FITTED * whole
    )


def _beginning(before: FloatArray, way: IndexArray) -> BoolArray:
    """Return the samples of a recording that stay fitted, the beginning of each kind of driving.

    before [N] (n,): residual of the baseline; way (n,): number of the kind of driving
    """
    kept = np.ones(before.size, dtype=bool)
    for one in np.unique(way):
        own = way == one
        missed = np.cumsum(before[own] ** 2) / max(float(before[own] @ before[own]), 1e-300)
        kept[own] = (missed < FITTED) | (np.arange(missed.size) < NEGLIGIBLE * missed.size)
    return kept


Validate = Callable[[Explanation], HeldOut]


def validation_on(
    recordings: Sequence[Recorded], held_out: Sequence[Recorded], dataset: RawDataset, before: Forces
) -> Validate:
    """Return the function that validates a set: on recordings kept from the fit, else on a part of `recordings`.

    before [N]: residuals of the baseline in each recording
    """
    if held_out:
        return lambda chosen: given(held_out, dataset, before, chosen)
    return lambda chosen: split(recordings, dataset, before, chosen)
