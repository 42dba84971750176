"""Deflection, rate and acceleration from a noisy reading: smoothing that is as long, moment by moment, as it may be.

A smoothing spline of order 3 (it penalises the third derivative) passes an angular frequency w [1/sample] by

    H(w) = 1 / (1 + (w / w_c)^6)

Splines of many cut-offs w_c are fitted. How well each foretells a sample that it has not seen is known without another
fit: a residual r of leverage h has left out the variance s^2 (1 - h) of the reading's noise s,

    log p = 1/2 log(1 - h) - r^2 / (2 s^2 (1 - h))

Summed over a stretch around each sample this weighs the splines (Wahba, "Spline Models for Observational Data", SIAM
1990, on leaving one out; the mean over models is Bayes'): long ones on smooth stretches, short ones at corners. Being a
mean given the data and not the data themselves, rate and acceleration do not bias what is fitted to them towards zero.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq
from scipy.ndimage import gaussian_filter1d

FloatArray = NDArray[np.float64]

CUTOFFS = np.pi * np.geomspace(0.02, 2.0, 14)
"""Cut-off frequencies [1/sample]: from a stretch of a hundred samples to next to the samples themselves."""

STRETCH = 12.0
"""Standard deviation [samples] of the stretch over which splines are weighed: some forty samples together."""

PADDING = 400
"""Samples that are turned over at each end, so that value and slope go on there."""

LEVERAGE = 0.97
"""No spline's leverage is taken for more: the shortest one would leave nothing to judge it by."""


def smoothed(
    values: FloatArray, step: float, noise: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return value, first and second derivative of even samples, and the part of the noise's variance in the value.

    values (n,) with n >= 3; step: between samples [s]; noise: standard deviation of the reading, in the values' unit
    """
    count = values.size
    pad = min(count - 1, PADDING)
    line = np.linspace(values[0], values[-1], count)
    level = values - line
    turned = np.concatenate([-level[pad:0:-1], level, -level[-2 : -pad - 2 : -1]])
    whole = next_fast_len(turned.size, real=True)
    # The samples that fill up to a quick length are level too: both ends stand at nothing.
    filled = np.concatenate([turned, np.linspace(turned[-1], turned[0], whole - turned.size)])
    slope = (values[-1] - values[0]) / (count - 1)
    angle = 2.0 * np.pi * rfftfreq(whole)
    spectrum = rfft(filled)
    inside = slice(pad, pad + count)
    best = np.full(count, -np.inf)
    weight = np.zeros(count)
    sums = np.zeros((4, count))
    for cutoff in CUTOFFS:
        passed = 1.0 / (1.0 + (angle / cutoff) ** 6)
        leverage = min(float(np.mean(passed)), LEVERAGE)
        kept = spectrum * passed
        found = np.stack(
            [
                irfft(kept, whole)[inside],
                irfft(1j * angle * kept, whole)[inside] + slope,
                irfft(-(angle**2) * kept, whole)[inside],
                np.full(count, leverage),
            ]
        )
        left = (level - found[0]) / noise
        score = 0.5 * (np.log(1.0 - leverage) - left**2 / (1.0 - leverage))
        score = gaussian_filter1d(score, STRETCH, mode="nearest") * np.sqrt(4.0 * np.pi) * STRETCH
        higher = np.maximum(best, score)
        fade, share = np.exp(best - higher), np.exp(score - higher)
        sums = sums * fade + found * share
        weight = weight * fade + share
        best = higher
    mean = sums / weight
    return mean[0] + line, mean[1] / step, mean[2] / step**2, mean[3]
