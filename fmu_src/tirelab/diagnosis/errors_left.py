"""What the accepted set leaves of the recordings: errors, a remainder, and on what something unexplained depends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from radialtire import TireModel

from ..estimation.explanation import Explanation
from ..estimation.findings import Remainder, of_the_written_tire
from ..preprocessing.motion import FloatArray, Motion
from ..preprocessing.samples import OF_TIME, RawDataset, Recorded, is_timed
from ..preprocessing.straight import at_one_rate
from .held_out import HeldOut, rmse
from .localization import Span, localize
from .residual_model import ResidualModel, residual_models, unexplained_by
from .verdict import FitErrors


@dataclass(frozen=True)
class FittedData:
    """The baseline, the fitted recordings and those that are held out; of the fitted ones the samples and the residuals
    [N] of the baseline in each.
    """

    baseline: TireModel
    fitted: Sequence[Recorded]
    kept: Sequence[Recorded]
    samples: RawDataset
    residuals: Sequence[FloatArray]

    @cached_property
    def timed(self) -> bool:
        """Whether the times of all samples were measured."""
        return is_timed(self.fitted)

    @property
    def motions(self) -> list[Motion]:
        """The motion of each fitted recording."""
        return [e.motion for e in self.samples.experiments]

    @cached_property
    def unknown(self) -> frozenset[str]:
        """The coordinates that the recordings do not show: those that need times which were not measured, and the
        acceleration of motions at one rate, which is rounding.
        """
        found = frozenset() if self.timed else frozenset(OF_TIME)
        straight = all(at_one_rate(e.time, e.motion) for e in self.samples.experiments)
        return found | {"acceleration"} if straight else found

    def shown(self, places: Sequence[Span]) -> tuple[Span, ...]:
        """Return the places without those over coordinates that the recordings do not show."""
        return tuple(place for place in places if place.by not in self.unknown)


@dataclass(frozen=True)
class Left:
    """What the accepted set leaves: the errors, the remainder, the coordinates on which something unexplained depends,
    and the regressions of that.
    """

    fit: FitErrors
    remainder: Remainder
    unexplained: tuple[str, ...]
    models: tuple[ResidualModel, ...]


def left_by(explanation: Explanation, validation: HeldOut, data: FittedData) -> Left:
    """Return what an accepted set leaves; validation: its errors on held-out data."""
    fit = _errors(data, explanation, validation)
    remainder = _remainder(data, explanation, fit.noise)
    unexplained = _unexplained(data, explanation, remainder)
    models = residual_models(unexplained, data.samples, explanation.residuals, validation)
    return Left(fit, remainder, unexplained, models)


def _errors(data: FittedData, explanation: Explanation, validation: HeldOut) -> FitErrors:
    """Return the noise floor and the errors [N] before and after the correction, over the compared samples."""
    sizes = np.array([r.size for r in data.residuals], dtype=float)
    levels = np.array([f.level for f in explanation.floors])
    return FitErrors(
        float(np.sqrt(np.sum(sizes * levels**2) / sizes.sum())),
        rmse(_compared(data.residuals, explanation)),
        explanation.error,
        validation.before,
        validation.after,
        validation.by,
        validation.noise_free,
        explanation.error_left,
    )


def _compared(residuals: Sequence[FloatArray], explanation: Explanation) -> list[FloatArray]:
    return [r[seen] for r, seen in zip(residuals, explanation.compared, strict=True)]


def _remainder(data: FittedData, explanation: Explanation, noise: float) -> Remainder:
    """Return the remainder of the written tire, without a dependence on times that were not measured."""
    before, after = (_compared(residuals, explanation) for residuals in (data.residuals, explanation.left))
    remainder = of_the_written_tire(explanation.remainder, before, after, noise)
    if data.timed:
        return remainder
    return replace(remainder, depends=tuple(d for d in remainder.depends if d.coordinate not in OF_TIME))


def _unexplained(data: FittedData, explanation: Explanation, remainder: Remainder) -> tuple[str, ...]:
    """Return the coordinates on which an unexplained remainder depends; none where nothing is unexplained."""
    residuals = explanation.left
    places = data.shown(localize(data.fitted, data.samples, residuals, explanation.noises, residuals))
    return tuple(by for by in unexplained_by(remainder, places) if by not in data.unknown)
