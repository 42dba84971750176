"""The unexplained remainder: its regression over one coordinate, and by cross-validation whether it repeats."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..estimation.findings import UNEXPLAINED_SHARE, UNEXPLAINED_SIZE, Remainder
from ..preprocessing.data_checks import MAJORITY
from ..preprocessing.motion import BoolArray, FloatArray, IndexArray
from ..preprocessing.samples import RawDataset, RawExperiment
from .held_out import HeldOut, rmse
from .localization import Span

KNOTS = 120
SAMPLES_PER_KNOT = 30
"""Most knots of a curve, and fewest samples for each. Straight lines through eight knots per wave miss it by 4 % of its
height (root mean square), so that a ripple with a period of a fifteenth of the range is followed."""

FOLDS = 5
"""Number of blocks of time in the cross-validation; each is predicted from the others."""

CLASSES = 10 * FOLDS
"""Number of classes of a coordinate's values. One in which samples of two blocks of time are was visited again."""

Coordinate = Callable[[RawExperiment], FloatArray]

COORDINATES: dict[str, tuple[str, Coordinate]] = {
    "deflection": ("m", lambda r: r.motion.deflection),
    "rate": ("m/s", lambda r: r.motion.rate),
    "acceleration": ("m/s^2", lambda r: r.motion.acceleration),
    "force": ("N", lambda r: r.elastic(r.motion.deflection)),
}
"""Unit and values of each coordinate; a residual that depends on any other one is regressed over time."""


@dataclass(frozen=True)
class ResidualModel:
    """A regression of a residual that no effect explains: force [N] over one coordinate, and whether it repeats.

    by: coordinate; at: its values in `unit`; force [N]; r2: cross-validated R^2 over blocks of time where they have the
    same values, negative where the curve does not repeat, NaN where most values were there once
    after, held_out_after: RMSE [N] of the corrected tire with the force added, on fitted and on held-out data
    """

    by: str
    unit: str
    at: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)
    r2: float = 0.0
    after: float = float("nan")
    held_out_after: float = float("nan")

    def to_dict(self) -> dict[str, object]:
        """Return an entry of `corrections` in diagnosis.json."""
        return {
            "by": self.by,
            "unit": self.unit,
            "repeats": self.r2,
            "after": self.after,
            "held_out_after": self.held_out_after,
            "at": self.at.tolist(),
            "force": self.force.tolist(),
        }


def unexplained_by(remainder: Remainder, places: Sequence[Span]) -> tuple[str, ...]:
    """Return the coordinates on which an unexplained remainder depends: none where it is noise or a form error.

    places: of the remainder. A short disturbance may be less than the noise over the whole recording; in its own place
    it is judged by the same bounds.
    """
    if remainder.unexplained:
        return tuple(d.coordinate for d in remainder.depends) or ("time",)
    return tuple(
        dict.fromkeys(
            place.by
            for place in places
            if place.by in (*COORDINATES, "time")
            and place.size > UNEXPLAINED_SIZE
            and place.share * remainder.share > UNEXPLAINED_SHARE
        )
    )


def residual_models(
    coordinates: Sequence[str], dataset: RawDataset, residuals: Sequence[FloatArray], validation: HeldOut
) -> tuple[ResidualModel, ...]:
    """Return a regression over each of `coordinates`, from the residual of each recording [N]."""
    return tuple(_regressed(by, dataset, residuals, validation) for by in coordinates)


def _regressed(
    by: str, dataset: RawDataset, residuals: Sequence[FloatArray], validation: HeldOut
) -> ResidualModel:
    unit, coordinate = COORDINATES.get(by, ("s", lambda r: r.time))
    at = np.concatenate([coordinate(r) for r in dataset.experiments])
    force = np.concatenate(residuals)
    part = np.concatenate(
        [
            np.minimum((FOLDS * r.time / (r.time[-1] + 1e-9)).astype(int), FOLDS - 1)
            for r in dataset.experiments
        ]
    )
    knots = _knots(at)
    again = _visited_again(at, part)
    predicted = np.zeros_like(force)
    for fold in range(FOLDS):
        predicted[part == fold] = _curve(at[part != fold], force[part != fold], knots, at[part == fold])
    missed = np.sum((force - predicted)[again] ** 2)
    r2 = float(1.0 - missed / np.sum(force[again] ** 2)) if again.mean() > MAJORITY else float("nan")
    curve = _curve(at, force, knots, knots)
    left = force - np.interp(at, knots, curve)
    return ResidualModel(by, unit, knots, curve, r2, rmse([left]), _held_out_error(coordinate, validation))


def _visited_again(at: FloatArray, part: IndexArray) -> BoolArray:
    """Return which values (n,) were there in another block of time too; part: number of the block of each."""
    low, span = float(at.min()), max(float(np.ptp(at)), 1e-300)
    own = np.minimum((CLASSES * (at - low) / span).astype(int), CLASSES - 1)
    held = np.zeros((CLASSES, FOLDS), dtype=bool)
    held[own, part] = True
    return np.asarray(held.sum(axis=1)[own] > 1)


def _held_out_error(coordinate: Coordinate, validation: HeldOut) -> float:
    """Return the RMSE [N] on what is held out, with the regression of what was fitted there."""
    at = np.concatenate([coordinate(p.experiment)[p.chosen] for p in validation.fitted])
    force = np.concatenate([p.after[p.chosen] for p in validation.fitted])
    knots = _knots(at)
    return rmse(
        [
            p.after[p.chosen] - _curve(at, force, knots, coordinate(p.experiment)[p.chosen])
            for p in validation.held_out
        ]
    )


def _knots(at: FloatArray) -> FloatArray:
    """Return the points of a curve over `at`: two of three where the samples are, one of three evenly between."""
    count = min(KNOTS, max(at.size // SAMPLES_PER_KNOT, 6))
    even = np.linspace(at.min(), at.max(), count // 3 + 1)
    knots = np.sort(np.concatenate([np.quantile(at, np.linspace(0.0, 1.0, count - count // 3)), even]))
    # Points that almost coincide would make a step.
    apart = np.diff(knots, prepend=-np.inf) > 1e-6 * (even[-1] - even[0])
    return np.asarray(knots[apart])


def _curve(at: FloatArray, force: FloatArray, knots: FloatArray, wanted: FloatArray) -> FloatArray:
    """Return the broken line through `knots` that fits force over `at` best, lightly smoothed, at `wanted`."""
    place = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, knots.size - 2)
    width = knots[place + 1] - knots[place]
    share = np.clip((at - knots[place]) / width, 0.0, 1.0)
    gram = np.zeros((knots.size, knots.size))
    moment = np.zeros(knots.size)
    for first, a in ((0, 1.0 - share), (1, share)):
        np.add.at(moment, place + first, a * force)
        for second, b in ((0, 1.0 - share), (1, share)):
            np.add.at(gram, (place + first, place + second), a * b)
    bend = np.diff(np.eye(knots.size), 2, axis=0)
    gram += 1e-3 * at.size / knots.size * (bend.T @ bend) + 1e-9 * at.size * np.eye(knots.size)
    return np.asarray(np.interp(wanted, knots, np.linalg.solve(gram, moment)))
