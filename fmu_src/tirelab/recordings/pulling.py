"""Whether a force pulls, beyond the noise of its readings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

PULL = 0.01
"""What is below zero by less than this part of the largest push is a load cell's zero."""

PARTS, FEWEST = 200, 10
"""Parts of a recording whose means are looked at, and fewest samples of one."""

SIGMAS = 8.0
"""A mean is below zero where it is so by this many of its standard deviations, by the differences of the readings."""


def pull_of(force: NDArray[np.float64]) -> float:
    """Return the least mean force [N] of a part of a recording (n,) that pulls; 0 where none does."""
    length = max(len(force) // PARTS, FEWEST)
    least = float(np.diff(np.cumsum(force)[::length]).min(initial=0.0)) / length
    noise = float(np.std(np.diff(force))) / float(np.sqrt(2.0 * length))
    return least if least < -PULL * float(force.max()) - SIGMAS * noise else 0.0
