"""Where a motion turns: the direction and the cycle of each sample."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .noise import STANDS_OUT, STILL

FloatArray = NDArray[np.float64]


def branches(deflection: FloatArray, noise: float, span: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """Return direction (n,), +1 or -1, and number of the cycle (n,) of a deflection (n,) [m] with this noise [m].

    A reversal counts if the deflection then goes back by more than noise does (STANDS_OUT) and by STILL of its span, or
    of another `span` [m] that is longer; it counts from its turning point on. What first goes down has not gone up.
    A single reading away from a rest is no motion.
    """
    threshold = max(STANDS_OUT * noise, STILL * max(float(np.ptp(deflection)), span))
    values = _at_rest(deflection, threshold).tolist()
    turns, sign, best, extreme = [0], 1.0, 0, values[0]
    for i, x in enumerate(values):
        ahead = sign * (x - extreme)
        if ahead >= 0.0:
            best, extreme = i, x
        elif -ahead > threshold:
            turns.append(best + 1)
            sign, best, extreme = -sign, i, x
    first = int(len(turns) > 1 and values[turns[1] - 1] - values[0] <= threshold)
    lengths = np.diff([0, *turns[1 + first :], deflection.size])
    number = first + np.arange(lengths.size)
    direction = np.repeat(np.where(number % 2 == 0, 1.0, -1.0), lengths)
    cycle = np.repeat(np.floor(number / 2.0), lengths)
    return direction, cycle


def _at_rest(deflection: FloatArray, turn: float) -> FloatArray:
    """Return a deflection (n,) in which a reading that is half a `turn` [m] away from a rest is there as well: two of
    them, one up and one down, would be a turn. The two readings before it and the two after are that rest.
    """
    if deflection.size < 5:
        return deflection
    windows = np.lib.stride_tricks.sliding_window_view(deflection, 5)
    around = windows[:, [0, 1, 3, 4]]
    rest, found = around.mean(axis=1), deflection.copy()
    alone = (np.ptp(around, axis=1) <= turn) & (np.abs(windows[:, 2] - rest) > 0.5 * turn)
    found[2:-2][alone] = rest[alone]
    return np.asarray(found)
