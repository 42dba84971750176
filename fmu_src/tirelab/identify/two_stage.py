"""The article's second stage: the constants C, D, E from the A and B of the surfaces by least RMSE.

    minimise  sum over surfaces (A_i - A(R_i))^2,  and the same for B

C and D enter linearly, so they are eliminated and only the two rates of decay are searched: first on a grid, so that no
start has to be guessed, then all constants together.

Reference: Hull, Wang & Moore, Cycling Science, Spring 1996, section Methods.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .forms import EDGE, RISE_LOWEST, HullForm
from .surfaces import CM_PER_M

GRID = 40
"""Rates of decay tried on each side."""

DECAYS_TRIED = 0.05, 5.0
"""Their span, as multiples of 1/largest and 1/smallest radius of the side."""

Array = NDArray[np.float64]


def second_stage(form: HullForm, pairs: Array) -> Array:
    """Return the logarithms (k,) that `form` searches, fitted to A and B of its surfaces `pairs` (n, 2)."""
    return np.concatenate([_fit(form, pairs[:, i], i) for i in (0, 1)])


def _fit(form: HullForm, values: Array, which: int) -> Array:
    lower, upper = (bound[which * bound.size // 2 :][: bound.size // 2] for bound in form.bounds)
    start = np.clip(_start(form, values), lower + 1e-9, upper - 1e-9)
    scale = float(np.abs(values).max())
    found = least_squares(
        lambda logs: (form.one(logs)[0] - values) / scale,
        start,
        lambda logs: form.one(logs)[1] / scale,
        bounds=(lower, upper),
        x_scale="jac",
        ftol=1e-15,
        xtol=1e-13,
        gtol=1e-15,
        max_nfev=500,
    )
    logs: Array = found.x
    return logs


def _start(form: HullForm, values: Array) -> Array:
    """Return the best point of the grid over both rates of decay."""
    radius = CM_PER_M * np.array(form.radii)
    convex, concave = (radius > 0.0) & np.isfinite(radius), radius < 0.0
    sides = [side for side, here in zip((convex, concave), form.sides, strict=True) if here]
    decays = [
        np.geomspace(
            DECAYS_TRIED[0] / np.abs(radius[side]).max(), DECAYS_TRIED[1] / np.abs(radius[side]).min(), GRID
        )
        for side in sides
    ]
    grid = np.stack(np.meshgrid(*decays, indexing="ij"), axis=-1).reshape(-1, len(sides))
    columns = np.zeros((grid.shape[0], radius.size, 1 + len(sides)))
    columns[:, :, 0] = 1.0
    for i, (side, sign) in enumerate(
        zip(sides, np.where([s is convex for s in sides], -1.0, 1.0), strict=True)
    ):
        columns[:, side, i + 1] = sign * np.exp(-np.outer(grid[:, i], np.abs(radius[side])))
    linear = np.maximum(np.linalg.pinv(columns, rcond=1e-10) @ values, 1e-300)
    errors = ((columns @ linear[:, :, None])[:, :, 0] - values) ** 2
    best = int(np.argmin(errors.sum(axis=1)))
    C = linear[best, 0]
    logs = [np.log(C)]
    for i, side in enumerate(sides):
        D = np.log(linear[best, i + 1])
        logs += [
            np.clip(D - np.log(C), *EDGE) if side is convex else max(D, RISE_LOWEST),
            np.log(grid[best, i]),
        ]
    return np.array(logs)
