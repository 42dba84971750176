"""The noise of a recording, from the data alone: its size, its colour, its spikes, and the part from the deflection.

The residual of the saturated model (all effects and smooth functions of all coordinates at once) counts as noise: white
noise and slow relaxations (`slow_noise`), an autoregression for what is quick (order by BIC), and innovations that may
have outliers. The reading of the deflection has noise too; through the stiffness k of the tire it adds (k s_x)^2 to the
variance of the force.
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
from .robust_scale import SPIKE_LIMIT, robust_sigma

AUTOREGRESSION_ORDERS = (0, 1, 2, 4, 8, 16)
"""Orders of autoregression tried; 16 holds a mains hum."""

LARGEST_LOADS, GATHERING_CHANCE = 0.05, 1e-3
"""Part of the samples with the largest loads, and the chance below which spikes among them are no coincidence."""

MEAN_DRIFT = 0.2
"""Standard deviation of the drift of the mean over the noise level: what is slower than the recording, and hum at a
multiple of its sampling rate, cannot be seen in a residual whose mean the model has fitted."""


@dataclass(frozen=True)
class Noise:
    """The noise of one recording.

    innovation: standard deviation [N] of the part that earlier samples do not predict; level: of the noise itself [N]
    slow: the part correlated over long times, whitened first; filter: coefficients of the whitening filter for the
    rest, the first is 1; spread: standard deviation of each sample over that of the median sample; weight: 1, or 0 at
    spikes and at the filter's start
    """

    innovation: float
    level: float
    filter: FloatArray
    spread: FloatArray
    weight: FloatArray
    slow: SlowNoise = WHITE

    @property
    def spikes(self) -> int:
        """Number of samples that count as spikes."""
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
    def mean_drift(self) -> tuple[FloatArray, float]:
        """A constant, whitened and of length 1, and the part of a product along it that the drift of the mean takes.

        With w = MEAN_DRIFT level the products of whitened columns are those of the covariance I + w^2 1 1'.
        """
        constant = self.whitened(np.ones(self.weight.size))
        length = float(np.linalg.norm(constant))
        if length == 0.0:
            return constant, 0.0
        more = (MEAN_DRIFT * self.level * length) ** 2
        return constant / length, more / (1.0 + more)


def white_noise(level: float, samples: int) -> Noise:
    """Return white noise of a level [N] in so many samples, none of them a spike."""
    ones = np.ones(samples)
    return Noise(level, level, np.ones(1), ones, ones)


def first_guess(residual: FloatArray) -> Noise:
    """Return white noise of the size that the second differences of a residual [N] show."""
    sigma = robust_sigma(np.diff(residual, 2)) / np.sqrt(6.0)
    sigma = max(sigma, 1e-6 * float(np.ptp(residual)), 1e-9)
    ones = np.ones(residual.size)
    return Noise(sigma, sigma, np.ones(1), ones, ones)


def noise_of(
    residual: FloatArray,
    through_deflection: FloatArray,
    freedom: float,
    resolved: BoolArray,
    leverage: FloatArray | None = None,
    load: FloatArray | None = None,
) -> Noise:
    """Return the noise of which `residual` [N] is a sample, left by a model of `freedom` effective degrees of freedom.

    through_deflection [N]: stiffness times the deflection's noise, sample by sample; resolved: False where the motion
    has a corner within a sample; leverage: see `slow_noise`, None where the model is too small to fit much of the noise
    load [N]: of the tire; outliers that gather under the largest loads are no spikes but a saturation or a rim strike;
    None: not tested
    """
    count = residual.size
    if np.mean(resolved) < 0.8:
        resolved = np.ones(count, dtype=bool)
    residual_variance = robust_sigma(residual) ** 2
    random = max(residual_variance - float(np.median(through_deflection**2)), 0.05 * residual_variance, 1e-18)
    spread = np.sqrt((random + through_deflection**2) / (random + float(np.median(through_deflection**2))))
    scaled = residual / spread
    robust = robust_sigma(scaled) + 1e-12
    clipped = np.clip(scaled, -4.0 * robust, 4.0 * robust)
    slow = slow_noise(clipped, leverage)
    filter_ = _autoregression(slow.whitened(clipped))
    innovations = lfilter(filter_, [1.0], slow.whitened(scaled))
    sigma = robust_sigma(innovations)
    # Two samples in a row at most: what lasts longer is no spike but a missing effect.
    out = np.abs(innovations) > SPIKE_LIMIT * sigma
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
    if leverage is not None:
        # The part of the slow noise that the model has fitted is still noise.
        level = max(level, slow.level * float(np.sqrt(np.mean(spread[kept] ** 2))))
    return Noise(float(innovation), float(level), filter_, spread, weight, slow)


def _gathered(lone: BoolArray, load: FloatArray) -> BoolArray:
    """Return where the load is among the largest, if outliers gather there."""
    highest = load > np.quantile(load, 1.0 - LARGEST_LOADS)
    count, among = int(np.sum(lone)), int(np.sum(lone & highest))
    chance = float(binom.sf(among - 1, count, float(np.mean(highest)))) if among else 1.0
    return highest if chance < GATHERING_CHANCE else np.zeros_like(highest)


def _autoregression(values: FloatArray) -> FloatArray:
    """Return the whitening filter of the autoregression with the least BIC (Yule & Walker)."""
    count = values.size
    best, best_score = np.ones(1), count * np.log(float(np.mean(values**2)) + 1e-300)
    for order in AUTOREGRESSION_ORDERS[1:]:
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
