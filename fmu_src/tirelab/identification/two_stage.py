"""The article's second stage: the constants C, D, E from the A and B of the surfaces by least RMSE.

    minimise  sum over surfaces (A_i - A(R_i))^2,  and the same for B

C and D enter linearly, so they are eliminated and only the two rates of decay are searched: first on a grid, so that no
start has to be guessed, then all constants together.

Reference: Hull, Wang & Moore, Cycling Science, Spring 1996, section Methods.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .decay_search import Target, decays_tried, nearest
from .forms import EDGE, RISE_LOWEST, HullForm
from .surfaces import CM_PER_M

PRECISION, EVALUATIONS_MOST = 1e-14, 500
"""When a search has come to rest, and when it is left."""

Array = NDArray[np.float64]


def second_stage(form: HullForm, pairs: Array) -> Array:
    """Return the logarithms (k,) that `form` searches, fitted to A and B of its surfaces `pairs` (n, 2)."""
    start = np.concatenate([_start(form, pairs[:, i]) for i in (0, 1)])
    roots = np.tile(np.diag(1.0 / np.abs(pairs).max(axis=0)), (len(pairs), 1, 1))
    return nearest(Target(form, pairs, roots), start, PRECISION, EVALUATIONS_MOST)


def _start(form: HullForm, values: Array) -> Array:
    """Return the best point of the grid over both rates of decay."""
    radius = CM_PER_M * np.array(form.radii)
    convex, concave = (radius > 0.0) & np.isfinite(radius), radius < 0.0
    sides = [side for side, here in zip((convex, concave), form.sides, strict=True) if here]
    decays = [decays_tried(radius[side]) for side in sides]
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
