"""Spectral lines and segments of time in a residual to which every smooth function and effect has been fitted.

They are detected before the noise is estimated: an autoregression would model a line as coloured noise, and a jump of
the amplifier as slow noise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from .kinematics import FloatArray
from .robust_scale import SPIKE_LIMIT, robust_sigma

MOST_LINES = 3
"""Most spectral lines that are detected."""

LEAST_LINE_TO_NOISE = 0.6
"""Weakest line over the noise; weaker ones count as noise: a hum of the mains is no physics of a tire."""

MODULATION_ORDERS = 5
"""Highest harmonic of the recording with which the amplitude of a line may vary."""

LEAST_CYCLES = 8.0
"""Fewest periods of a line in a recording: what is slower is a smooth function of time (16 half periods)."""

MOST_SEGMENTS = 6
"""Most segments of time that are detected."""

SHORTEST_SEGMENT, LONGEST_SEGMENT = 4, 0.3
"""Shortest segment [samples], and the longest as a part of the recording."""

FALSE_ALARM = 0.01
"""Chance that noise alone shows a segment, or a line."""

ENOUGH_SEGMENTS = 20
"""Fewest segments side by side from which the energy that noise explains in one is estimated."""

CHI_SQUARE_MEDIANS = (0.455, 1.386)
"""Medians of chi square with one and with two degrees of freedom."""

NEIGHBOURHOOD = 401
"""Length [bins] of the stretch of a spectrum, four bins to a line's width, above which a line must rise."""


@dataclass(frozen=True)
class LinesAndSegments:
    """What was detected in one recording: frequencies [Hz] of lines, and segments as sample numbers [from, to)."""

    lines: tuple[float, ...] = ()
    segments: tuple[tuple[int, int], ...] = ()


def detect_lines_and_segments(time: FloatArray, residual: FloatArray, force: FloatArray) -> LinesAndSegments:
    """Return the lines and segments in a residual [N].

    force [N]: of the law; what happens in a segment may be an offset and a part proportional to this force
    """
    left = rest = _without_spikes(residual)
    strong = []
    for line in _lines(time, left):
        columns = modulated_waves(time, line)
        wave = columns @ np.linalg.lstsq(columns, rest, rcond=None)[0]
        rest = rest - wave
        if np.std(wave) > LEAST_LINE_TO_NOISE * np.std(rest):
            strong.append(line)
            left = left - wave
    return LinesAndSegments(tuple(strong), _segments(left, force))


def modulated_waves(time: FloatArray, frequency: float) -> FloatArray:
    """Return sine and cosine at a frequency [Hz], steady and modulated: shape (n, 2 + 4 MODULATION_ORDERS)."""
    angle = 2.0 * np.pi * frequency * time
    part = 2.0 * np.pi * (time - time[0]) / (time[-1] - time[0])
    slow = [
        np.ones_like(time),
        *(f(k * part) for k in range(1, MODULATION_ORDERS + 1) for f in (np.sin, np.cos)),
    ]
    return np.stack([s * f(angle) for s in slow for f in (np.sin, np.cos)], axis=1)


def _without_spikes(values: FloatArray) -> FloatArray:
    middle = median_filter(values, 5, mode="nearest")
    away = values - middle
    sigma = robust_sigma(away) + 1e-300
    return np.where(np.abs(away) > SPIKE_LIMIT * sigma, middle, values)


def _lines(time: FloatArray, values: FloatArray) -> tuple[float, ...]:
    """Return the frequencies at which the spectrum rises most above its neighbourhood, strongest first.

    The power of noise has an exponential law: it exceeds its median by this limit once in 1 / FALSE_ALARM recordings.
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
    height[frequencies < LEAST_CYCLES / (time[-1] - time[0])] = 0.0
    limit = np.log(0.5 * count / FALSE_ALARM) / np.log(2.0)
    found = []
    for _ in range(MOST_LINES):
        at = int(np.argmax(height))
        if height[at] < limit:
            break
        found.append(float(frequencies[at]))
        height[max(at - 24, 0) : at + 25] = 0.0
    return tuple(found)


def _segments(values: FloatArray, force: FloatArray) -> tuple[tuple[int, int], ...]:
    """Return the segments in which an offset and a part of the force explain more than noise would, strongest first.

    The energy explained in a segment is compared with the median over all segments of its length, so that slow noise
    sets its own scale; the ratio then follows chi square with two degrees of freedom.
    """
    left = values.copy()
    scaled = force / (float(np.max(np.abs(force))) + 1e-300)
    found: list[tuple[int, int]] = []
    for _ in range(MOST_SEGMENTS):
        segment = _strongest(left, scaled)
        if segment is None:
            break
        found.append(segment)
        inside = slice(*segment)
        basis = np.stack([np.ones(segment[1] - segment[0]), scaled[inside]], axis=1)
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
    lengths = np.unique(np.geomspace(SHORTEST_SEGMENT, LONGEST_SEGMENT * count, 24).astype(int))
    starts = [np.arange(0, count - size + 1, max(int(size) // 8, 1)) for size in lengths]
    found = [_explained(sums, at, at + size) for at, size in zip(starts, lengths, strict=True)]
    energies = [energy for energy, _ in found]
    typical = _typical(lengths, np.array([np.median(e / median) for e, median in found]), count)
    heights = [float(e.max()) / t for e, t in zip(energies, typical, strict=True)]
    best = int(np.argmax(heights))
    if heights[best] < 2.0 * np.log(sum(s.size for s in starts) / FALSE_ALARM):
        return None
    size = int(lengths[best])
    first = int(starts[best][np.argmax(energies[best])])
    # The edges are moved to where the segment explains most.
    reach = max(size // 2, 1)
    lows = np.arange(max(first - reach, 0), first + reach + 1)
    highs = np.arange(max(first + size - reach, 0), min(first + size + reach, count) + 1)
    for _ in range(3):
        high = first + size
        lows_here = lows[lows <= high - SHORTEST_SEGMENT]
        explained = _explained(sums, lows_here, np.full_like(lows_here, high))[0]
        first = int(lows_here[np.argmax(explained)])
        highs_here = highs[highs >= first + SHORTEST_SEGMENT]
        explained = _explained(sums, np.full_like(highs_here, first), highs_here)[0]
        size = int(highs_here[np.argmax(explained)]) - first
    return first, first + size


def _typical(lengths: np.ndarray, measured: FloatArray, count: int) -> FloatArray:
    """Return what noise explains in a segment of each length, in units of chi square's.

    Measured where there are enough segments side by side, and extrapolated with the growth measured there: slow noise
    explains more the longer a segment lasts.
    """
    measured = np.maximum.accumulate(np.maximum(measured, 1e-300))
    last = max(int(np.searchsorted(lengths, count / ENOUGH_SEGMENTS)) - 1, 0)
    before = max(last - 6, 0)
    growth = 0.0
    if last > before:
        rise = np.log(measured[last] / measured[before]) / np.log(lengths[last] / lengths[before])
        growth = float(np.clip(rise, 0.0, 1.0))
    beyond = measured[last] * (lengths / lengths[last]) ** growth
    return np.where(np.arange(lengths.size) <= last, measured, beyond)


def _explained(sums: FloatArray, starts: np.ndarray, ends: np.ndarray) -> tuple[FloatArray, FloatArray]:
    """Return the energy that an offset and a part of the force explain in each segment [from, to), and its median.

    The median is that of noise of variance 1: where the force hardly changes its part is no second degree of freedom.
    """
    n, f, ff, y, fy = sums[:, ends] - sums[:, starts]
    spread = ff - f**2 / n
    ridge = 1e-3 * n
    along = fy - f * y / n
    second = spread / (spread + ridge)
    median = CHI_SQUARE_MEDIANS[0] + second * (CHI_SQUARE_MEDIANS[1] - CHI_SQUARE_MEDIANS[0])
    return np.asarray(y**2 / n + along**2 / (spread + ridge)), np.asarray(median)
