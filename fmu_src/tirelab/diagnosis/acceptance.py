"""Which fitted set is delivered: judged by its written tire, on the recordings as they were read.

Fits are made on the smoothed motion; the written tire reads the deflection as it comes, so it may leave more. What is
ranked is what is delivered: a set is refused where its written tire is clearly worse than that of another set of no
more effects, and where it is worse than the baseline on held-out data. No effect at all is always accepted. An effect
of the deflection alone is not named beside a refitted law on one surface, where that law alone leaves as little; nor is
an effect that is less likely than not, where the others leave as little without it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations

from ..estimation.explanation import Explanation
from ..names import REFITTED_LAW
from ..preprocessing.dataset import Dataset, Recorded
from ..preprocessing.kinematics import FloatArray
from .held_out import HeldOut, given, rmse, split

CONSIDERED = 6
"""Sets, the likeliest first, whose written tires are compared."""

WORSE = 1.01
"""A correction whose held-out error is more than this times the baseline's is refused; less is an effect that the
held-out data do not show."""

NO_WORSE = 0.9
"""A set is refused where one of no more effects leaves less than this part of what it leaves."""

LIKELY = 0.5
"""An effect of at least this probability is likelier there than not."""

Validate = Callable[[Explanation], HeldOut]


def accept(explanation: Explanation, validate: Validate) -> tuple[Explanation, HeldOut]:
    """Return the first of the sets in their order that is not refused, and what it does on held-out data.

    validate: what a set does there (see `validation_on`)
    """
    order = explanation.in_order(CONSIDERED)
    likely = [_plainer(explanation, names) for names in (order if () in order else (*order, ()))]
    left = [rmse(e.residuals) for e in likely]
    for chosen, own in zip(likely, left, strict=True):
        smaller = (v for e, v in zip(likely, left, strict=True) if len(e.effects) <= len(chosen.effects))
        if min(smaller) < NO_WORSE * own:
            continue
        validation = validate(chosen)
        if not chosen.effects or not is_worse(validation):
            return chosen, validation
    nothing = explanation.of(())
    return nothing, validate(nothing)


def without_unlikely(
    accepted: Explanation, validation: HeldOut, probabilities: Mapping[str, float], validate: Validate
) -> tuple[Explanation, HeldOut]:
    """Return the smallest fitted part of a set that holds all its effects which are likelier there than not, leaves as
    little as the set, and is no worse than the baseline on held-out data.

    probabilities: that each of its effects is there
    """
    likely = [n for n, p in probabilities.items() if p >= LIKELY]
    unlikely = sorted((n for n in probabilities if n not in likely), key=lambda n: -probabilities[n])
    most = rmse(accepted.residuals) / NO_WORSE
    for count in range(len(unlikely)):
        for kept in combinations(unlikely, count):
            names = (*likely, *kept)
            if not accepted.compared(names) or rmse(accepted.of(names).residuals) > most:
                continue
            found = validate(accepted.of(names))
            if not is_worse(found):
                return accepted.of(names), found
    return accepted, validation


def _plainer(explanation: Explanation, names: Sequence[str]) -> Explanation:
    """Return a set without effects that the refitted law beside them could be, if it leaves as little; else the set."""
    chosen, static = explanation.of(names), explanation.excitation.within_law
    less = [n for n in names if n == REFITTED_LAW or not static(n)]
    if REFITTED_LAW not in names or len(less) == len(names) or not explanation.compared(less):
        return chosen
    plainer = explanation.of(less)
    return plainer if rmse(plainer.residuals) * NO_WORSE <= rmse(chosen.residuals) else chosen


def is_worse(validation: HeldOut) -> bool:
    """Return whether the corrected tire is worse than the baseline on held-out data."""
    return validation.after > WORSE * validation.before


def validation_on(
    recordings: Sequence[Recorded],
    held_out: Sequence[Recorded],
    dataset: Dataset,
    before: Sequence[FloatArray],
) -> Validate:
    """Return how a set is validated: on recordings kept from the fit, else on a part of `recordings`.

    before [N]: what the baseline leaves of each recording
    """
    if held_out:
        return lambda chosen: given(held_out, recordings, dataset, before, chosen)
    return lambda chosen: split(recordings, dataset, before, chosen)
