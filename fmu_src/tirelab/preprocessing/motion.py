"""The motion of a recording: smoothed deflection, rate, acceleration, direction and reversals.

The deflection is smoothed as strongly as the motion allows at each moment. A smoothing spline of order 3 (which
penalises the third derivative) has at the angular frequency w [1/sample] the gain

    H(w) = 1 / (1 + (w / w_c)^6)

Splines with several cut-offs w_c are fitted. How well each predicts a held-out sample follows without another fit: at
the leverage h, the residual r has the variance s^2 (1 - h), where s is the noise of the reading:

    log p = 1/2 log(1 - h) - r^2 / (2 s^2 (1 - h))

Summed over a window around each sample, log p is the weight of a spline, together with how often it is used in the
whole recording (leave-one-out: Wahba, "Spline Models for Observational Data", SIAM 1990; the weighted mean is
Bayesian). Long splines win where the motion is smooth, short ones at corners. Rate and acceleration are thus posterior
means and not noisy data, so that coefficients fitted to them are not biased towards zero.

In a reversal within one sample neither rate nor acceleration is known. A misfit that depends on direction, rate or
history jumps there, and cannot be judged. Where the misfit is the same before and after the reversal, what shows within
it comes from the deflection, which is read there as well as elsewhere, or from the reversed mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq
from scipy.ndimage import gaussian_filter1d

from .gauge import deflection_noise
from .noise import NEGLIGIBLE
from .spread import TRIMMED

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IndexArray = NDArray[np.intp]


CORNER = TRIMMED**2
"""The motion has a corner within a sample where five samples miss a cubic by this multiple of the noise variance (one
in 400 of pure noise does), and by more than NEGLIGIBLE of the travel per sample."""

CORNER_SAMPLES = 6
"""Most samples in which one corner shows."""

SHORTEST = 2 * CORNER_SAMPLES + 1
"""Fewest samples of a piece between two corners: those in which the two show, and one more."""

MOST_PIECES = 1000
"""Budget: most pieces that are smoothed separately."""


@dataclass(frozen=True)
class Motion:
    """The motion of one recording; every array has the shape of its samples.

    deflection [m], rate [m/s], acceleration [m/s^2]: smoothed
    noise: standard deviation [m] of the deflection's reading
    deepest: largest deflection so far [m]; cycle: number of the loading-unloading cycle; direction: +1 loading,
    -1 unloading, kept through holds
    resolved: False where the motion has a corner within a sample, so that its rate there is not known
    """

    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    noise: float
    deepest: FloatArray
    cycle: FloatArray
    direction: FloatArray
    resolved: BoolArray


def motion_of(time: FloatArray, deflection: FloatArray) -> Motion:
    """Return the motion of a recording: time [s] rising, deflection [m]."""
    noise = deflection_noise(deflection)
    smooth, rate, acceleration, resolved = _smoothed(time, deflection, noise)
    # Smoothing cuts a corner short: there the reading itself is nearer.
    smooth = np.where(resolved, smooth, deflection)
    direction, cycle = branches(smooth, noise)
    deepest = np.maximum.accumulate(smooth)
    return Motion(smooth, rate, acceleration, noise, deepest, cycle, direction, resolved)


def _smoothed(
    time: FloatArray, deflection: FloatArray, noise: float
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Return deflection, rate and acceleration, and where the motion is resolved."""
    step = float(np.median(np.diff(time)))
    if np.ptp(np.diff(time)) > 1e-3 * step:
        grid = np.linspace(time[0], time[-1], deflection.size)
        read = np.interp(grid, time, deflection)
        level, *rest, resolved = _smoothed(grid, read, noise)
        rate, acceleration = (np.interp(time, grid, r) for r in rest)
        return deflection - np.interp(time, grid, read - level), rate, acceleration, resolved
    resolved = _resolved(deflection, noise)
    parts = np.zeros((3, deflection.size))
    for begin, end in _pieces(resolved):
        parts[:, begin:end] = smoothed(deflection[begin:end], step, noise)
    smooth, rate, acceleration = parts
    return smooth, rate, acceleration, resolved


def _resolved(deflection: FloatArray, noise: float) -> BoolArray:
    """Return where five samples follow a cubic."""
    resolved = np.ones(deflection.size, dtype=bool)
    travel = float(np.sqrt(max(np.mean(np.diff(deflection) ** 2) - 2.0 * noise**2, 0.0)))
    basis = np.linalg.qr(np.vander(np.arange(-2.0, 3.0), 4, increasing=True))[0]
    outside = np.linalg.qr(np.eye(5) - basis @ basis.T)[0][:, 0]
    misfit = np.convolve(deflection - deflection.mean(), outside[::-1], mode="valid") ** 2
    resolved[2:-2] = misfit < max(CORNER * noise**2, (NEGLIGIBLE * travel) ** 2)
    return resolved


def _pieces(resolved: BoolArray) -> list[tuple[int, int]]:
    """Return begin and end of the pieces of the motion between its corners; a spline overshoots beside a corner.

    Pieces shorter than SHORTEST stay with their neighbours, as do longer unresolved parts, which are not one corner.
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


def branches(deflection: FloatArray, noise: float) -> tuple[FloatArray, FloatArray]:
    """Return direction (n,), +1 or -1, and number of the cycle (n,) of a deflection (n,) [m] with this noise [m].

    A reversal counts if the deflection then goes back by more than six times the noise and a fiftieth of the span; it
    counts from its turning point on.
    """
    threshold = max(6.0 * noise, 0.02 * float(np.ptp(deflection)))
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
    return direction, cycle


CUTOFFS = np.pi * np.geomspace(0.02, 2.0, 14)
"""Cut-off frequencies [1/sample]: from a hundred samples to almost the samples themselves."""

WINDOW = 2.0 * CORNER_SAMPLES
"""Standard deviation [samples] of the window over which log p is summed: as wide as two corners."""

WEIGHT_ROUNDS = 6
"""Number of expectation-maximisation steps in which the weights of the splines are found."""

PADDING = 400
"""Most samples that are reflected at each end, so that value and slope continue there."""

LEVERAGE = 0.97
"""Upper bound of a spline's leverage: the shortest one would leave no residual to compute log p from."""


def smoothed(values: FloatArray, step: float, noise: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return value, first and second derivative of even samples.

    values (n,) with n >= 3; step: between samples [s]; noise: standard deviation of the reading, in the values' unit
    """
    count = values.size
    pad = min(count - 1, PADDING)
    line = np.linspace(values[0], values[-1], count)
    level = values - line
    reflected = np.concatenate([-level[pad:0:-1], level, -level[-2 : -pad - 2 : -1]])
    whole = next_fast_len(reflected.size, real=True)
    # The samples that fill up to a quick length are detrended too: both ends are zero.
    filled = np.concatenate([reflected, np.linspace(reflected[-1], reflected[0], whole - reflected.size)])
    slope = (values[-1] - values[0]) / (count - 1)
    angle = 2.0 * np.pi * rfftfreq(whole)
    spectrum = rfft(filled)
    inside = slice(pad, pad + count)
    splines = [1.0 / (1.0 + (angle / cutoff) ** 6) for cutoff in CUTOFFS]
    leverages = [min(float(np.mean(passed)), LEVERAGE) for passed in splines]
    scores = np.empty((len(splines), count), dtype=np.float32)
    for i, (passed, leverage) in enumerate(zip(splines, leverages, strict=True)):
        left = (level - irfft(spectrum * passed, whole)[inside]) / noise
        score = 0.5 * (np.log(1.0 - leverage) - left**2 / (1.0 - leverage))
        scores[i] = gaussian_filter1d(score, WINDOW, mode="nearest") * np.sqrt(4.0 * np.pi) * WINDOW
    sums = np.zeros((3, count))
    for passed, weight in zip(splines, _weights(scores), strict=True):
        kept = spectrum * passed
        sums[0] += weight * irfft(kept, whole)[inside]
        sums[1] += weight * (irfft(1j * angle * kept, whole)[inside] + slope)
        sums[2] -= weight * irfft(angle**2 * kept, whole)[inside]
    return sums[0] + line, sums[1] / step, sums[2] / step**2


def _weights(scores: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the weight of each spline at every sample, (splines, n); its mean weight is its prior."""
    scores -= scores.max(axis=0)
    prior = np.full((scores.shape[0], 1), 1.0 / scores.shape[0], dtype=np.float32)
    for _ in range(WEIGHT_ROUNDS):
        weights = prior * np.exp(scores)
        weights /= weights.sum(axis=0)
        prior = weights.mean(axis=1, keepdims=True)
    return weights


SAME = 3.0 * float(np.sqrt(2.0))
"""Largest difference of the misfit before and after a reversal, in units of the noise: three standard deviations of a
difference."""


def followed_turns(misfit: FloatArray, resolved: BoolArray, noise: float) -> BoolArray:
    """Return which samples (n,) lie in reversals with the same misfit before and after; noise: of a sample of the
    misfit.
    """
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
    """Return rate [m/s] and acceleration [m/s^2] with a rate that changes linearly within each of the `turns`."""
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
