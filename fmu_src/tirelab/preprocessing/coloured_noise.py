"""Slow noise: white noise plus relaxations of many correlation times, estimated from a spectrum and whitened exactly.

A first-order Markov noise of variance a and correlation time tau [samples] has, with f = exp(-1/tau), the spectrum

    a L(w),   L(w) = (1 - f^2) / (1 - 2 f cos w + f^2)

and sums of them, their times a factor apart, follow drift and 1/f noise alike (A. van der Ziel, Physica 16, 1950). With
v = 2 - 2 cos w, b = a (1 - f^2) / f and c = (1 - f)^2 / f the whole is

    S(w) = s + sum_j b_j / (v + c_j) = s prod_j (v + e_j) / (v + c_j)

There is one e_j above each c_j and below the next. With (1 - g_j)^2 / g_j = e_j, |g_j| < 1, the cascade of sections

    (1 - f_j / z) / (1 - g_j / z)

leaves white noise of variance s prod_j f_j / g_j (spectral factorisation).

The variances maximise the likelihood of the periodogram I of a residual (P. Whittle, Ark. Mat. 2, 1953). Where a fitted
model has the leverage h(w) on the noise, I / (1 - h) has the mean S, with 1 - h degrees of freedom: the residual
likelihood (H. D. Patterson, R. Thompson, Biometrika 58, 1971), one frequency at a time.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct
from scipy.signal import sosfilt

FloatArray = NDArray[np.float64]

SHORTEST_TIME, TIME_RATIO = 2.0, 2.0
"""Shortest correlation time that is tried [samples], and the factor between two of them."""

LONGEST_TIME = 0.1
"""Longest correlation time, as a part of the recording: what changes more slowly is a trend, not noise."""

SLOW_TIME, MOST_SLOW_VARIANCE = 20.0, 1.0
"""Largest variance of what is slower than SLOW_TIME samples over that of all that is quicker: more comes from a
missing effect, not from the amplifier."""

MOST_LEVERAGE = 0.7
"""Frequencies at which a model has more leverage than this are left out."""

LINE_LIMIT = 8.0
"""Power over the spectrum above which it is a line and is clipped: one value in 200 of noise is."""

FREQUENCY_BINS = 60
"""Bands of frequencies, even over the logarithm, over which the periodogram is averaged."""

LEAST_SHARE = 0.02
"""A relaxation that is nowhere more than this share of the spectrum is dropped without a test."""

UPDATES = 60
"""Multiplicative updates of the variances."""

LINE_PASSES = 3
"""Fits in turn with clipping of lines: the first has no spectrum to clip by."""


@dataclass(frozen=True)
class SlowNoise:
    """White noise of variance `white` beside relaxations: times [samples] and variances, shape (k,).

    sections (k, 6): of the whitening filter, as `scipy.signal.sosfilt` takes them
    """

    white: float = 1.0
    times: FloatArray = field(default_factory=lambda: np.zeros(0))
    variances: FloatArray = field(default_factory=lambda: np.zeros(0))
    sections: FloatArray = field(default_factory=lambda: np.zeros((0, 6)))

    def whitened(self, values: FloatArray) -> FloatArray:
        """Return values (n,) or (n, k) without the predictable part of the slow noise."""
        return np.asarray(sosfilt(self.sections, values, axis=0)) if self.times.size else values

    @property
    def level(self) -> float:
        """Standard deviation of the whole."""
        return float(np.sqrt(self.white + self.variances.sum()))

    @property
    def gain(self) -> float:
        """What the whitening filter leaves of a constant."""
        return float(np.prod(self.sections[:, :3].sum(axis=1) / self.sections[:, 3:].sum(axis=1)))


WHITE = SlowNoise()
"""No slow noise at all."""


def slow_noise(residual: FloatArray, leverage: FloatArray | None = None) -> SlowNoise:
    """Return the slow noise of maximum likelihood for a residual (n,), even in time.

    leverage (n,): of a fitted model on each cosine coefficient of the residual, 0 to 1; None: zero
    """
    count = residual.size
    free = np.ones(count) if leverage is None else 1.0 - np.clip(leverage, 0.0, 1.0)
    free[0] = 0.0
    known = free > 1.0 - MOST_LEVERAGE
    if np.sum(known) < FREQUENCY_BINS:
        return SlowNoise(float(np.mean(residual**2)))
    power = (dct(residual, norm="ortho") ** 2)[known]
    angle, free = (np.pi * np.arange(count) / count)[known], free[known]
    times = np.geomspace(
        SHORTEST_TIME,
        LONGEST_TIME * count,
        int(np.log(LONGEST_TIME * count / SHORTEST_TIME) / np.log(TIME_RATIO)) + 1,
    )
    decay = np.exp(-1.0 / times)
    spectra = (1.0 - decay**2) / (1.0 - 2.0 * decay * np.cos(angle[:, None]) + decay**2)
    spectra = np.concatenate([np.ones((angle.size, 1)), spectra], axis=1)
    edges = np.unique(np.geomspace(1, power.size + 1, FREQUENCY_BINS).astype(int) - 1)[:-1]
    weight = np.add.reduceat(free, edges)
    binned = np.add.reduceat(spectra * free[:, None], edges, axis=0) / weight[:, None]
    variances = np.zeros(times.size + 1)
    for turn in range(LINE_PASSES):
        most = LINE_LIMIT * (spectra @ variances) * free if turn else power
        mean = np.add.reduceat(np.minimum(power, most), edges) / weight
        variances = _selected(binned, mean, weight)
    white, others = float(variances[0]), variances[1:]
    slow = times > SLOW_TIME
    quick, loud = white + float(others[~slow].sum()), float(others[slow].sum())
    others = np.where(slow, others * min(1.0, MOST_SLOW_VARIANCE * quick / max(loud, 1e-300)), others)
    return _factored(white, times[others > 0.0], others[others > 0.0])


def _selected(spectra: FloatArray, mean: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the variances of maximum likelihood; zero for relaxations that gain less than the BIC penalty of one."""
    variances, score = _most_likely(spectra, mean, weight)
    seen = np.max(spectra * variances / (spectra @ variances)[:, None], axis=0) > LEAST_SHARE
    kept = np.flatnonzero(seen | (np.arange(seen.size) == 0))
    variances, score = _most_likely(spectra[:, kept], mean, weight)
    while kept.size > 1:
        tried = [_most_likely(spectra[:, np.delete(kept, i)], mean, weight) for i in range(1, kept.size)]
        least = int(np.argmin([s for _, s in tried]))
        if tried[least][1] - score > np.log(mean.size):
            break
        kept = np.delete(kept, least + 1)
        variances, score = tried[least]
    whole = np.zeros(spectra.shape[1])
    whole[kept] = variances
    return whole


def _most_likely(spectra: FloatArray, mean: FloatArray, weight: FloatArray) -> tuple[FloatArray, float]:
    """Return non-negative variances for averaged powers, and minus twice their log likelihood.

    Multiplicative updates until they converge (C. Fevotte, N. Bertin, J.-L. Durrieu, Neural Comput. 21, 2009).
    """
    variances = np.full(spectra.shape[1], float(np.average(mean, weights=weight)) / spectra.shape[1])
    for _ in range(UPDATES):
        fitted = spectra @ variances
        variances = variances * np.sqrt(
            (spectra.T @ (weight * mean / fitted**2)) / (spectra.T @ (weight / fitted))
        )
    fitted = spectra @ variances
    return variances, float(np.sum(weight * (mean / fitted + np.log(fitted))))


def _factored(white: float, times: FloatArray, variances: FloatArray) -> SlowNoise:
    """Return the noise with its whitening filter; times [samples] rising."""
    if times.size == 0:
        return SlowNoise(white)
    # Without any white noise there is no first section: a ten thousandth of it is below every noise.
    white = max(white, 1e-4 * float(variances.sum()))
    decay = np.exp(-1.0 / times[::-1])
    b = variances[::-1] * (1.0 - decay**2) / decay
    c = (1.0 - decay) ** 2 / decay
    e = _roots(white, b, c)
    passed = 1.0 + 0.5 * e - np.sqrt(e + 0.25 * e**2)
    ones, nothing = np.ones(times.size), np.zeros(times.size)
    return SlowNoise(
        white, times, variances, np.stack([ones, -decay, nothing, ones, -passed, nothing], axis=1)
    )


def _roots(white: float, b: FloatArray, c: FloatArray) -> FloatArray:
    """Return the e_j with s + sum b_i / (c_i - e_j) = 0: one above each c_j (rising) and below the next."""
    roots = []
    for low, high in zip(c, [*c[1:], c[-1] + b.sum() / white], strict=True):
        for _ in range(60):
            middle = 0.5 * (low + high)
            below = white + float(np.sum(b / (c - middle))) < 0.0
            low, high = (middle, high) if below else (low, middle)
        roots.append(0.5 * (low + high))
    return np.array(roots)
