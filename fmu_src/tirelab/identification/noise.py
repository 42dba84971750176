"""The covariance of A and B of a surface, from the measured noise and its autocorrelation.

The errors F - A x^B of each recording are averaged over at most 2000 consecutive blocks; the difference of loading and
unloading (the loop: a mean part and a part that grows with the deflection) is removed, since both branches have the
same weight and it cancels. The remainder is the noise. Its autocorrelation is pooled over the recordings with blocks of
about the same duration and described by an autoregression, whose order the Bayesian criterion selects; noise whose
autocorrelation sums to less than that of white noise counts as white. Then, with J the derivatives of the force by A
and B, W the weights and R the noise's covariance,

    cov(A, B) = (J' W J)^-1 (J' W R W J) (J' W J)^-1

Reference: W. den Haan & A. Levin, "A practitioner's guide to robust covariance matrix estimation", Handbook of
Statistics 15 (1997) 299, for the covariance by an autoregression in place of a window.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft
from scipy.linalg import matmul_toeplitz, solve_toeplitz

from .power_fit import inner_products
from .surfaces import Piece, Surface

BLOCKS_MOST = 2000
"""Most blocks into which a recording is divided."""

ORDER_MOST = 8
"""Highest order of the autoregression."""

CORRECTIONS, CORRECTED = 20, 1e-4
"""Most corrections of the autocorrelation for the fitted part, and the relative change that ends them sooner."""

LEFT_LEAST = 0.25
"""Least fraction of a recording's noise that the fit is taken to leave: with less its variance would be a guess."""

NOISE_FLOOR = 1e-10
"""Noise, as a fraction of the largest force, below which a recording counts as free of noise."""


@dataclass(frozen=True)
class PowerFit:
    """A and B of one surface and their covariance.

    coefficient: A [N/cm^B]; exponent: B [1]; covariance of (A, B) (2, 2)
    products: J' W J of the derivatives by A and B (2, 2); meat: J' W R W J (2, 2)
    noise: standard deviation of a sample's noise [N]; independent: effective number of independent samples
    loop: mean force of loading less that of unloading [N], None where one of them is missing
    """

    coefficient: float
    exponent: float
    covariance: NDArray[np.float64]
    products: NDArray[np.float64]
    meat: NDArray[np.float64]
    noise: float
    independent: float
    loop: float | None


@dataclass(frozen=True)
class _Blocks:
    """One recording in blocks.

    noise: mean of each block [N] (n,); scores: sums of W J (n, 2)
    fitted: what was fitted to the errors, as orthonormal columns (n, 2 or 4): the noise is orthogonal to them
    size: samples in a block; interval: [s] that a block lasts; within: variance of the samples inside a block [N^2]
    noise_floor: noise [N] below which a recording counts as free of noise
    """

    noise: NDArray[np.float64]
    scores: NDArray[np.float64]
    fitted: NDArray[np.float64]
    size: int
    interval: float
    within: float
    noise_floor: float
    loop: float | None

    @property
    def kin(self) -> int:
        """A number that recordings share whose blocks last alike, within 5 %."""
        return round(math.log(self.interval) / 0.05)


def with_covariance(surfaces: Sequence[Surface], fits: Sequence[tuple[float, float]]) -> tuple[PowerFit, ...]:
    """Return A and B of each surface, as given by `fits`, with their covariance."""
    blocks = [
        [_blocks(piece, surface, A, B) for piece in surface.pieces]
        for surface, (A, B) in zip(surfaces, fits, strict=True)
    ]
    every = [b for of_surface in blocks for b in of_surface]
    correlations = {
        kin: _autocorrelation([b for b in every if b.kin == kin]) for kin in {b.kin for b in every}
    }
    return tuple(
        _power_fit(surface, fit, of_surface, correlations)
        for surface, fit, of_surface in zip(surfaces, fits, blocks, strict=True)
    )


def _power_fit(
    surface: Surface,
    fit: tuple[float, float],
    blocks: list[_Blocks],
    correlations: dict[int, NDArray[np.float64]],
) -> PowerFit:
    scale = np.diag([1.0, fit[0]])
    products = scale @ inner_products(surface, *fit)[:2, :2] @ scale
    meat = np.zeros((2, 2))
    independent = variance = 0.0
    for b in blocks:
        count = b.noise.size
        correlation = correlations[b.kin][:count]
        repeats = float(1.0 + 2.0 * ((1.0 - np.arange(1, count) / count) @ correlation[1:]))
        of_block = max(float(b.noise @ b.noise) / float(_expected(b, correlation, 0)[0]), b.noise_floor**2)
        scattered = b.scores.T @ matmul_toeplitz(correlation, b.scores)
        if np.linalg.eigvalsh(scattered)[0] <= 0.0:
            scattered = b.scores.T @ matmul_toeplitz(_possible(correlation), b.scores)
        meat += of_block * scattered
        independent += min(count * (b.within + of_block) / (of_block * repeats), count * b.size)
        variance += (b.within + of_block) / len(blocks)
    inverse = np.linalg.inv(products)
    loops = [b.loop for b in blocks if b.loop is not None]
    return PowerFit(
        coefficient=fit[0],
        exponent=fit[1],
        covariance=inverse @ meat @ inverse,
        products=products,
        meat=meat,
        noise=variance**0.5,
        independent=independent,
        loop=sum(loops) / len(loops) if loops else None,
    )


def _blocks(piece: Piece, surface: Surface, coefficient: float, exponent: float) -> _Blocks:
    size = -(-piece.force.size // BLOCKS_MOST)
    edges = np.arange(0, piece.force.size, size)
    counts = np.diff(edges, append=piece.force.size)

    def mean(values: NDArray[np.float64] | NDArray[np.int8]) -> NDArray[np.float64]:
        sums: NDArray[np.float64] = np.add.reduceat(values, edges, dtype=np.float64)
        return sums / counts

    power = np.exp(exponent * piece.log_deflection)
    error = piece.force - coefficient * power
    noise = mean(error)
    within = max(float(error @ error) / error.size - float(np.mean(noise**2)), 0.0)
    del error
    power *= surface.weights[piece.branch]
    scores = np.empty((edges.size, 2))
    scores[:, 0] = mean(power)
    power *= piece.log_deflection
    scores[:, 1] = coefficient * mean(power)
    scores *= counts[:, None]

    sign = mean(piece.branch)
    loop, fitted = None, scores
    if sign.min() < 0.0 < sign.max():
        depth = np.exp(mean(piece.log_deflection))
        regressors = np.stack([sign, sign * depth / depth.max()], axis=1)
        part, *_ = np.linalg.lstsq(regressors, noise, rcond=None)
        noise -= regressors @ part
        loop, fitted = float(2.0 * part[0] + part[1]), np.hstack([scores, regressors])
    return _Blocks(
        noise=noise,
        scores=scores,
        fitted=np.linalg.qr(fitted / np.linalg.norm(fitted, axis=0))[0],
        size=size,
        interval=size * piece.interval,
        within=within,
        noise_floor=NOISE_FLOOR * surface.force_max,
        loop=loop,
    )


def _autocorrelation(blocks: list[_Blocks]) -> NDArray[np.float64]:
    """Return the autocorrelation at every lag of the autoregression that describes the noise of `blocks`.

    What was fitted took slow noise away with it; the autocorrelation is raised until what one then expects of the
    noise that is left is what was seen.
    """
    longest = max(b.noise.size for b in blocks)
    noisy = [b for b in blocks if b.noise @ b.noise > b.noise.size * b.noise_floor**2]
    correlation = np.zeros(longest)
    correlation[0] = 1.0
    if not noisy:
        return correlation
    highest = min(ORDER_MOST, longest // 10)
    total = float(sum(b.noise.size for b in noisy))
    seen = np.zeros(highest + 1)
    for b in noisy:
        seen += b.noise.size / total * _products(b.noise, b.noise, highest) / (b.noise @ b.noise)
    order = _order(seen, total)
    lags = seen[: order + 1]
    counts = sum(np.maximum(b.noise.size - np.arange(order + 1), 0) for b in noisy)
    for _ in range(CORRECTIONS if order else 0):
        correlation = _extended(lags, longest)
        missing = np.zeros(order + 1)
        for b in noisy:
            expected = _expected(b, correlation, order)
            missing += _products(b.noise, b.noise, order) * (expected[0] / (b.noise @ b.noise)) - expected
        lags = lags + missing / counts
        if np.abs(missing / counts).max() < CORRECTED:
            break
    if float(correlation[1:].sum()) < 0.0:
        correlation = np.zeros(longest)
        correlation[0] = 1.0
    return correlation


def _possible(correlation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the nearest autocorrelation whose spectrum is nowhere negative, of one that was corrected too far."""
    around = np.concatenate([correlation, correlation[:0:-1]])
    possible = irfft(np.maximum(rfft(around).real, 0.0), around.size)[: correlation.size]
    return np.asarray(possible / possible[0])


def _products(left: NDArray[np.float64], right: NDArray[np.float64], highest: int) -> NDArray[np.float64]:
    """Return the sums over t of left[t] . right[t + lag] for the lags 0 to `highest`."""
    return np.array([np.vdot(left[: max(left.shape[0] - lag, 0)], right[lag:]) for lag in range(highest + 1)])


def _expected(b: _Blocks, correlation: NDArray[np.float64], highest: int) -> NDArray[np.float64]:
    """Return the `_products` to expect of unit noise with `correlation`, what was fitted taken out of it."""
    count = b.noise.size
    seen = matmul_toeplitz(correlation[:count], b.fitted)
    twice = b.fitted @ (b.fitted.T @ seen)
    lags = np.arange(highest + 1)
    expected: NDArray[np.float64] = (
        np.maximum(count - lags, 0) * correlation[: highest + 1]
        - _products(b.fitted, seen, highest)
        - _products(seen, b.fitted, highest)
        + _products(b.fitted, twice, highest)
    )
    expected[0] = max(float(expected[0]), LEFT_LEAST * count)
    return expected


def _order(correlation: NDArray[np.float64], total: float) -> int:
    """Return the order of the autoregression that the Bayesian criterion chooses."""
    best, order = 0.0, 0
    for trial in range(1, correlation.size):
        coefficients = solve_toeplitz(correlation[:trial], correlation[1 : trial + 1])
        left = max(1.0 - float(coefficients @ correlation[1 : trial + 1]), 1e-12)
        criterion = total * math.log(left) + trial * math.log(total)
        if criterion < best:
            best, order = criterion, trial
    return order


def _extended(lags: NDArray[np.float64], longest: int) -> NDArray[np.float64]:
    """Return the autocorrelation continued by its autoregression to `longest` lags. One that does not fade, as between
    recordings at different levels, is slowed to a memory as long as the recording: nothing shows a longer one.
    """
    order = lags.size - 1
    coefficients = solve_toeplitz(lags[:-1], lags[1:])
    largest = float(np.abs(np.roots(np.concatenate([[1.0], -coefficients]))).max())
    slowest = 1.0 - 1.0 / longest
    if largest > slowest:
        coefficients = coefficients * (slowest / largest) ** np.arange(1, order + 1)
    correlation = np.zeros(longest)
    correlation[: order + 1] = lags / lags[0]
    for lag in range(order + 1, longest):
        correlation[lag] = coefficients @ correlation[lag - 1 : lag - order - 1 : -1]
    return correlation
