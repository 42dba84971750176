"""The noise of a recording, from the data alone: its size, colour and spikes, and what the deflection's noise adds.

The residual that is left by a model with every freedom at once (all effects and smooth functions of all coordinates) is
taken for noise: slow relaxations beside white noise (`slow_noise`), what is quick in an autoregression (order by BIC),
and innovations that may have outliers. The reading of the deflection carries noise too; through the stiffness k of the
tire its part of the force's variance is (k s_x)^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_toeplitz
from scipy.signal import lfilter
from scipy.stats import binom

from .coloured_noise import WHITE, SlowNoise, slow_noise
from .kinematics import BoolArray, FloatArray

ORDERS = (0, 1, 2, 4, 8, 16)
"""Orders of autoregression tried; 16 holds a mains hum."""

SPIKE = 4.5
"""Innovations beyond this many standard deviations are spikes: one in 150 000 of a normal law."""

HIGHEST, GATHERED = 0.05, 1e-3
"""Part of the samples with the largest loads, and the chance at which spikes that fall anywhere gather among them."""

WANDER = 0.2
"""Standard deviation of a recording's mean over the level: what is slower than the recording, and hum at a multiple of
its sampling, cannot be seen in a residual whose mean the model has taken."""

MEDIAN_TO_SIGMA = 1.4826
"""Standard deviation of a normal law over its median absolute deviation."""


@dataclass(frozen=True)
class Noise:
    """The noise of one recording.

    innovation: standard deviation [N] of what cannot be foretold from the samples before; level: of the noise itself,
    [N]; slow: what of it is foretold over long times, whitened first; filter: coefficients of the whitening filter for
    the rest, the first is 1; spread: standard deviation of each sample over that of the median sample; weight: 1, or 0
    where a spike or the filter's start stands
    """

    innovation: float
    level: float
    filter: FloatArray
    spread: FloatArray
    weight: FloatArray
    slow: SlowNoise = WHITE

    @property
    def spikes(self) -> int:
        """Number of samples taken for spikes."""
        return int(np.sum(self.weight[self.filter.size - 1 :] == 0.0))

    @property
    def correlation_samples(self) -> float:
        """Variance of a long mean over that of white noise of the same level, in samples."""
        gain = 1.0 / (float(np.sum(self.filter)) * self.slow.gain) ** 2
        return max(1.0, gain * self.innovation**2 / max(self.level, 1e-300) ** 2)

    def whitened(self, values: FloatArray) -> FloatArray:
        """Return `values` (n,) or (n, k) [N] whitened and in units of the noise."""
        across = (slice(None),) + (None,) * (values.ndim - 1)
        scaled = values / (self.innovation * self.spread[across])
        scaled = self.slow.whitened(scaled)
        if self.filter.size > 1:
            scaled = lfilter(self.filter, [1.0], scaled, axis=0)
        return np.asarray(scaled * self.weight[across])

    @cached_property
    def wander(self) -> tuple[FloatArray, float]:
        """A constant, whitened and of length 1, and what part of a product along it says nothing: the mean wanders.

        With w = WANDER level the products of whitened columns are those of the covariance I + w^2 1 1'.
        """
        constant = self.whitened(np.ones(self.weight.size))
        length = float(np.linalg.norm(constant))
        if length == 0.0:
            return constant, 0.0
        more = (WANDER * self.level * length) ** 2
        return constant / length, more / (1.0 + more)


def first_guess(residual: FloatArray) -> Noise:
    """Return white noise of the size that the second differences of a residual [N] show."""
    sigma = MEDIAN_TO_SIGMA * float(np.median(np.abs(np.diff(residual, 2)))) / np.sqrt(6.0)
    sigma = max(sigma, 1e-6 * float(np.ptp(residual)), 1e-9)
    ones = np.ones(residual.size)
    return Noise(sigma, sigma, np.ones(1), ones, ones)


def noise_of(
    residual: FloatArray,
    through_deflection: FloatArray,
    freedom: float,
    resolved: BoolArray,
    taken: FloatArray | None = None,
    load: FloatArray | None = None,
) -> Noise:
    """Return the noise whose sample is `residual` [N], left by a model of `freedom` effective coefficients.

    through_deflection [N]: stiffness times the deflection's noise, sample by sample; resolved: False where the motion
    turns within a sample; taken: see `slow_noise`, None where the model is too small to take much of the noise
    load [N]: of the tire; what gathers under the largest loads is no spike but a ceiling or a strike, None: not asked
    """
    count = residual.size
    if np.mean(resolved) < 0.8:
        resolved = np.ones(count, dtype=bool)
    median_square = (MEDIAN_TO_SIGMA * float(np.median(np.abs(residual)))) ** 2
    floor = max(median_square - float(np.median(through_deflection**2)), 0.05 * median_square, 1e-18)
    spread = np.sqrt((floor + through_deflection**2) / (floor + float(np.median(through_deflection**2))))
    scaled = residual / spread
    robust = MEDIAN_TO_SIGMA * float(np.median(np.abs(scaled))) + 1e-12
    clipped = np.clip(scaled, -4.0 * robust, 4.0 * robust)
    slow = slow_noise(clipped, taken)
    filter_ = _autoregression(slow.whitened(clipped))
    innovations = lfilter(filter_, [1.0], slow.whitened(scaled))
    sigma = MEDIAN_TO_SIGMA * float(np.median(np.abs(innovations)))
    # Two samples in a row at most: what lasts longer is no spike but something left out.
    out = np.abs(innovations) > SPIKE * sigma
    lone = (
        out
        & ~(np.roll(out, 1) & np.roll(out, -1))
        & ~(np.roll(out, 1) & np.roll(out, 2))
        & ~(np.roll(out, -1) & np.roll(out, -2))
    )
    if load is not None:
        lone &= ~_gathered(lone, load)
    weight = np.where(lone | ~resolved, 0.0, 1.0)
    weight[: filter_.size - 1] = 0.0
    if np.mean(weight > 0.0) < 0.5:
        weight = np.ones(count)
    corrected = count / max(count - freedom, 0.2 * count)
    kept = weight > 0.0
    innovation = np.sqrt(corrected * float(np.mean(innovations[kept] ** 2)))
    level = np.sqrt(corrected * float(np.mean(residual[kept] ** 2)))
    if taken is not None:
        # What the model has taken of the slow noise is still noise.
        level = max(level, slow.level * float(np.sqrt(np.mean(spread[kept] ** 2))))
    return Noise(float(innovation), float(level), filter_, spread, weight, slow)


def _gathered(lone: BoolArray, load: FloatArray) -> BoolArray:
    """Return where the load is among the largest, if outliers gather there."""
    highest = load > np.quantile(load, 1.0 - HIGHEST)
    count, among = int(np.sum(lone)), int(np.sum(lone & highest))
    chance = float(binom.sf(among - 1, count, float(np.mean(highest)))) if among else 1.0
    return highest if chance < GATHERED else np.zeros_like(highest)


def _autoregression(values: FloatArray) -> FloatArray:
    """Return the whitening filter of the autoregression with the least BIC (Yule & Walker)."""
    count = values.size
    best, best_score = np.ones(1), count * np.log(float(np.mean(values**2)) + 1e-300)
    for order in ORDERS[1:]:
        if order > count // 50:
            break
        lags = np.array([values[: count - k] @ values[k:] for k in range(order + 1)]) / count
        lags[0] *= 1.0 + 1e-9
        filter_ = np.concatenate([[1.0], -solve_toeplitz(lags[:order], lags[1:])])
        innovations = lfilter(filter_, [1.0], values)[order:]
        score = count * np.log(float(np.mean(innovations**2)) + 1e-300) + order * np.log(count)
        if score < best_score:
            best, best_score = filter_, score
    return best
