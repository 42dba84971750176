"""What the pictures need to know of a motion: its rate and whether it loads or unloads."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.spread import robust_sigma

FloatArray = NDArray[np.float64]

REACHES = (1, 2, 4, 8, 16, 32)
"""Samples before and behind over which a rate is taken; the first that is quiet enough is chosen."""

QUIET = 0.1
"""A rate is quiet enough where the noise of the reading is this part of its root mean square."""

STILL = 0.05
"""Slower than this part of the root mean square rate counts as a hold, which goes on with its branch."""


def rate_of(time: FloatArray, deflection: FloatArray) -> FloatArray:
    """Return the rate [m/s] by central differences over as few samples as the reading's noise allows.

    A white reading noise s makes a noise s / (sqrt(2) h dt) over h samples each side; s is taken from third
    differences, whose variance is 20 s^2 where the motion is smooth.
    """
    if time.size < 8:
        return np.gradient(deflection, time)
    noise = robust_sigma(np.diff(deflection, 3)) / np.sqrt(20.0)
    step = float(np.median(np.diff(time)))
    index = np.arange(time.size)
    rate = np.gradient(deflection, time)
    for reach in REACHES:
        if 8 * reach > time.size:
            break
        low, high = np.maximum(index - reach, 0), np.minimum(index + reach, time.size - 1)
        rate = (deflection[high] - deflection[low]) / (time[high] - time[low])
        if noise / (np.sqrt(2.0) * reach * step) <= QUIET * float(np.sqrt(np.mean(rate**2))):
            break
    return rate


def loading(rate: FloatArray) -> NDArray[np.bool_]:
    """Return which samples load; a hold belongs to the branch before it."""
    moving = np.abs(rate) > STILL * float(np.sqrt(np.mean(rate**2)))
    if not moving.any():
        return np.ones(rate.size, dtype=bool)
    last = np.maximum.accumulate(np.where(moving, np.arange(rate.size), 0))
    last[: int(np.argmax(moving))] = int(np.argmax(moving))
    return np.asarray(rate[last] > 0.0)
