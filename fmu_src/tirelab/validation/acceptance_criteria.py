"""The bar of the proof: what a diagnosis has to reach on seeds that nobody tuned on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .metrics import Mean, Rate, among, brier, exact, false_alarms, near_floor, recognised
from .score import Score

NEAR_FLOOR = 0.10
"""A held-out RMSE counts as at the noise floor up to this part above it."""

ALIKE = "held-out RMSE within 10 % of the floor on tests like those diagnosed"
OTHER = "the same on tests of another kind"


@dataclass(frozen=True)
class Line:
    """One figure beside its bar: the value has to be at least (`at_least`) or at most the bar."""

    figure: str
    measured: Rate | Mean
    bar: float
    at_least: bool

    @property
    def passes(self) -> bool | None:
        """Whether the measured value meets the bar; None where there was no trial to measure it on."""
        value = self.measured.value
        if math.isnan(value):
            return None
        return value >= self.bar if self.at_least else value <= self.bar


def against_the_bar(scores: Sequence[Score]) -> tuple[Line, ...]:
    """Return every figure beside its bar."""
    return (
        Line("exact set named", exact(scores), 0.90, at_least=True),
        Line("truth is the verdict or a rival", among(scores), 0.97, at_least=True),
        Line("false alarms where nothing is hidden", false_alarms(scores), 0.02, at_least=False),
        Line("unknown said outside the catalogue", recognised(scores), 0.90, at_least=True),
        *(
            Line(
                f"{what}, {how}",
                near_floor(scores, NEAR_FLOOR, alike=alike, cleared=cleared),
                0.95,
                at_least=True,
            )
            for alike, what in ((True, ALIKE), (False, OTHER))
            for cleared, how in (
                (False, "readings as they are"),
                (True, "told the motion without their noise"),
            )
        ),
        Line("Brier score of the confidence", brier(scores), 0.08, at_least=False),
    )
