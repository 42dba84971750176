"""Which fitted set is delivered: judged by its written tire, on the recordings as they were read and on held-out data.

Fits are made on the smoothed motion, but the written tire is given the deflection as it is read, so it may leave more.
What is judged here is therefore what is delivered. A set is replaced by another one with no more effects whose written
tire leaves clearly less. It is refused where it is worse than the baseline on held-out data. The baseline without any
effect is always acceptable. Two kinds of effects are not named: on one surface, an effect of the deflection alone
beside a refitted law, where that law without it is nearly as likely; and an effect with a probability below one half,
where the others leave as little without it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

from ..estimation.explanation import Explanation
from ..names import REFITTED_LAW
from .held_out import HeldOut, Validate

CONSIDERED = 6
"""Number of the likeliest sets whose written tires are compared."""

WORSE = 1.01
"""A correction whose held-out error is more than this times that of the baseline is refused. Below it the held-out data
just do not show the effect."""

NO_WORSE = 0.9
"""A set is replaced by one with no more effects whose error is less than this part of its own."""

LIKELY = 0.5
"""Least probability of an effect that is kept unless it is idle."""


def accept(explanation: Explanation, validate: Validate) -> tuple[Explanation, HeldOut]:
    """Return the first set, in the order of the ranking, that is not refused, and its errors on held-out data.

    Each set is replaced before by one with no more effects that leaves clearly less, if there is one. The sets without
    one of its effects are fitted if they were not, and may then precede it.
    validate: returns the errors of a set on held-out data (see `validation_on`)
    """
    order = explanation.in_order(CONSIDERED)
    likely = [_plainer(explanation, names) for names in (order if () in order else (*order, ()))]
    least = list({e.model.names: e for e in (_leaving_least(e, likely) for e in likely)}.values())
    for chosen in least:
        validation = validate(chosen)
        if not chosen.effects or not is_worse(validation):
            break
    if not chosen.effects and chosen is not least[0]:
        others = [(e, validate(e)) for e in least[least.index(chosen) + 1 :]]
        chosen, validation = _foretelling((chosen, validation), others)
    whole = chosen.with_parts()
    return (chosen, validation) if whole is chosen else accept(whole, validate)


def _foretelling(
    nothing: tuple[Explanation, HeldOut], others: Sequence[tuple[Explanation, HeldOut]]
) -> tuple[Explanation, HeldOut]:
    """Return the baseline, or the set that is likelier than it by what it foretells of the held-out data too.

    Held-out data that refuse the likeliest sets refute the evidence, by which the baseline comes next.
    """
    odds = {e.names: e.log_evidence for e in nothing[0].evidence}
    return max([nothing, *others], key=lambda pair: odds[pair[0].model.names] + pair[1].evidence)


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
