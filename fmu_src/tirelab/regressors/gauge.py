"""A gauge whose readings are a staircase, and the motion behind it: the level, in the middle of its stay there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

REPEATED = 0.3
"""Part of neighbouring readings that are equal above which a gauge is said to step."""

CANDIDATES = (0.02, 0.1, 0.25, 0.5)
"""Quantiles of the changes of the reading that may be its step: the first and last change are often parts of one."""

ON_GRID = 0.1
"""Largest distance of a change from a whole number of steps, in steps."""

RESTING, LEVELS = 0.3, 5
"""Part of the changes that rest before or after, or number of different jumps, that a stepping gauge shows at least."""


def staircase_step(deflection: FloatArray) -> float:
    """Return the step [m] of a gauge whose readings repeat, or 0."""
    changes = np.abs(np.diff(deflection))
    moved = changes[changes > 1e-12]
    if moved.size == 0 or moved.size > (1.0 - REPEATED) * changes.size:
        return 0.0
    # Ramps between holds change by one length too, sample after sample, where a staircase rests in between.
    changing = changes > 1e-12
    rests = float(np.mean(~(changing[:-1] & changing[1:])[changing[:-1] | changing[1:]]))
    # A tire that rests repeats its reading too, but only a converter's levels lie on a grid.
    for step in sorted(np.quantile(moved, CANDIDATES), reverse=True):
        multiples = np.round(moved / step)
        if float(np.quantile(np.abs(moved / step - multiples), 0.9)) < ON_GRID:
            return float(step) if rests >= RESTING or np.unique(multiples).size >= LEVELS else 0.0
    return 0.0


def destepped(time: FloatArray, deflection: FloatArray, step: float) -> FloatArray:
    """Return the deflection [m] with straight lines between the middles of the stays on each level.

    A line is followed for half a step only: a tire at rest between two levels does not wander.
    """
    edges = np.flatnonzero(np.abs(np.diff(deflection)) > 0.25 * step) + 1
    begin, end = np.append(0, edges), np.append(edges, deflection.size)
    middle = 0.5 * (time[begin] + time[end - 1])
    line = np.interp(time, middle, deflection[begin])
    return np.asarray(np.clip(line, deflection - 0.5 * step, deflection + 0.5 * step))
