"""How sure a verdict is: what speaks for and against it, and the rate at which such verdicts were right.

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
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

import numpy as np

from ..estimation.explanation import Explanation
from ..estimation.findings import NamedEffect
from ..names import REFITTED_LAW
from ..regressors.excitation import of_deflection
from .held_out import HeldOut, rmse

Grounds = Mapping[str, float]

FURTHEST = 15.0
"""Log odds beyond which a ranking says no more."""

SMALLEST = 1e-4
"""Share of the misfit below which shares are alike."""

OF_VERDICT = (
    "odds",
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
    "unknown",
    "nothing",
)
OF_EFFECT = (
    "odds",
    "share",
    "remainder_share",
    "remainder_size",
    "structure",
    "transfer",
    "alike",
    "imitated",
    "effects",
    "loudness",
)
"""Grounds of the verdict and of one effect; each is explained in `grounds_of_verdict`."""

LOWERING = ("remainder_share", "remainder_size", "structure", "transfer", "alike", "imitated", "law_alone")
"""Grounds that may only lower a probability."""


def grounds_of_verdict(
    explanation: Explanation, validation: HeldOut, *, unexplained: bool
) -> dict[str, float]:
    """Return what the verdict's probability rests on; unexplained: whether something unknown is told.

    odds: log posterior odds against all other sets; remainder_share: of the misfit; remainder_size: ln(1 + size over
    the noise); structure: the same of what in the remainder depends on a recorded coordinate
    transfer: ln of the error on held-out data over the fitted one; alike: ln(1 + sets that this motion cannot tell from
    it); imitated: effects beside a refitted law that could be a part of it
    effects: their number; loudness: ln of the misfit over the noise; least_share: ln of the least share of an effect
    unknown, nothing: 1 where it tells of something unknown, and where it names no effect
    """
    rest = [e.log_evidence for e in explanation.evidence[1:]]
    chances = -float(np.logaddexp.reduce(rest)) if rest else FURTHEST
    names = [e.name for e in explanation.effects]
    return {
        "odds": _limited(chances),
        **_of_fit(explanation, validation),
        "alike": math.log1p(len(explanation.confounded)),
        "imitated": float(sum(_imitated(n, names, explanation) for n in names)),
        "law_alone": float(names == [REFITTED_LAW]),
        "effects": float(len(names)),
        "loudness": _loudness(explanation),
        "least_share": min((_share(e) for e in explanation.effects), default=0.0),
        "unknown": float(unexplained),
        "nothing": float(not names),
    }


def grounds_of_effect(effect: NamedEffect, explanation: Explanation, validation: HeldOut) -> dict[str, float]:
    """Return what the probability of one named effect rests on, see `grounds_of_verdict`.

    odds: log odds of all sets with it against all without; share: ln of its share of the misfit
    alike: ln(1 + effects that this motion cannot tell from it); imitated: whether it depends on the deflection alone
    and stands beside a refitted law, which may have another form than the catalogue's on several surfaces too
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
        "share": _share(effect),
        **_of_fit(explanation, validation),
        "alike": math.log1p(alike),
        "imitated": float(not law and REFITTED_LAW in names and of_deflection(effect.name)),
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


def unshared(probability: float, alike: int) -> float:
    """Return the probability of which `shared` made this one: that of the verdict and the sets alike together."""
    return probability * (1.0 + alike) / (1.0 + probability * alike)


def _loudness(explanation: Explanation) -> float:
    return math.log(max(float(np.sqrt(np.mean(explanation.model.fit.problem.dataset.misfit**2))), 1.0))


def _share(effect: NamedEffect) -> float:
    return math.log(max(effect.share, SMALLEST))


def _of_fit(explanation: Explanation, validation: HeldOut) -> dict[str, float]:
    left, remainder = max(rmse(explanation.residuals), 1e-300), explanation.remainder
    depending = max((d.share for d in remainder.depends), default=0.0)
    return {
        "remainder_share": remainder.share,
        "remainder_size": math.log1p(remainder.size),
        "structure": math.log1p(remainder.size * math.sqrt(depending)),
        "transfer": min(max(math.log(max(validation.after, 1e-300) / left), 0.0), 3.0),
    }


def _imitated(name: str, names: list[str], explanation: Explanation) -> bool:
    """Whether a law of another shape could be what an effect is, and stands beside it."""
    return name != REFITTED_LAW and REFITTED_LAW in names and explanation.excitation.within_law(name)


def _limited(odds: float) -> float:
    return min(max(odds, -FURTHEST), FURTHEST)


@cache
def _weights() -> Mapping[str, Mapping[str, float]]:
    content = json.loads((files(__package__) / "calibration.json").read_text(encoding="utf-8"))
    return {of: content[of]["weights"] for of in ("verdict", "effect")}
