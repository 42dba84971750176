"""The motion behind a gauge that steps: in the middle of its stay on a level, the deflection is that level."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def destepped(time: FloatArray, deflection: FloatArray, step: float) -> FloatArray:
    """Return the deflection [m] with straight lines between the middles of the stays on each level.

    A line is followed for half a step only: a tire at rest between two levels does not wander.
    """
    edges = np.flatnonzero(np.abs(np.diff(deflection)) > 0.25 * step) + 1
    begin, end = np.append(0, edges), np.append(edges, deflection.size)
    middle = 0.5 * (time[begin] + time[end - 1])
    line = np.interp(time, middle, deflection[begin])
    return np.asarray(np.clip(line, deflection - 0.5 * step, deflection + 0.5 * step))
