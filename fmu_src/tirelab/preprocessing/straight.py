"""Whether a motion has an acceleration at all, or only what rounding and smoothing leave of a drive at one rate."""

from __future__ import annotations

import numpy as np

from .motion import BoolArray, FloatArray, Motion


def at_one_rate(time: FloatArray, motion: Motion) -> bool:
    """Return whether a motion over time (n,) [s] goes at one rate between its turns."""
    turned = np.diff(motion.direction, prepend=motion.direction[0]) != 0.0
    return is_straight(time, motion.deflection, ~motion.resolved | turned, motion.noise)


def is_straight(time: FloatArray, deflection: FloatArray, cut: BoolArray, noise: float) -> bool:
    """Return whether a smoothed motion (n,) [m] goes at one rate from each cut to the next.

    cut: samples at which the rate changes at once, of no stretch between two of them; noise [m]: of the deflection's
    reading. What bends a stretch by less than that is no acceleration that the readings can show.
    """
    stretch = np.cumsum(cut)[~cut]
    if stretch.size == 0:
        return True
    count = np.maximum(np.bincount(stretch), 1)

    def from_mean(values: FloatArray) -> FloatArray:
        centred: FloatArray = values - (np.bincount(stretch, values) / count)[stretch]
        return centred

    t, x = from_mean(time[~cut]), from_mean(deflection[~cut])
    rate = np.bincount(stretch, t * x) / np.maximum(np.bincount(stretch, t * t), 1e-300)
    return bool(np.mean((x - rate[stretch] * t) ** 2) <= noise**2)
