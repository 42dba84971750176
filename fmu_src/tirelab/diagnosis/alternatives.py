"""Which other sets the recordings cannot rule out, and what they lack to do so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from radialtire import CATALOGUE

from ..estimation.explanation import Explanation
from ..planning.waveforms import Limits, second_pressure
from ..preprocessing.dataset import Dataset
from ..preprocessing.kinematics import STILL, BoolArray, FloatArray
from .confidence import unshared

CREDIBLE = 0.97
"""The verdict and its alternatives together hold this probability: the rate at which the truth should be among them."""

MOST = 10
"""So many alternatives are listed, the likeliest first."""

LONG_ENOUGH = 1.0
"""A hold: at rest for at least so many seconds."""

FASTER = 10.0
"""The factor to another speed."""

REACHED = 0.1
"""Speed [m/s] that every rig is taken to reach where its limits are not given; else twice the fastest recorded one."""

LAW_TRAITS = ("static",)
"""Traits of a refitted law: it depends on deflection and surface only."""


@dataclass(frozen=True)
class Alternative:
    """Another set of effects that the recordings cannot rule out: its probability, and what the recordings lack.

    log_odds: of the verdict against it, not tempered
    """

    names: tuple[str, ...]
    log_odds: float
    reason: str
    probability: float


def alternatives_of(
    explanation: Explanation, dataset: Dataset, confidence: float, limits: Limits | None = None
) -> tuple[Alternative, ...]:
    """Return the sets that the recordings cannot rule out; confidence: the calibrated probability of the verdict;
    limits: of the rig, where they are known.

    First those in which an effect that this motion cannot tell from one of the verdict's stands in its place: they have
    equal parts of what the verdict gave them (`confidence.shared`). Then the likeliest others until all together hold
    the probability CREDIBLE: what else the confidence leaves is shared by evidence. A set is not told as likelier
    beside the verdict than its evidence is: what is left then belongs to sets that nobody has compared.

    An effect that the excitation cannot show, and one that leaves no trace beside the verdict's refitted law, is an
    alternative beside the verdict, with the reason.
    """
    best = explanation.model.names
    own = next(e for e in explanation.evidence if set(e.names) == set(best))
    others = [e for e in explanation.evidence if set(e.names) != set(best)]
    whole = max(sum(e.probability for e in others), 1e-300)
    count = len(explanation.confounded)
    alone = unshared(confidence, count)
    covered, found = confidence, []
    for e in others:
        confounded = e.names in explanation.confounded
        if covered >= CREDIBLE and not confounded:
            continue
        equal = (alone - confidence) / count if confounded else 0.0
        left = (1.0 - alone) * e.probability / whole
        covered += equal + left
        told = equal + min(left, confidence * e.probability / max(own.probability, 1e-300))
        reason = reason_of(best, e.names, explanation, dataset, limits)
        found.append(Alternative(e.names, own.log_evidence - e.log_evidence, reason, told))
    found.sort(key=lambda a: a.names not in explanation.confounded)
    listed = found[:MOST]
    told_of = {frozenset(a.names) for a in listed}
    beside_law = {n: (*best, n) for n in explanation.within_law if frozenset((*best, n)) not in told_of}
    reasons = {n: reason_of(best, names, explanation, dataset, limits) for n, names in beside_law.items()}
    unseen = [
        Alternative(tuple(sorted({*best, name})), 0.0, why, float("nan"))
        for name, why in (*reasons.items(), *explanation.hidden)
    ]
    return (*listed, *unseen)


def reason_of(
    names: Sequence[str],
    other: Sequence[str],
    explanation: Explanation,
    dataset: Dataset,
    limits: Limits | None = None,
) -> str:
    """Return what the recordings lack to tell two sets apart, as an action."""
    differing = [set(_traits(n)) for n in set(names) ^ set(other)]
    common = set.intersection(*differing) if differing else set()
    lacks = insufficient_excitation(explanation, dataset, limits)
    if "static" in common:
        if not explanation.model.baseline.inflated:
            return "they depend on the deflection only: no motion of this part tells them apart"
        return f"they depend on deflection and surface only: {second_pressure(limits)}"
    if "slow" in common:
        return "they all change slowly with time: repeat the first cycle after a rest"
    if {"loop", "rate"} & set.union(set(), *differing):
        loops = [text for text in lacks if "surface" not in text]
        another = f"repeat at {_another_speed(dataset, limits)}"
        return "; ".join(loops) or f"their loops are alike at the recorded rates: {another}"
    return "; ".join(lacks) or "the difference is smaller than these recordings can show"


def insufficient_excitation(
    explanation: Explanation, dataset: Dataset, limits: Limits | None = None
) -> list[str]:
    """Return what the recordings lack that tells effects apart, each as an action."""
    timed = explanation.excitation.timed
    lacks = []
    if not timed:
        lacks.append("no time: record the time of each sample")
    elif explanation.excitation.one_speed:
        lacks.append(f"one speed only: repeat at {_another_speed(dataset, limits)}")
    mountable = set() if limits is None else set(limits.surfaces)
    if len(dataset.radii) == 1 and (not mountable or mountable - set(dataset.radii)):
        lacks.append("one surface only: press on a second surface")
    rates = [np.abs(e.motion.rate) for e in dataset.experiments]
    typical = max(float(np.sqrt(np.mean(r**2))) for r in rates)
    held = max(_longest_hold(e.time, np.abs(e.motion.rate) < STILL * typical) for e in dataset.experiments)
    if timed and held < LONG_ENOUGH:
        level = 650.0 * dataset.max_deflection
        lacks.append(f"no hold: hold 10 s at {level:.{'0f' if level >= 1.0 else '2g'}} mm")
    if max(float(e.motion.cycle.max()) for e in dataset.experiments) < 1.0:
        lacks.append("no repeated cycle: drive each cycle twice")
    return lacks


def _another_speed(dataset: Dataset, limits: Limits | None) -> str:
    """Return a speed far from those recorded, with its unit: ten times the typical one where the rig reaches that."""
    speeds = np.concatenate([np.abs(e.motion.rate) for e in dataset.experiments])
    typical, fastest = float(np.sqrt(np.mean(speeds**2))), float(speeds.max())
    reached = max(2.0 * fastest, REACHED) if limits is None else limits.fastest
    speed = FASTER * typical if FASTER * typical <= reached else typical / FASTER
    return f"{float(f'{1e3 * speed:.2g}'):g} mm/s"


def _traits(name: str) -> tuple[str, ...]:
    return CATALOGUE[name].traits if name in CATALOGUE else LAW_TRAITS


def _longest_hold(time: FloatArray, still: BoolArray) -> float:
    ends = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]])))
    return max(
        (float(time[b - 1] - time[a]) for a, b in zip(ends[::2], ends[1::2], strict=True)), default=0.0
    )
