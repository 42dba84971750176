"""Which fitted set is delivered: judged by its written tire, on the recordings as they were read and on held-out data.

Fits are made on the smoothed motion, but the written tire is given the deflection as it is read, so it may leave more.
What is judged here is therefore what is delivered. A set is replaced by another one with no more effects whose written
tire leaves clearly less. It is refused where it is worse than the baseline on held-out data. The baseline without any
effect is always acceptable. Two kinds of effects are not named: on one surface, an effect of the deflection alone
beside a refitted law, where that law without it is nearly as likely; and an effect with a probability below one half,
where the others leave as little without it.

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

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from radialtire import TireModel

from ..estimation.explanation import Explanation
from ..names import REFITTED_LAW, plain
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
from ..simulation.channels import begun
from ..simulation.simulate import simulate, smoothed_motion

Forces = Sequence[FloatArray]
Chosen = Sequence[BoolArray]
"""Forces [N] of all samples of each recording; which samples of each are chosen."""

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
        "recordings given",
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


CONSIDERED = 6
"""Number of the likeliest sets whose written tires are compared."""

WORSE = 1.01
"""A correction whose held-out error is more than this times that of the baseline is refused. Below it the held-out data
just do not show the effect."""

NO_WORSE = 0.9
"""A set is replaced by one with no more effects whose error is less than this part of its own."""

LIKELY = 0.5
"""Least probability of an effect that is kept unless it is idle."""

Validate = Callable[[Explanation], HeldOut]


def accept(explanation: Explanation, validate: Validate) -> tuple[Explanation, HeldOut]:
    """Return the first set, in the order of the ranking, that is not refused, and its errors on held-out data.

    Each set is replaced before by one with no more effects that leaves clearly less, if there is one. The sets without
    one of its effects are fitted if they were not, and may then precede it.
    validate: returns the errors of a set on held-out data (see `validation_on`)
    """
    order = explanation.in_order(CONSIDERED)
    likely = [_plainer(explanation, names) for names in (order if () in order else (*order, ()))]
    for chosen in {e.model.names: e for e in (_leaving_least(e, likely) for e in likely)}.values():
        validation = validate(chosen)
        if not chosen.effects or not is_worse(validation):
            break
    whole = chosen.with_parts()
    return (chosen, validation) if whole is chosen else accept(whole, validate)


def _leaving_least(chosen: Explanation, likely: Sequence[Explanation]) -> Explanation:
    """Return a set, or in its place the likeliest one with no more effects that leaves clearly less, repeatedly. What
    leaves more than no effect does is no correction, however little that is.

    With the noise-free deflection that other set must leave no more: an effect of the rate or the acceleration is not
    refuted by the noise of the reading, which it magnifies.
    """
    for other in likely:
        if len(other.effects) > len(chosen.effects) or other.error_left > chosen.error_left:
            continue
        if other.error < (NO_WORSE if other.effects else 1.0) * chosen.error:
            return _leaving_least(other, likely)
    return chosen


def without_unlikely(
    accepted: Explanation, validation: HeldOut, probabilities: Mapping[str, float], validate: Validate
) -> tuple[Explanation, HeldOut]:
    """Return the smallest fitted part of a set that keeps its likely effects (LIKELY) but for idle ones, leaves as
    little as the set, and is no worse than the baseline on held-out data.

    probabilities: of each effect of the set, by its name
    """
    likely = [
        n for n, p in probabilities.items() if p >= LIKELY and not _idle(n, accepted, validation, validate)
    ]
    unlikely = sorted((n for n in probabilities if n not in likely), key=lambda n: -probabilities[n])
    most = accepted.error / NO_WORSE
    for count in range(len(unlikely)):
        for kept in combinations(unlikely, count):
            names = (*likely, *kept)
            if not accepted.was_fitted(names) or accepted.of(names).error > most:
                continue
            found = validate(accepted.of(names))
            if not is_worse(found):
                return accepted.of(names), found
    return accepted, validation


def _idle(name: str, accepted: Explanation, validation: HeldOut, validate: Validate) -> bool:
    """Return whether a set leaves no more without an effect, fitted and held out, neither of the readings nor of the
    noise-free deflection: then it does not explain anything.
    """
    less = tuple(n for n in accepted.model.names if n != name)
    if not less or not accepted.was_fitted(less):
        return False
    plainer = accepted.of(less)
    if plainer.error > accepted.error or plainer.error_left > accepted.error_left:
        return False
    return validate(plainer).after <= validation.after


def _plainer(explanation: Explanation, names: Sequence[str]) -> Explanation:
    """Return the set of a part without what its refitted law can imitate, if nearly as likely; else the set."""
    chosen, static = explanation.of(names), explanation.excitation.within_law
    less = [n for n in names if n == REFITTED_LAW or not static(n)]
    # How unusual another shape of a tire's law is counts in the ranking.
    if not chosen.model.tire.is_part or REFITTED_LAW not in names or len(less) == len(names):
        return chosen
    return explanation.of(less) if explanation.is_near(less, names) else chosen


def is_worse(validation: HeldOut) -> bool:
    """Return whether the corrected tire is worse than the baseline on held-out data."""
    return validation.after > WORSE * validation.before


def validation_on(
    recordings: Sequence[Recorded], held_out: Sequence[Recorded], dataset: RawDataset, before: Forces
) -> Validate:
    """Return the function that validates a set: on recordings kept from the fit, else on a part of `recordings`.

    before [N]: residuals of the baseline in each recording
    """
    if held_out:
        return lambda chosen: given(held_out, dataset, before, chosen)
    return lambda chosen: split(recordings, dataset, before, chosen)
