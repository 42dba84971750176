"""The constants of equations 3 and 4 that fit given A and B best, wherever the search starts.

    minimise  sum over surfaces |G_i (A - A_i, B - B_i)|^2,   A, B given by the form

Where the difference D exp(-E R) of a side from flat ground has vanished, the cost has no slope in D and E, and a search
that came there stays. So after a search has converged, each difference is removed in turn and inserted again with other
rates of decay; where the linearized problem then predicts a lower cost, the search is restarted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .forms import EDGE, RISE_LOWEST, HullForm
from .surfaces import CM_PER_M

Array = NDArray[np.float64]

GRID = 40
"""Rates of decay tried on each side."""

DECAYS_TRIED = 0.05, 5.0
"""Their span, as multiples of 1/largest and 1/smallest radius of the side."""

GAIN = 1e-3
"""Fraction of the cost by which another start must be better: far less than the noise can resolve."""

ROUNDING = 1e-20
"""Fraction of the cost without any form, below which only rounding remains."""

SLOPES_ALIKE = 1e-8
"""Singular value, relative to the largest, below which a combination of slopes counts as undetermined."""

SEARCHES_MOST = 8
"""Restarts at most."""


def decays_tried(radii: Array) -> Array:
    """Return the rates [1/cm] (GRID,) at which the difference from flat ground may fade over `radii` [cm]."""
    return np.geomspace(DECAYS_TRIED[0] / np.abs(radii).max(), DECAYS_TRIED[1] / np.abs(radii).min(), GRID)


@dataclass(frozen=True)
class Target:
    """The data of the search: A and B of the surfaces, `pairs` (n, 2), with the weights `roots`, G (n, 2, 2)."""

    form: HullForm
    pairs: Array
    roots: Array

    def errors(self, logs: Array) -> Array:
        """Return the errors (2 n,) whose squares are summed."""
        found: Array = (self.roots @ (self.form.coefficients(logs) - self.pairs)[:, :, None]).ravel()
        return found

    def derivatives(self, logs: Array) -> Array:
        """Return their derivatives (2 n, k) by the logarithms."""
        found: Array = (self.roots @ self.form.derivatives(logs)).reshape(-1, logs.size)
        return found

    @property
    def rounding(self) -> float:
        """Sum of squares that rounding leaves."""
        return ROUNDING * float(np.sum((self.roots @ self.pairs[:, :, None]) ** 2))


def nearest(target: Target, start: Array, precision: float, evaluations_most: int) -> Array:
    """Return the logarithms (k,) that `target` seeks, from the logarithms `start`.

    precision: relative change of the cost, and relative step, at which a search has converged
    evaluations_most: number of evaluations after which a search is stopped
    """

    def search(start: Array) -> tuple[float, Array]:
        lower, upper = target.form.bounds
        fit = least_squares(
            target.errors,
            np.clip(start, lower + 1e-9, upper - 1e-9),
            target.derivatives,
            bounds=(lower, upper),
            x_scale="jac",
            ftol=precision,
            xtol=precision,
            gtol=1e-15,
            max_nfev=evaluations_most,
        )
        return 2.0 * float(fit.cost), fit.x

    least, logs = search(start)
    places = elsewhere(target, logs, least)
    for _ in range(SEARCHES_MOST):
        place = next(places, None)
        if place is None:
            break
        there, found = search(place)
        if there < (1.0 - GAIN) * least:
            least, logs = there, found
            places = elsewhere(target, logs, least)
    return logs


def elsewhere(target: Target, logs: Array, least: float) -> Iterator[Array]:
    """Yield the places from which less than `least`, that of `logs`, may be found, the most promising first."""
    radius = CM_PER_M * np.array(target.form.radii)
    found: list[tuple[float, Array]] = []
    for at, which, convex in _differences(target.form):
        side = (radius > 0.0) & np.isfinite(radius) if convex else radius < 0.0
        decays = decays_tried(radius[side])
        shapes = np.zeros((decays.size, radius.size, 2))
        shapes[:, side, which] = (-1.0 if convex else 1.0) * np.exp(-np.outer(decays, np.abs(radius[side])))
        sums, heights = _put_back(target, logs, at, shapes)
        unit = np.exp(logs[which * logs.size // 2]) if convex else 1.0
        lowest, highest = np.exp(EDGE) if convex else (np.exp(RISE_LOWEST), np.inf)
        sums[~((heights > lowest * unit) & (heights < highest * unit))] = np.inf
        best = int(np.argmin(sums))
        if sums[best] < (1.0 - GAIN) * least - target.rounding:
            place = logs.copy()
            place[at : at + 2] = np.log(heights[best] / unit), np.log(decays[best])
            found.append((float(sums[best]), place))
    yield from (place for _, place in sorted(found, key=lambda one: one[0]))


def _differences(form: HullForm) -> Iterator[tuple[int, int, bool]]:
    """Yield where D and E of each difference are searched, 0 for A or 1 for B, and whether its side is convex."""
    at = 0
    for which in (0, 1):
        at += 1
        for convex in [convex for convex, here in zip((True, False), form.sides, strict=True) if here]:
            yield at, which, convex
            at += 2


def _put_back(target: Target, logs: Array, at: int, shapes: Array) -> tuple[Array, Array]:
    """Return what is left (m,) and the heights (m,) where the difference searched at `at` has other `shapes` (m, n, 2).

    All other logarithms follow by their slopes.
    """
    without = logs.copy()
    without[at] = -np.inf
    slopes = np.delete(target.derivatives(without), [at, at + 1], axis=1)
    lengths = np.linalg.norm(slopes, axis=0)
    basis, values, _ = np.linalg.svd(slopes / np.where(lengths > 0.0, lengths, 1.0), full_matrices=False)
    basis = basis[:, values > SLOPES_ALIKE * values[0]]
    errors = target.errors(without)
    errors -= basis @ (basis.T @ errors)
    columns = (target.roots @ shapes[..., None]).reshape(len(shapes), -1)
    columns -= (columns @ basis) @ basis.T
    squares = np.einsum("mi,mi->m", columns, columns)
    heights = -(columns @ errors) / np.where(squares > 0.0, squares, np.inf)
    return errors @ errors - heights**2 * squares, heights
