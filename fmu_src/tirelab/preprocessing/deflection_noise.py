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

LEAST_NOISE, LEAST_PART = 1e-9, 1e-7
"""Smallest noise [m] that is returned, and as a part of the span where that is less (below 10 mm): no gauge reads a
tire's deflection to a nanometre, and none reads a ten-millionth of its span."""

FINEST_STEP, FINEST_PART = 5e-7, 1e-4
"""Smallest step [m] that is a gauge's, and as a part of the span where that is less (below 5 mm): finer ones are the
digits of a file, rounded below every other noise."""

LEAST_LEVELS = 100
"""Steps from the smallest to the largest reading; fewer are a staircase that the rig was driven through."""

GRID_TOLERANCE = 0.25
"""Largest distance of a reading from the grid of steps, as a part of a step: a file rounds what a gauge has read."""

LEAST_UNDONE = 10
"""Changes of speed undone at once (see `gauge_step`) that show a gauge's rounding: exact numbers have none."""

ROUNDED_ALONE = 0.05
"""Part of the second differences beyond one step up to which a reading has rounding and no other noise."""


def deflection_noise(deflection: FloatArray) -> float:
    """Return the standard deviation [m] of the noise of readings (n,) [m], n >= 6, even in time; at least `_least`.

    Readings rounded to steps q without other noise have q / sqrt(12), those with other noise at least that.
    """
    least = _least(deflection, LEAST_NOISE, LEAST_PART)
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
    gaps = np.diff(np.unique(deflection))
    finest = _least(deflection, FINEST_STEP, FINEST_PART)
    step = _common_step(gaps[gaps > _least(deflection, LEAST_NOISE, LEAST_PART)], finest)
    if step == 0.0 or np.ptp(deflection) < LEAST_LEVELS * step:
        return 0.0
    changes = np.diff(np.rint(np.diff(deflection) / step))
    small = (changes != 0.0) & (np.abs(changes) <= 2.0)
    undone = small[:-1] & small[1:] & (changes[:-1] * changes[1:] < 0.0)
    return step if np.count_nonzero(undone) >= LEAST_UNDONE else 0.0


def _least(deflection: FloatArray, size: float, part: float) -> float:
    """Return a size [m], or a part of the readings' span where that is less: a small specimen has a finer gauge."""
    span = float(np.ptp(deflection))
    return min(size, part * span) if span > 0.0 else size


def _common_step(gaps: FloatArray, finest: float) -> float:
    """Return the largest step of which all `gaps` are multiples, by Euclid's algorithm; 0 where it is below `finest`."""
    step = float(gaps.min(initial=np.inf))
    while finest <= step < np.inf:
        multiples = np.rint(gaps / step)
        remainder = np.abs(gaps - multiples * step)
        if remainder.max() <= GRID_TOLERANCE * step:
            return float(gaps.sum() / multiples.sum())
        step = float(remainder[remainder > GRID_TOLERANCE * step].min())
    return 0.0
