"""What can be learned of something beyond the catalogue: the force over one coordinate, and whether it repeats."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..preprocessing.dataset import Record, Scene
from ..preprocessing.kinematics import FloatArray
from .held_out import HeldOut, rmse
from .verdict import Correction

KNOTS = 120
SAMPLES_PER_KNOT = 30
"""Points of a learned curve: between eight points of a wave straight lines miss it by 4 % of its height root mean
square, so that a ripple of a fifteenth of the range is followed; short recordings have fewer."""

FOLDS = 5
"""Parts into which time is cut; each is foretold from the others."""

Coordinate = Callable[[Record], FloatArray]

COORDINATES: dict[str, tuple[str, Coordinate]] = {
    "deflection": ("m", lambda r: r.motion.deflection),
    "surface": ("m", lambda r: r.motion.deflection),
    "direction": ("m", lambda r: r.motion.deflection * r.motion.direction),
    "rate": ("m/s", lambda r: r.motion.rate),
    "rate and deflection": ("m/s", lambda r: r.motion.rate),
    "acceleration": ("m/s^2", lambda r: r.motion.acceleration),
    "resonance": ("m/s^2", lambda r: r.motion.acceleration),
    "history": ("m", lambda r: r.motion.turned * r.motion.direction),
    "way": ("m", lambda r: np.cumsum(np.abs(np.diff(r.motion.deflection, prepend=r.motion.deflection[0])))),
}
"""The coordinate over which each kind of misfit is learned; what is not here is learned over time."""


def learned(
    beyond: Sequence[str], scene: Scene, residuals: Sequence[FloatArray], kept: HeldOut
) -> tuple[Correction, ...]:
    """Return a correction for each coordinate in `beyond`, from what is left of each recording [N]."""
    return tuple(_learned(by, scene, residuals, kept) for by in beyond)


def _learned(by: str, scene: Scene, residuals: Sequence[FloatArray], kept: HeldOut) -> Correction:
    unit, coordinate = COORDINATES.get(by, ("s", lambda r: r.time))
    at = np.concatenate([coordinate(r) for r in scene.records])
    force = np.concatenate(residuals)
    part = np.concatenate(
        [np.minimum((FOLDS * r.time / (r.time[-1] + 1e-9)).astype(int), FOLDS - 1) for r in scene.records]
    )
    knots = _knots(at)
    foretold = np.zeros_like(force)
    for fold in range(FOLDS):
        foretold[part == fold] = _curve(at[part != fold], force[part != fold], knots, at[part == fold])
    gain = 1.0 - float(np.sum((force - foretold) ** 2) / np.sum(force**2))
    curve = _curve(at, force, knots, knots)
    left = force - np.interp(at, knots, curve)
    return Correction(by, unit, knots, curve, gain, rmse([left]), _unseen(coordinate, kept))


def _unseen(coordinate: Coordinate, kept: HeldOut) -> float:
    """Return the RMSE [N] on what is held out, with the correction learned on what was fitted there."""
    at = np.concatenate([coordinate(p.record)[p.chosen] for p in kept.fitted])
    force = np.concatenate([p.after[p.chosen] for p in kept.fitted])
    knots = _knots(at)
    return rmse(
        [p.after[p.chosen] - _curve(at, force, knots, coordinate(p.record)[p.chosen]) for p in kept.unseen]
    )


def _knots(at: FloatArray) -> FloatArray:
    """Return the points of a curve over `at`: two of three where the samples are, one of three evenly between."""
    count = min(KNOTS, max(at.size // SAMPLES_PER_KNOT, 6))
    even = np.linspace(at.min(), at.max(), count // 3 + 1)
    knots = np.sort(np.concatenate([np.quantile(at, np.linspace(0.0, 1.0, count - count // 3)), even]))
    # Points that all but coincide would make a step.
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
