"""The motion of a recording: smoothed deflection, rate, acceleration, direction, cycle and distance since reversal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .deflection_noise import deflection_noise
from .smoothing import smoothed

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IndexArray = NDArray[np.intp]

CORNER = 9.0
"""Where five samples miss a cubic by this multiple of the noise variance (one in 400 of pure noise), and by a twentieth
of a sample's travel, the motion has a corner within a sample."""

CORNER_SAMPLES, SHORTEST = 6, 13
"""A corner shows in at most so many samples, and a piece between two corners has at least so many."""

STILL = 0.02
"""Speed over its root mean square below which the tire rests."""

MOST_PIECES = 1000
"""Budget: pieces that are smoothed each by itself."""


@dataclass(frozen=True)
class Motion:
    """The motion of one recording; every array has the shape of its samples.

    deflection [m], rate [m/s], acceleration [m/s^2]: smoothed as long as the noise and the motion allow
    noise: standard deviation [m] of the deflection's reading; smoothed_noise: that of the smoothed deflection [m]
    deepest: largest deflection so far [m]; cycle: number of the loading-unloading cycle; direction: +1 loading,
    -1 unloading, kept through holds; since_reversal: distance [m] from the deflection of the last reversal
    resolved: False where the motion has a corner within a sample, so that its rate there is not known
    """

    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    noise: float
    smoothed_noise: FloatArray
    deepest: FloatArray
    cycle: FloatArray
    direction: FloatArray
    since_reversal: FloatArray
    resolved: BoolArray


def motion_of(time: FloatArray, deflection: FloatArray) -> Motion:
    """Return the motion of a recording: time [s] rising, deflection [m]."""
    noise = deflection_noise(deflection)
    smooth, rate, acceleration, smoothed_noise, resolved = _smoothed(time, deflection, noise)
    # Smoothing cuts a corner short: there the reading itself is nearer.
    smooth, smoothed_noise = np.where(resolved, smooth, deflection), np.where(resolved, smoothed_noise, noise)
    direction, cycle, since_reversal = _branches(smooth, max(6.0 * noise, 0.02 * float(np.ptp(smooth))))
    deepest = np.maximum.accumulate(smooth)
    return Motion(
        smooth, rate, acceleration, noise, smoothed_noise, deepest, cycle, direction, since_reversal, resolved
    )


def _smoothed(
    time: FloatArray, deflection: FloatArray, noise: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, BoolArray]:
    """Return deflection, rate and acceleration, the noise left in the deflection, and where the motion is resolved."""
    step = float(np.median(np.diff(time)))
    if np.ptp(np.diff(time)) > 1e-3 * step:
        grid = np.linspace(time[0], time[-1], deflection.size)
        read = np.interp(grid, time, deflection)
        level, *rest, resolved = _smoothed(grid, read, noise)
        rate, acceleration, smoothed_noise = (np.interp(time, grid, r) for r in rest)
        return deflection - np.interp(time, grid, read - level), rate, acceleration, smoothed_noise, resolved
    resolved = _resolved(deflection, noise)
    parts = np.zeros((4, deflection.size))
    for begin, end in _pieces(resolved):
        parts[:, begin:end] = smoothed(deflection[begin:end], step, noise)
    smooth, rate, acceleration, leverage = parts
    return smooth, rate, acceleration, noise * np.sqrt(leverage), resolved


def _resolved(deflection: FloatArray, noise: float) -> BoolArray:
    """Return where five samples follow a cubic."""
    resolved = np.ones(deflection.size, dtype=bool)
    travel = float(np.sqrt(max(np.mean(np.diff(deflection) ** 2) - 2.0 * noise**2, 0.0)))
    basis = np.linalg.qr(np.vander(np.arange(-2.0, 3.0), 4, increasing=True))[0]
    outside = np.linalg.qr(np.eye(5) - basis @ basis.T)[0][:, 0]
    misfit = np.convolve(deflection - deflection.mean(), outside[::-1], mode="valid") ** 2
    resolved[2:-2] = misfit < max(CORNER * noise**2, (0.05 * travel) ** 2)
    return resolved


def _pieces(resolved: BoolArray) -> list[tuple[int, int]]:
    """Return the pieces of the motion between its corners: a spline across a corner rings on both sides of it.

    Shorter ones than SHORTEST, and what no corner of a sample explains, stay with their neighbours.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~resolved, [False]])))
    cuts = [0]
    for begin, end in edges.reshape(-1, 2).tolist():
        middle = (begin + end) // 2
        if end - begin <= CORNER_SAMPLES and middle - cuts[-1] >= SHORTEST:
            cuts.append(middle)
    if resolved.size - cuts[-1] < SHORTEST and len(cuts) > 1:
        cuts.pop()
    if len(cuts) > MOST_PIECES:
        cuts = [0]
    return list(zip(cuts, [*cuts[1:], resolved.size], strict=True))


def _branches(deflection: FloatArray, threshold: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return direction, cycle number and distance since the last reversal; one counts beyond `threshold` [m].

    It is recognised late, but counts from the turning point on.
    """
    turns, sign, best = [0], 1.0, 0
    extreme = deflection[0]
    values = deflection.tolist()
    for i, x in enumerate(values):
        ahead = sign * (x - extreme)
        if ahead >= 0.0:
            best, extreme = i, x
        elif -ahead > threshold:
            turns.append(best + 1)
            sign, best, extreme = -sign, i, x
    lengths = np.diff([*turns, deflection.size])
    number = np.arange(lengths.size)
    direction = np.repeat(np.where(number % 2 == 0, 1.0, -1.0), lengths)
    cycle = np.repeat(np.floor(number / 2.0), lengths)
    start = np.repeat(deflection[np.maximum(np.array(turns) - 1, 0)], lengths)
    return direction, cycle, np.abs(deflection - start)
