"""Why effects cannot be shown that are another reading of the motion, or a constant of the refitted law of a part."""

from __future__ import annotations

from collections.abc import Sequence

from radialtire import CATALOGUE

from ..regressors.dataset import Dataset
from ..regressors.signature import Signature, constant, gap_of

LIKE_READING = "the noise of the deflection makes as large a response: move faster, or use a finer gauge"
"""Why an effect cannot be shown of which other readings of the motion give another response."""

LIKE_PRELOAD = "it is one force in this motion, as the preload of a refitted law"
"""The same of a part, whose law has a preload."""

LIKE_GAP = "it is the same as another gap of the part, a constant of the refitted law"
"""The same of a part, whose law begins beyond a gap."""

LIKE_CURVE = "in series with a curve it is another curve, a constant of the refitted law"
"""The same of a part whose force is a curve over its deflection."""


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
