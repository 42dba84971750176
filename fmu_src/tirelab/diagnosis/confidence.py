"""The confidence of a verdict, and the alternatives that the recordings cannot rule out.

The probability of a verdict is the rate at which verdicts with such grounds were right:

    p = 1 / (1 + exp(-(w_0 + sum_i w_i g_i)))

g_i: the grounds, numbers that every diagnosis has; w_i: weights, fitted by logistic regression to blind trials that
also hold physics outside the catalogue (`validation.calibrate`); they stand in `calibration.json` beside this file,
with the command and the seeds. Grounds that must lower a probability (a remainder, a worse fit on held-out data, a
motion that cannot show the claim) have weights of zero or below. Source of the method: J. Platt, "Probabilistic
outputs", Adv. Large Margin Classifiers (1999) 61.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files

import numpy as np
from radialtire import CATALOGUE

from ..estimation.explanation import Explanation
from ..estimation.findings import NamedEffect, Remainder
from ..names import REFITTED_LAW
from ..regressors.excitation import acts_on_reading
from .held_out import HeldOut

Grounds = Mapping[str, float]

MOST_LOG_ODDS, MOST_TRANSFER = 15.0, 3.0
"""Largest size of log odds, and of the logarithm of a held-out error over the fitted one, that is used as a ground."""

LEAST_SHARE = 1e-4
"""Shares of the misfit below this one count as this one."""

EITHER = 0.5
"""Part of a probability that one of two explanations has between which nothing decides."""

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
    """Return the grounds of the verdict's probability.

    remainder: of the written tire, as it is reported; unexplained: whether something unknown is reported

    odds: log posterior odds against all other sets; contested: tempered probability of all other sets
    remainder_share: share of the misfit in the remainder; remainder_size: ln(1 + its size over the noise)
    structure: the same for the part of the remainder that depends on a recorded coordinate
    transfer: ln(error on held-out data / error on fitted data)
    alike: ln(1 + number of sets that this motion cannot distinguish from the verdict's)
    imitated: effects that a refitted law can imitate, see `grounds_of_effect`
    law_alone: 1 where the verdict is a refitted law alone
    effects: their number; loudness: ln(misfit / noise); least_share: ln of the smallest share of an effect
    significance: smallest significance of an effect, see `grounds_of_effect`
    unknown: 1 where something unknown is reported; nothing: 1 where no effect is named
    unknown_size: remainder_size where something unknown is reported: a remainder hardly larger than the noise may be
    noise of another kind
    """
    rest = [e.log_evidence for e in explanation.evidence[1:]]
    chances = -float(np.logaddexp.reduce(rest)) if rest else MOST_LOG_ODDS
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
    """Return the grounds of the probability of one effect; those not explained here are as in `grounds_of_verdict`.

    odds: log odds of all sets with it against all without; contested: tempered probability of all sets without it
    share: ln of its share of the misfit; alike: ln(1 + number of effects that this motion cannot distinguish from it)
    imitated: for an effect that, on one surface, a law of another shape can imitate. Beside a refitted law: the number
    of its parameters of form, by which it can follow such a law (an effect with a strength only does not fit by
    chance). Else: the tempered odds, at most 1, of that law in place of all such effects
    beside_law: 1 where it depends on the deflection only, always or in this motion, and stands beside a refitted law,
    which may have another shape than the catalogue's
    significance: two-sided normal probability of the difference from neutral, of the parameter for which it is largest,
    or that of all of them together if it is larger; the standard deviations include the form errors
    """
    with_it = [e.log_evidence for e in explanation.evidence if effect.name in e.names]
    without = [e.log_evidence for e in explanation.evidence if effect.name not in e.names]
    odds = MOST_LOG_ODDS
    if without:
        odds = float(np.logaddexp.reduce(with_it) - np.logaddexp.reduce(without))
    names = [e.name for e in explanation.effects]
    law = effect.name == REFITTED_LAW
    like_law = not law and explanation.excitation.of_deflection(effect.name)
    alike = 0 if law else len(explanation.excitation.alike(effect.name))
    return {
        "odds": _limited(odds),
        "contested": sum(e.probability for e in explanation.evidence if effect.name not in e.names),
        "share": _share(effect),
        **_of_fit(explanation, validation, explanation.remainder),
        "alike": math.log1p(alike),
        "imitated": _imitated(effect.name, names, explanation),
        "beside_law": float(like_law and REFITTED_LAW in names and explanation.model.tire.is_part),
        "significance": _significance(effect),
        "effects": float(len(names)),
        "loudness": _loudness(explanation),
    }


def probability(of: str, grounds: Grounds) -> float:
    """Return the calibrated probability `of` a "verdict" or an "effect" with these grounds."""
    weights = _weights()[of]
    return 1.0 / (1.0 + math.exp(-weights["constant"] - sum(weights[n] * g for n, g in grounds.items())))


def probability_of_effect(name: str, grounds: Grounds) -> float:
    """Return the probability of an effect with these grounds.

    An effect of the deflection alone beside a refitted law may be what the shape of that law does not follow: laws are
    of any shape, and each of the two has half the probability. What a sensor does to the force is no law.
    """
    own = probability("effect", grounds)
    return EITHER * own if grounds["beside_law"] and not acts_on_reading(name) else own


def sharing_odds(probability: float, alike: int) -> float:
    """Return a verdict's probability p where the motion cannot distinguish this many other sets from it.

    They share its odds: each has p / (p + (1 - p) (1 + alike)). Calibration alone would not lower p,
    because in the trials the forms of these effects differ in reversals, which need not hold for real ones.
    """
    return probability / (probability + (1.0 - probability) * (1.0 + alike))


def no_surer_than_effects(probability: float, named: Sequence[float], doubted: Sequence[float] = ()) -> float:
    """Return a verdict's probability, limited by those of its effects.

    It is at most that of each named effect, and at most that of the absence of each effect left out as doubted.
    """
    return min((probability, *named, *(1.0 - p for p in doubted)))


def confidence_of(
    grounds: Grounds, named: Sequence[float], doubted: Sequence[float], share: float = 1.0
) -> float:
    """Return the confidence of a verdict with these grounds; named, doubted: probabilities of its effects and of those
    left out (see `no_surer_than_effects`).

    share: of the verdict's set among those that leave the same of the recordings. In the trials of the calibration each
    of these counted as right, so what it states is the probability of all of them together.

    The verdict that something unknown acts and no known effect contradicts all other sets. So it is at most as probable
    as its posterior odds against them say, and at most 50 % where held-out data refuted likelier sets. Calibration
    alone would not lower it: unknown effects in the trials differ from every known one, real ones are often known
    effects in other forms.
    """
    alike = round(math.expm1(grounds["alike"]))
    own = sharing_odds(probability("verdict", grounds), alike)
    if grounds["nothing"] and grounds["unknown"]:
        own = min(own, 1.0 / (1.0 + math.exp(-max(grounds["odds"], 0.0))))
    return share * no_surer_than_effects(own, named, doubted)


def of_confounded(probability: float, alike: int) -> float:
    """Return the inverse of `sharing_odds`: the probability of the verdict and the sets confounded with it together."""
    return probability * (1.0 + alike) / (1.0 + probability * alike)


def _loudness(explanation: Explanation) -> float:
    return math.log(max(float(np.sqrt(np.mean(explanation.model.fit.problem.dataset.misfit**2))), 1.0))


def _share(effect: NamedEffect) -> float:
    return math.log(max(effect.share, LEAST_SHARE))


def _significance(effect: NamedEffect) -> float:
    """Return the significance of an effect; 1 for a refitted law, whose columns are judged together by its odds."""
    if effect.name == REFITTED_LAW:
        return 1.0
    own = ((p, effect.parameters.get(p.name)) for p in CATALOGUE[effect.name].parameters if not p.optional)
    apart = [
        abs(e.value - p.neutral) / max(e.std, 1e-300)
        for p, e in own
        if e is not None and p.neutral is not None
    ]
    return max((effect.together, *(math.erf(z / math.sqrt(2.0)) for z in apart))) if apart else 1.0


def _of_fit(explanation: Explanation, validation: HeldOut, remainder: Remainder) -> dict[str, float]:
    left = max(explanation.error, 1e-300)
    depending = max((d.share for d in remainder.depends), default=0.0)
    return {
        "remainder_share": remainder.share,
        "remainder_size": math.log1p(remainder.size),
        "structure": math.log1p(remainder.size * math.sqrt(depending)),
        "transfer": min(max(math.log(max(validation.after, 1e-300) / left), 0.0), MOST_TRANSFER),
    }


def _imitated(name: str, names: Sequence[str], explanation: Explanation) -> float:
    """Return how well a law of another shape can imitate an effect, see `grounds_of_effect`."""
    within_law = explanation.excitation.within_law
    if name == REFITTED_LAW or not within_law(name):
        return 0.0
    if REFITTED_LAW in names:
        return float(sum(p.role == "form" and not p.optional for p in CATALOGUE[name].parameters))
    own = {n for n in names if not within_law(n)} | {REFITTED_LAW}
    instead = next((e for e in explanation.evidence if set(e.names) == own), None)
    return 0.0 if instead is None else min(instead.probability / max(explanation.probability, 1e-300), 1.0)


def _limited(odds: float) -> float:
    return min(max(odds, -MOST_LOG_ODDS), MOST_LOG_ODDS)


@cache
def _weights() -> Mapping[str, Mapping[str, float]]:
    content = json.loads((files(__package__) / "calibration.json").read_text(encoding="utf-8"))
    return {of: content[of]["weights"] for of in ("verdict", "effect")}
