"""What stands out of a residual that every smooth function and effect has been fitted to: lines and spans of time.

They are looked for before the noise is measured, since an autoregression would take a line for a colour and a jump of
the amplifier for slow noise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from .kinematics import FloatArray

LINES = 3
"""Lines of a spectrum that are tried."""

LOUD = 0.6
"""Lines weaker than this part of the noise are left to the noise: a hum of the mains is no physics of a tire."""

SWELLINGS = 5
"""Times that a line may swell and fade in a recording."""

SLOWEST = 8.0
"""Turns in a recording that a line makes at least: what is slower is a course of time (`beyond`: 16 half turns)."""

SPANS = 6
"""Spans of time that are tried."""

SHORTEST, LONGEST = 4, 0.3
"""Spans last from so many samples to this part of the recording."""

CHANCE = 0.01
"""Chance that noise alone shows a span."""

ENOUGH = 20
"""So many spans beside each other tell what noise explains in one."""

MEDIANS = (0.455, 1.386)
"""Medians of chi square with one and two degrees of freedom."""

SPIKE = 4.5
"""Readings this many deviations off their neighbours are spikes, which the noise has."""

NEIGHBOURHOOD = 401
"""Length [bins] of the stretch of a spectrum, four bins to a line's width, above which a line stands out."""


@dataclass(frozen=True)
class Outstanding:
    """What stands out of one recording: frequencies [Hz] of lines, and spans as pairs of sample numbers [from, to)."""

    lines: tuple[float, ...] = ()
    spans: tuple[tuple[int, int], ...] = ()


def outstanding(time: FloatArray, residual: FloatArray, force: FloatArray) -> Outstanding:
    """Return what stands out of a residual [N]; force [N]: of the law, with which what happens in a span may change."""
    left = rest = _without_spikes(residual)
    loud = []
    for line in _lines(time, left):
        columns = waves(time, line)
        wave = columns @ np.linalg.lstsq(columns, rest, rcond=None)[0]
        rest = rest - wave
        if np.std(wave) > LOUD * np.std(rest):
            loud.append(line)
            left = left - wave
    return Outstanding(tuple(loud), _spans(left, force))


def waves(time: FloatArray, frequency: float) -> FloatArray:
    """Return sine and cosine at a frequency [Hz], steady and swelling: shape (n, 2 + 4 SWELLINGS)."""
    angle = 2.0 * np.pi * frequency * time
    part = 2.0 * np.pi * (time - time[0]) / (time[-1] - time[0])
    slow = [np.ones_like(time), *(f(k * part) for k in range(1, SWELLINGS + 1) for f in (np.sin, np.cos))]
    return np.stack([s * f(angle) for s in slow for f in (np.sin, np.cos)], axis=1)


def _without_spikes(values: FloatArray) -> FloatArray:
    middle = median_filter(values, 5, mode="nearest")
    away = values - middle
    sigma = 1.4826 * float(np.median(np.abs(away))) + 1e-300
    return np.where(np.abs(away) > SPIKE * sigma, middle, values)


def _lines(time: FloatArray, values: FloatArray) -> tuple[float, ...]:
    """Return the frequencies at which the spectrum stands most above its neighbourhood, strongest first.

    Of noise the power has an exponential law: it exceeds its median by this much once in 1 / CHANCE recordings.
    """
    count = values.size
    if count < 64:
        return ()
    even = np.linspace(time[0], time[-1], count)
    level = np.interp(even, time, values)
    size = 4 * count
    power = np.abs(np.fft.rfft((level - level.mean()) * np.hanning(count), size)) ** 2
    frequencies = np.fft.rfftfreq(size, float(even[1] - even[0]))
    around = median_filter(power, min(NEIGHBOURHOOD, power.size // 4 * 2 + 1), mode="nearest")
    height = power / np.maximum(around, 1e-6 * float(power.mean()) + 1e-300)
    height[frequencies < SLOWEST / (time[-1] - time[0])] = 0.0
    limit = np.log(0.5 * count / CHANCE) / np.log(2.0)
    found = []
    for _ in range(LINES):
        at = int(np.argmax(height))
        if height[at] < limit:
            break
        found.append(float(frequencies[at]))
        height[max(at - 24, 0) : at + 25] = 0.0
    return tuple(found)


def _spans(values: FloatArray, force: FloatArray) -> tuple[tuple[int, int], ...]:
    """Return the spans in which an offset and a part of the force explain more than noise would, strongest first.

    How much they explain in a span of a given length is compared with its median over all such spans, so that slow
    noise is its own measure; explained energies are then as chi square with two degrees of freedom.
    """
    left = values.copy()
    scaled = force / (float(np.max(np.abs(force))) + 1e-300)
    found: list[tuple[int, int]] = []
    for _ in range(SPANS):
        span = _strongest(left, scaled)
        if span is None:
            break
        found.append(span)
        inside = slice(*span)
        basis = np.stack([np.ones(span[1] - span[0]), scaled[inside]], axis=1)
        left[inside] -= basis @ np.linalg.lstsq(basis, left[inside], rcond=None)[0]
    return tuple(found)


def _strongest(values: FloatArray, force: FloatArray) -> tuple[int, int] | None:
    count = values.size
    sums = np.concatenate(
        [
            np.zeros((5, 1)),
            np.cumsum([np.ones(count), force, force**2, values, values * force], axis=1),
        ],
        axis=1,
    )
    lengths = np.unique(np.geomspace(SHORTEST, LONGEST * count, 24).astype(int))
    starts = [np.arange(0, count - size + 1, max(int(size) // 8, 1)) for size in lengths]
    found = [_explained(sums, at, at + size) for at, size in zip(starts, lengths, strict=True)]
    energies = [energy for energy, _ in found]
    typical = _typical(lengths, np.array([np.median(e / median) for e, median in found]), count)
    heights = [float(e.max()) / t for e, t in zip(energies, typical, strict=True)]
    best = int(np.argmax(heights))
    if heights[best] < 2.0 * np.log(sum(s.size for s in starts) / CHANCE):
        return None
    size = int(lengths[best])
    first = int(starts[best][np.argmax(energies[best])])
    # The edges stand where the span explains most.
    reach = max(size // 2, 1)
    lows = np.arange(max(first - reach, 0), first + reach + 1)
    highs = np.arange(max(first + size - reach, 0), min(first + size + reach, count) + 1)
    for _ in range(3):
        high = first + size
        lows_here = lows[lows <= high - SHORTEST]
        worth = _explained(sums, lows_here, np.full_like(lows_here, high))[0]
        first = int(lows_here[np.argmax(worth)])
        highs_here = highs[highs >= first + SHORTEST]
        worth = _explained(sums, np.full_like(highs_here, first), highs_here)[0]
        size = int(highs_here[np.argmax(worth)]) - first
    return first, first + size


def _typical(lengths: np.ndarray, measured: FloatArray, count: int) -> FloatArray:
    """Return what noise explains in a span of each length, in units of chi square's.

    Measured where there are enough spans beside each other, and carried on as it grows from there: slow noise explains
    the more the longer a span lasts.
    """
    measured = np.maximum.accumulate(np.maximum(measured, 1e-300))
    last = max(int(np.searchsorted(lengths, count / ENOUGH)) - 1, 0)
    before = max(last - 6, 0)
    growth = 0.0
    if last > before:
        rise = np.log(measured[last] / measured[before]) / np.log(lengths[last] / lengths[before])
        growth = float(np.clip(rise, 0.0, 1.0))
    beyond = measured[last] * (lengths / lengths[last]) ** growth
    return np.where(np.arange(lengths.size) <= last, measured, beyond)


def _explained(sums: FloatArray, starts: np.ndarray, ends: np.ndarray) -> tuple[FloatArray, FloatArray]:
    """Return the energy that an offset and a part of the force explain in each span [from, to), and its median.

    The median is that of noise of variance 1: where the force hardly changes its part is no second degree of freedom.
    """
    n, f, ff, y, fy = sums[:, ends] - sums[:, starts]
    spread = ff - f**2 / n
    ridge = 1e-3 * n
    along = fy - f * y / n
    second = spread / (spread + ridge)
    median = MEDIANS[0] + second * (MEDIANS[1] - MEDIANS[0])
    return np.asarray(y**2 / n + along**2 / (spread + ridge)), np.asarray(median)
