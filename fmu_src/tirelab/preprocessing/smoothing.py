"""Deflection, rate and acceleration from a noisy reading: the longest smoothing that the motion allows at each moment.

A smoothing spline of order 3 (it penalises the third derivative) passes an angular frequency w [1/sample] by

    H(w) = 1 / (1 + (w / w_c)^6)

Splines of many cut-offs w_c are fitted. How well each predicts a held-out sample is known without another fit: a
residual r of leverage h has left out the variance s^2 (1 - h) of the reading's noise s,

    log p = 1/2 log(1 - h) - r^2 / (2 s^2 (1 - h))

Summed over a window around each sample this weighs the splines (Wahba, "Spline Models for Observational Data", SIAM
1990, on leave-one-out; the mean over models is Bayesian), together with how often each is used in the whole recording:
long ones where the motion is smooth, short ones at corners. Being a mean given the data and not the data themselves,
rate and acceleration do not bias what is fitted to them towards zero.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq
from scipy.ndimage import gaussian_filter1d

FloatArray = NDArray[np.float64]

CUTOFFS = np.pi * np.geomspace(0.02, 2.0, 14)
"""Cut-off frequencies [1/sample]: from a hundred samples to almost the samples themselves."""

WINDOW = 12.0
"""Standard deviation [samples] of the window over which splines are weighed: some forty samples together."""

WEIGHT_ROUNDS = 6
"""Rounds in which the splines' shares are found: an expectation and a maximisation each."""

PADDING = 400
"""Samples that are reflected at each end, so that value and slope go on there."""

LEVERAGE = 0.97
"""Upper bound of a spline's leverage: the shortest one would leave no residual to judge it by."""


def smoothed(
    values: FloatArray, step: float, noise: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return value, first and second derivative of even samples, and the part of the noise's variance left.

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
    sums = np.zeros((4, count))
    for passed, leverage, weight in zip(splines, leverages, _weights(scores), strict=True):
        kept = spectrum * passed
        sums[0] += weight * irfft(kept, whole)[inside]
        sums[1] += weight * (irfft(1j * angle * kept, whole)[inside] + slope)
        sums[2] -= weight * irfft(angle**2 * kept, whole)[inside]
        sums[3] += weight * leverage
    return sums[0] + line, sums[1] / step, sums[2] / step**2, sums[3]


def _weights(scores: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return each spline's weight at every sample, (splines, n): often used ones have the larger prior."""
    scores -= scores.max(axis=0)
    prior = np.full((scores.shape[0], 1), 1.0 / scores.shape[0], dtype=np.float32)
    for _ in range(WEIGHT_ROUNDS):
        weights = prior * np.exp(scores)
        weights /= weights.sum(axis=0)
        prior = weights.mean(axis=1, keepdims=True)
    return weights
