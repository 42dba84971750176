"""The alternatives that the recordings cannot rule out, with the reason and what to record to decide."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from radialtire import CATALOGUE

from ..estimation.explanation import Explanation
from ..estimation.findings import NamedEffect
from ..estimation.hidden import LIKE_READING
from ..planning.waveforms import Limits, another_pressure
from ..preprocessing.motion import FloatArray
from ..preprocessing.noise import STILL
from ..preprocessing.samples import RawDataset
from .confidence import of_confounded

CREDIBLE = 0.97
"""Probability of the verdict and its alternatives together: the rate at which the true set should be among them."""

MOST_LISTED = 10
"""Most alternatives that are listed, the likeliest first."""

LONG_ENOUGH = 1.0
"""Shortest rest [s] that counts as a hold."""

HOLD_DEPTH = 0.65
"""Deflection of a recommended hold, as a part of the largest one recorded."""

FASTER = 10.0
"""Factor between a recorded speed and another one that is recommended."""

USUAL_SPEED = 0.1
"""Least top speed [m/s] assumed of a rig whose limits are not given; it is at least twice the fastest recorded
speed."""

SAME = "their forces are the same in this motion"
"""Why two sets are not told apart that leave the same; whether another motion decides is what the next test says."""

OF_AN_INSTRUMENT = "test the gauges by themselves"
"""What decides between what an instrument does and what the part does where no motion shows it."""

OF_DEFLECTION = "they depend on the deflection only, and no motion of this part tells them apart"
"""Why two sets are not told apart that differ in effects of the deflection: there is no test to propose."""

LAW_TRAITS = ("static",)
"""Traits of a refitted law: it depends on deflection and surface only."""


@dataclass(frozen=True)
class Alternative:
    """Another set of effects that the recordings cannot rule out.

    log_odds: of the verdict against it, not tempered; reason: what the recordings lack to decide, and what to record
    probability: of the set, not a number where the recordings cannot show it
    same: whether it leaves the same of the recordings as the verdict (see `indistinct.leaving_the_same`)
    """

    names: tuple[str, ...]
    log_odds: float
    reason: str
    probability: float
    same: bool = False


def alternatives_of(
    explanation: Explanation, dataset: RawDataset, confidence: float, limits: Limits | None = None
) -> tuple[Alternative, ...]:
    """Return the sets that the recordings cannot rule out; confidence: probability of the verdict; limits: of the rig,
    where they are known.

    First come the sets that leave the same as the verdict's, as likely beside it as their evidence says. Then come
    those that this motion cannot distinguish from it: each has the same part of the probability that the verdict gave
    up to them (`sharing_odds`). Then the likeliest others follow, until all together have the probability CREDIBLE;
    they share the rest of the probability by their evidence. No set gets more than its evidence relative to the
    verdict's allows; what then remains belongs to sets that were not compared.

    Effects that the excitation cannot show, and those that the verdict's refitted law can imitate, are listed last, in
    addition to the verdict's own, with the reason; not those that are listed in place of one of its effects.
    """
    best, same = explanation.model.names, explanation.same
    own = next(e for e in explanation.evidence if set(e.names) == set(best))
    others = [e for e in explanation.evidence if set(e.names) != set(best)]
    whole = max(sum(e.probability for e in others if e.names not in same), 1e-300)
    count, with_same = len(explanation.confounded), confidence / explanation.share
    with_confounded = of_confounded(with_same, count)
    covered, found = confidence, []
    for e in others:
        alike = e.names in explanation.confounded
        if covered >= CREDIBLE and not alike:
            continue
        beside = confidence * e.probability / max(own.probability, 1e-300)
        equal = (with_confounded - with_same) / count if alike else 0.0
        left = (1.0 - with_confounded) * e.probability / whole
        shared = min(beside, with_same)
        covered += shared if e.names in same else equal + left
        stated = shared if e.names in same else equal + min(left, beside)
        reason = reason_of(best, e.names, explanation, dataset, limits)
        found.append(Alternative(e.names, own.log_evidence - e.log_evidence, reason, stated, e.names in same))
    found.sort(key=lambda a: (not a.same, a.names not in explanation.confounded))
    listed = found[:MOST_LISTED]
    listed_sets = {frozenset(a.names) for a in listed}
    beside_law = {n: (*best, n) for n in explanation.within_law if frozenset((*best, n)) not in listed_sets}
    reasons = {n: reason_of(best, names, explanation, dataset, limits) for n, names in beside_law.items()}
    instead = {other for _, other in explanation.read_instead}
    unseen = [
        Alternative(tuple(sorted({*best, name})), 0.0, why, float("nan"))
        for name, why in (*reasons.items(), *explanation.unshown.reasons)
        if name not in instead
    ]
    return (*_read_instead(explanation, confidence), *listed, *unseen)


def _read_instead(explanation: Explanation, confidence: float) -> list[Alternative]:
    """Return the sets with an effect that the reading hides in place of one that is named: as likely as the verdict,
    all together, since nothing decides between them.
    """
    best, pairs = explanation.model.names, explanation.read_instead
    sets = [tuple(sorted({*best, other} - {name})) for name, other in pairs]
    return [Alternative(names, 0.0, LIKE_READING, confidence / len(sets)) for names in sets]


def no_surer_than_alternatives(
    effects: Sequence[NamedEffect], alternatives: Sequence[Alternative]
) -> tuple[NamedEffect, ...]:
    """Return the effects, each at most as probable as the alternatives without it leave: 1 - sum of their
    probabilities.
    """
    known = [a for a in alternatives if math.isfinite(a.probability)]
    return tuple(
        replace(
            e,
            probability=min(e.probability, 1.0 - sum(a.probability for a in known if e.name not in a.names)),
        )
        for e in effects
    )


def reason_of(
    names: Sequence[str],
    other: Sequence[str],
    explanation: Explanation,
    dataset: RawDataset,
    limits: Limits | None = None,
) -> str:
    """Return what the recordings lack to decide between two sets, and what to record: "no hold: hold 10 s at 15 mm"."""
    between = sorted(set(names) ^ set(other))
    differing = [set(_traits(n)) for n in between]
    common = set.intersection(*differing) if differing else set()
    lacks = insufficient_excitation(explanation, dataset, limits, hold=_told_by_hold(names, other))
    if "static" in common:
        if not explanation.model.baseline.inflated:
            return OF_DEFLECTION
        several = "pressure" in explanation.excitation.channels.varied
        return f"they depend on deflection and surface only: {another_pressure(limits, several)}"
    if between and all("static" in _traits(n) or explanation.excitation.of_deflection(n) for n in between):
        return (
            "they depend on the deflection only in this motion: load and unload to two depths, at two speeds"
        )
    if tuple(other) in explanation.same:
        if any("reading" in _traits(n) for n in between):
            return f"{SAME}: {OF_AN_INSTRUMENT}"
        if not explanation.excitation.one_speed:
            return SAME
    if "slow" in common:
        return "they all change slowly with time: repeat the first cycle after a rest"
    if {"loop", "rate"} & set.union(set(), *differing):
        loops = [text for text in lacks if "surface" not in text]
        another = f"repeat at {_another_speed(dataset, limits)}"
        return "; ".join(loops) or f"their loops are alike at the recorded rates: {another}"
    return "; ".join(lacks) or "the difference is smaller than these recordings can show"


def _told_by_hold(names: Sequence[str], other: Sequence[str]) -> bool:
    """Return whether a hold tells two sets apart: an effect in which they differ moves the force at rest, or some of
    their effects keep a force there that depends on the way, and others lose theirs.
    """
    between = {trait for name in set(names) ^ set(other) for trait in _traits(name)}
    moving = [{"rate", "loop"} & set(_traits(name)) for name in {*names, *other}]
    return bool({"rest", "slow"} & between) or ({"loop"} in moving and any("rate" in m for m in moving))


def insufficient_excitation(
    explanation: Explanation, dataset: RawDataset, limits: Limits | None = None, *, hold: bool = True
) -> list[str]:
    """Return what the recordings lack to distinguish effects, each with what to record; hold: whether one may tell."""
    timed = explanation.excitation.timed
    lacks = []
    if not timed:
        lacks.append("no time: record the time of each sample")
    elif explanation.excitation.one_speed:
        lacks.append(f"one speed at each deflection only: repeat at {_another_speed(dataset, limits)}")
    mountable = set() if limits is None else set(limits.surfaces)
    ground = not explanation.model.baseline.is_part
    if ground and len(dataset.radii) == 1 and (not mountable or mountable - set(dataset.radii)):
        lacks.append("one surface only: press on a second surface")
    rates = [np.abs(e.motion.rate) for e in dataset.experiments]
    # Over the way, not the time: where a load is held for long, the deflection creeps.
    typical = max(float(r @ r / max(r.sum(), 1e-300)) for r in rates)
    held = any(_is_held(e.time, e.motion.deflection, typical) for e in dataset.experiments)
    if hold and timed and not held:
        lacks.append(f"no hold: hold 10 s at {_hold_level(dataset)}")
    if len({float(d) for e in dataset.experiments for d in np.unique(e.motion.direction)}) == 1:
        lacks.append("no way back: release it as slowly as it was loaded, and load it again")
    elif max(float(e.motion.cycle.max()) for e in dataset.experiments) < 1.0:
        lacks.append("no repeated cycle: drive each cycle twice")
    return lacks


def _hold_level(dataset: RawDataset) -> str:
    """Return a deflection to hold, with its unit, within the recorded ones."""
    most = dataset.max_deflection
    least = min(float(e.motion.deflection.min()) for e in dataset.experiments)
    level = 1e3 * (least + HOLD_DEPTH * (most - least))
    return f"{level:.{'0f' if abs(level) >= 1.0 else '2g'}} mm".replace("-", "\N{MINUS SIGN}")


def _another_speed(dataset: RawDataset, limits: Limits | None) -> str:
    """Return a speed far from those recorded, with its unit: ten times the typical one where the rig reaches that."""
    speeds = np.concatenate([np.abs(e.motion.rate) for e in dataset.experiments])
    typical, fastest = float(np.sqrt(np.mean(speeds**2))), float(speeds.max())
    reached = max(2.0 * fastest, USUAL_SPEED) if limits is None else limits.fastest
    speed = FASTER * typical if FASTER * typical <= reached else typical / FASTER
    return f"{float(f'{1e3 * speed:.2g}'):g} mm/s"


def _traits(name: str) -> tuple[str, ...]:
    return CATALOGUE[name].traits if name in CATALOGUE else LAW_TRAITS


def _is_held(time: FloatArray, deflection: FloatArray, speed: float) -> bool:
    """Return whether a deflection [m] stays for LONG_ENOUGH where it is, beside its speed [m/s].

    It is asked of whole stretches, since a gauge that trembles has rates, and a part creeps under a load that is held.
    """
    stretch, since = 0.5 * LONG_ENOUGH, time - time[0]
    while stretch <= since[-1]:  # a hold of two stretches has a whole one
        starts = np.flatnonzero(np.diff(since // stretch, prepend=-1.0))
        moved = np.maximum.reduceat(deflection, starts) - np.minimum.reduceat(deflection, starts)
        several = np.diff(starts, append=time.size) > 1
        # The turn of a motion goes a quarter as far as the speed at its ends would.
        if np.any(moved[:-1][several[:-1]] < 0.25 * STILL * speed * stretch):
            return True
        stretch *= 2.0
    return False
