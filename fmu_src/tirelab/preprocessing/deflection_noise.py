"""The noise of the deflection reading: random noise from fifth differences, rounding from the gauge's step.

Random noise of variance s^2 gives fifth differences of variance 252 s^2; a smooth motion adds next to nothing. A gauge
that reads in steps of q errs by up to q / 2 either way, with the standard deviation

    q / sqrt(12)

(B. Widrow, I. Kollar, "Quantization Noise", Cambridge 2008, chapter 5). Its fifth differences do not show that where
the motion is slow, because most readings repeat the last one, or nearly even, because most steps are alike.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .robust_scale import robust_sigma

FloatArray = NDArray[np.float64]

LEAST_NOISE, FINEST_STEP = 1e-9, 5e-7
"""Smallest noise [m] that is returned, and smallest step [m] that is a gauge's: no gauge reads a tire's deflection to a
nanometre, and finer steps are the digits of a file, rounded below every other noise."""

SMALL = 1e-3
"""Span [m] below which both shrink with it: a smaller specimen has a finer gauge."""

LEAST_LEVELS = 100
"""Steps from the smallest to the largest reading; fewer are a staircase that the rig was driven through."""

GRID_TOLERANCE = 0.25
"""Largest distance of a reading from the grid of steps, as a part of a step: a file rounds what a gauge has read."""

LEAST_UNDONE = 10
"""Changes of speed undone at once (see `gauge_step`) that show a gauge's rounding: exact numbers have none."""

ROUNDED_ALONE = 0.05
"""Part of the second differences beyond one step up to which a reading has rounding and no other noise."""


def deflection_noise(deflection: FloatArray) -> float:
    """Return the standard deviation [m] of the noise of readings (n,) [m], n >= 6, even in time; at least 1e-9 m,
    or a millionth of their span where that is less.

    Readings rounded to steps q without other noise have q / sqrt(12), those with other noise at least that.
    """
    least = LEAST_NOISE * _shrunk(deflection)
    random = robust_sigma(np.diff(deflection, 5)) / np.sqrt(252.0)
    step = gauge_step(deflection)
    rounding = step / np.sqrt(12.0)
    # A smooth motion that is only rounded has second differences of -q, 0 and q.
    if step > 0.0 and np.mean(np.abs(np.diff(deflection, 2)) > 1.5 * step) < ROUNDED_ALONE:
        return float(max(rounding, least))
    return float(max(random, rounding, least))


def gauge_step(deflection: FloatArray) -> float:
    """Return the step [m] in which a gauge reads, from its readings (n,) [m]; 0 where there is none.

    There is a step q where the distinct readings lie on a grid and rounding shows: the motion per sample changes by q
    or 2 q and the next sample undoes it. A motion driven at constant speed, given in exact numbers, lies on a grid too,
    but its motion per sample changes only at corners and stays changed.
    """
    gaps, shrunk = np.diff(np.unique(deflection)), _shrunk(deflection)
    step = _common_step(gaps[gaps > LEAST_NOISE * shrunk], FINEST_STEP * shrunk)
    if step == 0.0 or np.ptp(deflection) < LEAST_LEVELS * step:
        return 0.0
    changes = np.diff(np.rint(np.diff(deflection) / step))
    small = (changes != 0.0) & (np.abs(changes) <= 2.0)
    undone = small[:-1] & small[1:] & (changes[:-1] * changes[1:] < 0.0)
    return step if np.count_nonzero(undone) >= LEAST_UNDONE else 0.0


def _shrunk(deflection: FloatArray) -> float:
    """Return the readings' span over SMALL, at most 1; 1 where nothing moves."""
    span = float(np.ptp(deflection))
    return min(span / SMALL, 1.0) if span > 0.0 else 1.0


def _common_step(gaps: FloatArray, finest: float) -> float:
    """Return the largest step of which all `gaps` are multiples, by Euclid's algorithm; 0 if below `finest`."""
    step = float(gaps.min(initial=np.inf))
    while finest <= step < np.inf:
        multiples = np.rint(gaps / step)
        remainder = np.abs(gaps - multiples * step)
        if remainder.max() <= GRID_TOLERANCE * step:
            return float(gaps.sum() / multiples.sum())
        step = float(remainder[remainder > GRID_TOLERANCE * step].min())
    return 0.0
