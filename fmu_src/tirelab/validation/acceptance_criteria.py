"""Acceptance criteria of the blind trials, for seeds that nothing was tuned on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from .metrics import Mean, Rate, among, brier, exact, false_alarms, near_floor, recognised
from .score import Score

NOISE_FLOOR_MARGIN = 0.10
"""A held-out RMSE up to this part above the noise floor counts as being at it."""

ALIKE = "held-out RMSE within 10 % of the noise floor, tests of the diagnosed kinds"
OTHER = "the same, tests of another kind"


Result = Literal["pass", "fail", "too few trials", "not measured"]


@dataclass(frozen=True)
class Criterion:
    """One figure and its limit: the value has to be at least (`at_least`) or at most the limit.

    widest: an interval wider than this is too wide to judge by
    """

    figure: str
    measured: Rate | Mean
    limit: float
    at_least: bool
    widest: float = math.inf

    @property
    def passes(self) -> bool | None:
        """Whether the measured value meets the limit; None where it was not measured or by too few trials."""
        if self.result not in ("pass", "fail"):
            return None
        return self.result == "pass"

    @property
    def result(self) -> Result:
        """What came out, in words."""
        value, (low, high) = self.measured.value, self.measured.interval
        if math.isnan(value):
            return "not measured"
        if high - low > self.widest:
            return "too few trials"
        return "pass" if (value >= self.limit if self.at_least else value <= self.limit) else "fail"


def criteria(scores: Sequence[Score]) -> tuple[Criterion, ...]:
    """Return every figure of the drawn kinds with its limit; those of the wide kinds are in `wide_kinds`."""
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
