"""Turns of the motion within a sample, and which of them can be compared with a simulation.

Rate and acceleration are not known in such a turn. A misfit that depends on the direction, the rate or the past of
the motion jumps there and says nothing that can be judged. Where it is the same before and after the turn, what shows
within it comes from the deflection, which is read as well there as elsewhere, or from the mass that turns.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

SAME = 3.0 * float(np.sqrt(2.0))
"""Noises by which the misfit before a turn and after it may differ: three standard deviations of a difference."""


def followed_turns(misfit: FloatArray, resolved: BoolArray, noise: float) -> BoolArray:
    """Return the samples (n,) within turns that leave the misfit as it was before; noise: of a sample."""
    found = np.zeros(misfit.size, dtype=bool)
    for begin, end in _runs(~resolved):
        if begin < 2 or end > misfit.size - 2:
            continue
        before, after = misfit[begin - 2 : begin], misfit[end : end + 2]
        # The two samples need not be read at the same deflection.
        slope = max(abs(float(before[1] - before[0])), abs(float(after[1] - after[0])))
        found[begin:end] = abs(float(after[0] - before[1])) < max(SAME * noise, slope)
    return found


def through_turns(
    time: FloatArray, rate: FloatArray, acceleration: FloatArray, turns: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return rate [m/s] and acceleration [m/s^2] where the rate changes evenly within each of the `turns`."""
    rate, acceleration = rate.copy(), acceleration.copy()
    for begin, end in _runs(turns):
        whole = slice(begin - 1, end + 1)
        ends = time[[begin - 1, end]], rate[[begin - 1, end]]
        rate[whole] = np.interp(time[whole], *ends)
        acceleration[begin:end] = (ends[1][1] - ends[1][0]) / (ends[0][1] - ends[0][0])
    return rate, acceleration


def _runs(inside: BoolArray) -> list[tuple[int, int]]:
    """Return begin and end of each run of samples `inside`."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
