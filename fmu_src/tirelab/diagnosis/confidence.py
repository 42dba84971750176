"""How sure a verdict is, and which other sets the recordings cannot rule out.

What speaks for and against a verdict gives the rate at which such verdicts were right:

    p = 1 / (1 + exp(-(w_0 + sum_i w_i g_i)))

g_i: the grounds, numbers that every diagnosis has; w_i: fitted by logistic regression to blind trials on worlds wider
than the catalogue (`validation.calibrate`), in `calibration.json` beside this file, with the command and the seeds. The
weights of what must lower a probability (a remainder, a worse fit on held-out data, a motion that cannot show what is
claimed) are held at zero or below. Source of the method: J. Platt, "Probabilistic outputs", Adv. Large Margin
Classifiers (1999) 61.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from radialtire import CATALOGUE

from ..estimation.explanation import Explanation
from ..estimation.findings import NamedEffect, Remainder
from ..names import REFITTED_LAW
from ..planning.waveforms import Limits, second_pressure
from ..preprocessing.motion import BoolArray, FloatArray
from ..preprocessing.noise import STILL
from ..preprocessing.samples import RawDataset
from ..regressors.excitation import of_deflection
from .acceptance import HeldOut

Grounds = Mapping[str, float]

FURTHEST = 15.0
"""Log odds beyond which a ranking says no more."""

SMALLEST = 1e-4
"""Share of the misfit below which shares are alike."""

OF_VERDICT = (
    "odds",
    "contested",
    "remainder_share",
    "remainder_size",
    "structure",
    "transfer",
    "alike",
    "imitated",
    "law_alone",
    "effects",
    "loudness",
    "least_share",
    "significance",
    "unknown",
    "unknown_size",
    "nothing",
)
OF_EFFECT = (
    "odds",
    "contested",
    "share",
    "remainder_share",
    "remainder_size",
    "structure",
    "transfer",
    "alike",
    "imitated",
    "beside_law",
    "significance",
    "effects",
    "loudness",
)
"""Grounds of the verdict and of one effect; each is explained in `grounds_of_verdict`."""

LOWERING = (
    *("contested", "remainder_share", "remainder_size", "structure", "transfer"),
    *("alike", "imitated", "beside_law", "law_alone"),
)
"""Grounds that may only lower a probability."""

RAISING = ("odds",)
"""Grounds that may only raise one."""


def grounds_of_verdict(
    explanation: Explanation, validation: HeldOut, remainder: Remainder, *, unexplained: bool
) -> dict[str, float]:
    """Return what the verdict's probability rests on; remainder: of the written tire, as it is told; unexplained:
    whether something unknown is told.

    odds: log posterior odds against all other sets; contested: tempered probability of these
    remainder_share: of the misfit; remainder_size: ln(1 + size over the noise)
    structure: the same of what in the remainder depends on a recorded coordinate
    transfer: ln of the error on held-out data over the fitted one; alike: ln(1 + sets that this motion cannot tell from
    it); imitated: effects that a refitted law could be, see `grounds_of_effect`
    effects: their number; loudness: ln of the misfit over the noise; least_share: ln of the least share of an effect
    significance: of the effect that has the least, see `grounds_of_effect`
    unknown, nothing: 1 where it tells of something unknown, and where it names no effect; unknown_size: the
    remainder_size of something unknown, since what is hardly more than the noise may be noise of another kind
    """
    rest = [e.log_evidence for e in explanation.evidence[1:]]
    chances = -float(np.logaddexp.reduce(rest)) if rest else FURTHEST
    names = [e.name for e in explanation.effects]
    of_fit = _of_fit(explanation, validation, remainder)
    return {
        "odds": _limited(chances),
        "contested": 1.0 - explanation.probability,
        **of_fit,
        "alike": math.log1p(len(explanation.confounded)),
        "imitated": sum(_imitated(n, names, explanation) for n in names),
        "law_alone": float(names == [REFITTED_LAW]),
        "effects": float(len(names)),
        "loudness": _loudness(explanation),
        "least_share": min((_share(e) for e in explanation.effects), default=0.0),
        "significance": min((_significance(e) for e in explanation.effects), default=1.0),
        "unknown": float(unexplained),
        "unknown_size": of_fit["remainder_size"] if unexplained else 0.0,
        "nothing": float(not names),
    }


def grounds_of_effect(effect: NamedEffect, explanation: Explanation, validation: HeldOut) -> dict[str, float]:
    """Return what the probability of one named effect rests on, see `grounds_of_verdict`.

    odds: log odds of all sets with it against all without; contested: tempered probability of these
    share: ln of its share of the misfit; alike: ln(1 + effects that this motion cannot tell from it)
    imitated: of an effect that a law of another shape could be, on one surface: beside the refitted law the number of
    its parameters of form, which let it follow such a law (one that has a strength alone fits by no accident), else
    the odds, at most 1, of that law in the place of all such effects, tempered; beside_law: whether it depends on the
    deflection alone and stands beside a refitted law, which may have another form than the catalogue's
    significance: normal probability, two-sided, with which that of its parameters which the recordings determine best
    differs from its neutral value; its standard deviation counts the errors of the forms
    """
    with_it = [e.log_evidence for e in explanation.evidence if effect.name in e.names]
    without = [e.log_evidence for e in explanation.evidence if effect.name not in e.names]
    odds = FURTHEST
    if without:
        odds = float(np.logaddexp.reduce(with_it) - np.logaddexp.reduce(without))
    names = [e.name for e in explanation.effects]
    law = effect.name == REFITTED_LAW
    alike = 0 if law else len(explanation.excitation.alike(effect.name))
    return {
        "odds": _limited(odds),
        "contested": sum(e.probability for e in explanation.evidence if effect.name not in e.names),
        "share": _share(effect),
        **_of_fit(explanation, validation, explanation.remainder),
        "alike": math.log1p(alike),
        "imitated": _imitated(effect.name, names, explanation),
        "beside_law": float(not law and REFITTED_LAW in names and of_deflection(effect.name)),
        "significance": _significance(effect),
        "effects": float(len(names)),
        "loudness": _loudness(explanation),
    }


def probability(of: str, grounds: Grounds) -> float:
    """Return the calibrated probability `of` a "verdict" or an "effect" with these grounds."""
    weights = _weights()[of]
    return 1.0 / (1.0 + math.exp(-weights["constant"] - sum(weights[n] * g for n, g in grounds.items())))


def shared(probability: float, alike: int) -> float:
    """Return a verdict's probability where the motion cannot tell as many other sets from it: they share its odds.

    Calibration alone would not lower it: the rig's forms differ where the motion turns, and real ones differ otherwise.
    """
    return probability / (probability + (1.0 - probability) * (1.0 + alike))


def of_all(probability: float, named: Sequence[float], doubted: Sequence[float] = ()) -> float:
    """Return a verdict's probability beside those of the effects that it names and of those that it leaves out as
    doubted: it is no surer than that any of the former is there, or that any of the latter is not.
    """
    return min((probability, *named, *(1.0 - p for p in doubted)))


def confidence_of(grounds: Grounds, named: Sequence[float], doubted: Sequence[float]) -> float:
    """Return the confidence of a verdict with these grounds; named, doubted: probabilities of effects (`of_all`).

    One that something unknown acts, and no known effect, is no surer than its posterior, for it denies what all other
    sets name; where held-out data refuted likelier ones, it is as likely as not. Calibration alone would not lower it:
    drawn unknown effects are far from every known one, real ones are often known ones in other forms.
    """
    alike = round(math.expm1(grounds["alike"]))
    own = shared(probability("verdict", grounds), alike)
    if grounds["nothing"] and grounds["unknown"]:
        own = min(own, 1.0 / (1.0 + math.exp(-max(grounds["odds"], 0.0))))
    return of_all(own, named, doubted)


def unshared(probability: float, alike: int) -> float:
    """Return the probability of which `shared` made this one: that of the verdict and the sets alike together."""
    return probability * (1.0 + alike) / (1.0 + probability * alike)


def _loudness(explanation: Explanation) -> float:
    return math.log(max(float(np.sqrt(np.mean(explanation.model.fit.problem.dataset.misfit**2))), 1.0))


def _share(effect: NamedEffect) -> float:
    return math.log(max(effect.share, SMALLEST))


def _significance(effect: NamedEffect) -> float:
    """Return the significance of an effect; 1 of a refitted law, whose columns are judged together by its odds."""
    if effect.name == REFITTED_LAW:
        return 1.0
    own = ((p, effect.parameters.get(p.name)) for p in CATALOGUE[effect.name].parameters if not p.optional)
    apart = [
        abs(e.value - p.neutral) / max(e.std, 1e-300)
        for p, e in own
        if e is not None and p.neutral is not None
    ]
    return max((math.erf(z / math.sqrt(2.0)) for z in apart), default=1.0)


def _of_fit(explanation: Explanation, validation: HeldOut, remainder: Remainder) -> dict[str, float]:
    left = max(explanation.error, 1e-300)
    depending = max((d.share for d in remainder.depends), default=0.0)
    return {
        "remainder_share": remainder.share,
        "remainder_size": math.log1p(remainder.size),
        "structure": math.log1p(remainder.size * math.sqrt(depending)),
        "transfer": min(max(math.log(max(validation.after, 1e-300) / left), 0.0), 3.0),
    }


def _imitated(name: str, names: Sequence[str], explanation: Explanation) -> float:
    """Return how well a law of another shape could be what an effect is, see `grounds_of_effect`."""
    within_law = explanation.excitation.within_law
    if name == REFITTED_LAW or not within_law(name):
        return 0.0
    if REFITTED_LAW in names:
        return float(sum(p.role == "form" and not p.optional for p in CATALOGUE[name].parameters))
    own = {n for n in names if not within_law(n)} | {REFITTED_LAW}
    instead = next((e for e in explanation.evidence if set(e.names) == own), None)
    return 0.0 if instead is None else min(instead.probability / max(explanation.probability, 1e-300), 1.0)


def _limited(odds: float) -> float:
    return min(max(odds, -FURTHEST), FURTHEST)


@cache
def _weights() -> Mapping[str, Mapping[str, float]]:
    content = json.loads((files(__package__) / "calibration.json").read_text(encoding="utf-8"))
    return {of: content[of]["weights"] for of in ("verdict", "effect")}


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

    log_odds: of the verdict against it, not tempered; left [N]: what its tire leaves, where nothing else is named
    """

    names: tuple[str, ...]
    log_odds: float
    reason: str
    probability: float
    left: float = float("nan")


def alternatives_of(
    explanation: Explanation, dataset: RawDataset, confidence: float, limits: Limits | None = None
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
    dataset: RawDataset,
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
    explanation: Explanation, dataset: RawDataset, limits: Limits | None = None
) -> list[str]:
    """Return what the recordings lack that tells effects apart, each as an action."""
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
    typical = max(float(np.sqrt(np.mean(r**2))) for r in rates)
    held = max(_longest_hold(e.time, np.abs(e.motion.rate) < STILL * typical) for e in dataset.experiments)
    if timed and held < LONG_ENOUGH:
        level = 650.0 * dataset.max_deflection
        lacks.append(f"no hold: hold 10 s at {level:.{'0f' if level >= 1.0 else '2g'}} mm")
    if max(float(e.motion.cycle.max()) for e in dataset.experiments) < 1.0:
        lacks.append("no repeated cycle: drive each cycle twice")
    return lacks


def _another_speed(dataset: RawDataset, limits: Limits | None) -> str:
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
