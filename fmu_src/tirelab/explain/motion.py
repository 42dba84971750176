"""What the motion of a recording tells: smoothed deflection, rate, acceleration, direction, cycles and history."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d, uniform_filter1d
from scipy.signal import savgol_filter

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IndexArray = NDArray[np.intp]

WINDOWS = (5, 7, 9, 13, 19, 27, 39)
"""Lengths [samples] of the local cubic fits among which each sample chooses."""

MISFIT_ALLOWED = 1.6
"""A local fit is kept while its mean square residual stays below this multiple of the noise variance: with the 9
samples of a usual window, one window in twenty of pure noise exceeds it."""

CORNER = 9.0
"""Where five samples miss a cubic by this multiple of the noise variance (one in 400 of pure noise), and by a twentieth
of a sample's travel, the motion turns within a sample."""


@dataclass(frozen=True)
class Motion:
    """The motion of one recording; every array has the shape of its samples.

    deflection [m], rate [m/s], acceleration [m/s^2]: from local cubic fits as long as the noise allows
    noise: standard deviation [m] of the deflection's reading
    deepest: largest deflection so far [m]; cycle: number of the loading-unloading cycle; direction: +1 loading,
    -1 unloading, kept through holds; turned: deflection [m] travelled since the last reversal
    resolved: False where the motion turns within a sample, so that its rate there is anybody's guess
    """

    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    noise: float
    deepest: FloatArray
    cycle: FloatArray
    direction: FloatArray
    turned: FloatArray
    resolved: BoolArray


def motion_of(time: FloatArray, deflection: FloatArray) -> Motion:
    """Return the motion of a recording: time [s] rising, deflection [m]."""
    noise = deflection_noise(deflection)
    smooth, rate, acceleration, resolved = _local_cubics(time, deflection, noise)
    direction, cycle, turned = _branches(smooth, max(6.0 * noise, 0.02 * float(np.ptp(smooth))))
    return Motion(
        smooth, rate, acceleration, noise, np.maximum.accumulate(smooth), cycle, direction, turned, resolved
    )


def deflection_noise(deflection: FloatArray) -> float:
    """Return the standard deviation [m] of the reading's noise: from fifth differences, robust to corners.

    The fifth difference of white noise has the variance 252 s^2; that of a smooth motion is next to nothing.
    """
    differences = np.diff(deflection, 5)
    scaled = 1.4826 * float(np.median(np.abs(differences))) / np.sqrt(252.0)
    # A quantised reading at rest has differences of nothing: then the quarter of largest ones speaks.
    return float(max(scaled, 1e-9))


def _local_cubics(
    time: FloatArray, deflection: FloatArray, noise: float
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Fit cubics over windows before, around and after each sample; keep the longest that fits within the noise."""
    step = float(np.median(np.diff(time)))
    count = deflection.size
    if np.ptp(np.diff(time)) > 1e-3 * step:
        grid = np.linspace(time[0], time[-1], count)
        even = _local_cubics(grid, np.interp(grid, time, deflection), noise)
        return deflection, np.interp(time, grid, even[1]), np.interp(time, grid, even[2]), even[3]
    smooth = deflection.copy()
    rate = np.gradient(deflection, time)
    acceleration = np.gradient(rate, time)
    resolved = np.ones(count, dtype=bool)
    for window in WINDOWS:
        if window > count // 4:
            break
        half = window // 2
        cubic, misfit = _cubic_at_centres(deflection, window, step)
        good = misfit < MISFIT_ALLOWED * noise**2
        if window == WINDOWS[0]:
            travel = step * float(np.sqrt(np.mean(rate**2)))
            resolved = misfit < np.maximum(CORNER * noise**2, (0.05 * travel) ** 2)
            good |= misfit < (0.01 * travel) ** 2
        resolved[half : count - half] |= good[half : count - half]
        votes = np.zeros(count)
        votes_centred = np.zeros(count)
        sums = np.zeros((3, count))
        # A window around the sample is best; before or behind a corner one beside it has to do, on a corner both.
        for offset in (0, -half, half):
            centre = np.arange(count) - offset
            inside = (centre >= half) & (centre < count - half)
            chosen = np.flatnonzero(inside & (votes_centred == 0.0))
            chosen = chosen[good[centre[chosen]]]
            c0, c1, c2, c3 = cubic[:, centre[chosen]]
            s = offset * step
            sums[0, chosen] += c0 + s * (c1 + s * (c2 / 2.0 + s * c3 / 6.0))
            sums[1, chosen] += c1 + s * (c2 + s * c3 / 2.0)
            sums[2, chosen] += c2 + s * c3
            votes[chosen] += 1.0
            if offset == 0:
                votes_centred = votes.copy()
        fitted = votes > 0.0
        smooth[fitted], rate[fitted], acceleration[fitted] = sums[:, fitted] / votes[fitted]
    return smooth, rate, acceleration, resolved


def _cubic_at_centres(values: FloatArray, window: int, step: float) -> tuple[FloatArray, FloatArray]:
    """Return value and three derivatives, shape (4, n), of the cubic fitted around each sample, and its mean square
    residual corrected for the four coefficients."""
    steps = np.arange(window) - window // 2
    basis = np.linalg.qr(np.vander(steps / (window // 2), 4, increasing=True).astype(float))[0]
    level = float(np.mean(values))
    centred = values - level
    cubic = np.stack(
        [savgol_filter(centred, window, 3, deriv=d, delta=step, mode="nearest") for d in range(4)]
    )
    square = uniform_filter1d(centred**2, window, mode="nearest") * window
    for column in basis.T:
        square -= correlate1d(centred, column, mode="nearest") ** 2
    cubic[0] += level
    return cubic, np.maximum(square, 0.0) / (window - 4)


def _branches(deflection: FloatArray, threshold: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return direction, cycle number and travel since the last reversal; a reversal counts beyond `threshold` [m].

    It is known late, but counts from the turning point on.
    """
    turns, way, best = [0], 1.0, 0
    highest = deflection[0]
    values = deflection.tolist()
    for i, x in enumerate(values):
        ahead = way * (x - highest)
        if ahead >= 0.0:
            best, highest = i, x
        elif -ahead > threshold:
            turns.append(best + 1)
            way, best, highest = -way, i, x
    spans = np.diff([*turns, deflection.size])
    number = np.arange(spans.size)
    direction = np.repeat(np.where(number % 2 == 0, 1.0, -1.0), spans)
    cycle = np.repeat(np.floor(number / 2.0), spans)
    start = np.repeat(deflection[np.maximum(np.array(turns) - 1, 0)], spans)
    return direction, cycle, np.abs(deflection - start)
