"""Effects that cannot be shown: another reading of the motion, or a constant of the refitted law of a part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from radialtire import CATALOGUE

from ..regressors.dataset import Dataset
from ..regressors.signature import ALIKE, LAW, Signature, constant, gap_of
from .additions import followed
from .fit import Fit
from .ranking import Ranking

LIKE_READING = "the noise of the deflection makes as large a response: move faster, or use a finer gauge"
"""Why an effect cannot be shown of which other readings of the motion give another response."""

LIKE_PRELOAD = "it is one force in this motion, as the preload of a refitted law"
"""The same of a part, whose law has a preload."""

LIKE_GAP = "it is the same as another gap of the part, a constant of the refitted law"
"""The same of a part, whose law begins beyond a gap."""

LIKE_CURVE = "in series with a curve it is another curve, a constant of the refitted law"
"""The same of a part whose force is a curve over its deflection."""


@dataclass(frozen=True)
class Unshown:
    """Effects that recordings cannot show: each with the reason; signatures of those that are LIKE_READING; and those
    that a refitted law follows (`indistinct.followed_by_law`).
    """

    reasons: tuple[tuple[str, str], ...]
    unread: tuple[Signature, ...]
    like_law: tuple[str, ...]


def read_instead(ranking: Ranking, chosen: Fit, unread: Sequence[Signature]) -> tuple[tuple[str, str], ...]:
    """Return each effect of a fitted set with the one, of those that are LIKE_READING, that may be in its place.

    What the noise of the gauge makes is no evidence of such an effect, and none against it. Where its responses follow
    what the named one explains as closely as other readings of the same motion would have to follow them (ALIKE),
    nothing decides between the two.
    """
    found = []
    for name in (n for n in chosen.names if n != LAW and unread):
        if (less := ranking.of(frozenset(chosen.names) - {name})) is not None:
            explained = less.residual - chosen.residual
            found += [(name, s.name) for s in unread if followed(s, explained, less) > ALIKE]
    return tuple(found)


def like_law_of_part(signatures: Sequence[Signature], dataset: Dataset) -> dict[str, str]:
    """Return the effects that a refitted law of the dataset's part is in these recordings, each with the reason; none
    of a tire, whose law has neither preload nor gap nor curve.
    """
    tire, found = dataset.tire, dict[str, str]()
    if tire.two_sided:
        found |= dict.fromkeys(constant(signatures, dataset), LIKE_PRELOAD)
    if gap := gap_of(tire):
        found |= {gap[0].name: LIKE_GAP}
    if tire.curve is not None:
        series = (s.name for s in signatures if s.name in CATALOGUE and CATALOGUE[s.name].place == "series")
        found |= dict.fromkeys(series, LIKE_CURVE)
    return found
