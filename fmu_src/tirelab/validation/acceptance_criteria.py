"""Acceptance criteria of the blind trials, for seeds that nothing was tuned on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .metrics import Mean, Rate, among, brier, exact, false_alarms, near_floor, recognised
from .score import Score

NOISE_FLOOR_MARGIN = 0.10
"""A held-out RMSE up to this part above the noise floor counts as being at it."""

ALIKE = "held-out RMSE within 10 % of the noise floor, tests of the diagnosed kinds"
OTHER = "the same, tests of another kind"


@dataclass(frozen=True)
class Criterion:
    """One figure and its limit: the value has to be at least (`at_least`) or at most the limit."""

    figure: str
    measured: Rate | Mean
    limit: float
    at_least: bool

    @property
    def passes(self) -> bool | None:
        """Whether the measured value meets the limit; None where no trial measured it."""
        value = self.measured.value
        if math.isnan(value):
            return None
        return value >= self.limit if self.at_least else value <= self.limit


def criteria(scores: Sequence[Score]) -> tuple[Criterion, ...]:
    """Return every figure with its limit."""
    return (
        Criterion("exact set named", exact(scores), 0.90, at_least=True),
        Criterion("truth is the verdict or a stated alternative", among(scores), 0.97, at_least=True),
        Criterion("false alarms where nothing is hidden", false_alarms(scores), 0.02, at_least=False),
        Criterion("unknown recognised outside the catalogue", recognised(scores), 0.90, at_least=True),
        *(
            Criterion(
                f"{what}, {how}",
                near_floor(scores, NOISE_FLOOR_MARGIN, alike=alike, noise_free=noise_free),
                0.95,
                at_least=True,
            )
            for alike, what in ((True, ALIKE), (False, OTHER))
            for noise_free, how in (
                (False, "readings as recorded"),
                (True, "given the noise-free deflection"),
            )
        ),
        Criterion("Brier score of the confidence", brier(scores), 0.08, at_least=False),
    )
