"""The evidence of a set of explanations: Gaussian groups of columns, each with a scale found from the data.

    y = X b + e,   b_g ~ N(0, s_g^2 I),   e ~ N(0, I / zeta)

with y and X whitened and in units of the noise, the columns of root mean square 1. The logarithm of the evidence is

    -1/2 [ zeta (y'y - m' C^-1 m) + log det(I + zeta S G S) ] - sum of log(number of scales),   G = X'X

`zeta` < 1 is the power of a coarsened posterior (Miller & Dunson, J. Am. Stat. Assoc. 114, 2019): no family is exact to
the last percent, so that more samples than its own form's error is worth do not count as more evidence.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..preprocessing.kinematics import FloatArray, IndexArray

SCALE_COST = float(np.log(8.0))
"""Price of a scale found from the data: about eight distinguishable ones between a tenth and a hundred noises."""

ROUNDS = 9
"""Fixed-point rounds for the scales (MacKay 1992); the evidence changes by less than 0.1 in the last ones."""


STANDING = 0.02
"""Relative change of every scale below which the rounds end: the evidence is flat there, it changes by the square."""


ROUNDING = 1e-9
"""Relative error of a product that is only rounding."""


@dataclass(frozen=True)
class Products:
    """What every comparison needs: products of the whitened columns and the data, in units of the noise.

    gram (k, k); moment (k,); power: y'y; samples: number of whitened samples; scale (k,): RMS of each column
    whole (k, k): the gram matrix by which sizes are told, where some directions of the data say less (see `discounted`)
    plain: for some families X'X of their columns as given, not whitened, over the square of the noise's level
    acting (k,): in how many samples each column acts, (sum |x|)^2 / sum x^2
    """

    gram: FloatArray
    moment: FloatArray
    power: float
    samples: int
    scale: FloatArray
    whole: FloatArray | None = None
    plain: Mapping[str, FloatArray] = field(default_factory=dict)
    acting: FloatArray = field(default_factory=lambda: np.zeros(0))


def products_of(columns: FloatArray, data: FloatArray) -> Products:
    """Return the products of whitened `columns` (n, k) and `data` (n,), both in units of the noise."""
    scale = np.sqrt(np.mean(columns**2, axis=0))
    scale[scale < 1e-12 * (scale.max(initial=0.0) + 1e-300)] = np.inf
    gram = columns.T @ columns / np.outer(scale, scale)
    acting = np.mean(np.abs(columns), axis=0) ** 2 / scale**2 * data.size
    return Products(gram, columns.T @ data / scale, float(data @ data), data.size, scale, acting=acting)


def discounted(p: Products, directions: FloatArray, data: FloatArray, parts: FloatArray) -> Products:
    """Return the products without those `parts` (m,) of them that lie along m directions of the samples.

    directions (m, k), data (m,): the columns and the data along them
    """
    along = directions / p.scale
    weighted = along * parts[:, None]
    return replace(
        p,
        gram=p.gram - along.T @ weighted,
        moment=p.moment - weighted.T @ data,
        power=p.power - float(parts @ data**2),
        whole=p.gram,
    )


@dataclass(frozen=True)
class Explained:
    """A set of groups and how well it explains: log evidence, chi square per sample, coefficients and contributions.

    coefficients: of the columns as given; size: root mean square of each group's contribution in units of the noise
    unique: the same of what no other group can stand for; together: that of several groups, by number, at once
    freedom: effective number of coefficients
    """

    log_evidence: float
    chi_square: float
    coefficients: tuple[FloatArray, ...]
    size: tuple[float, ...]
    unique: tuple[float, ...]
    freedom: float
    covariance: FloatArray = field(default_factory=lambda: np.zeros((0, 0)), repr=False, compare=False)
    together: Callable[[Sequence[int]], float] = field(default=lambda numbers: 0.0, repr=False, compare=False)


def explain(p: Products, groups: Sequence[IndexArray], zeta: float) -> Explained:
    """Return how well the groups of column numbers explain the data together."""
    if not groups:
        return Explained(-0.5 * zeta * p.power, p.power / p.samples, (), (), (), 0.0)
    index = np.concatenate([np.asarray(g, dtype=int) for g in groups])
    counts = np.array([len(g) for g in groups])
    ends = np.cumsum(counts)
    starts = ends - counts
    gram = zeta * p.gram[np.ix_(index, index)]
    moment = zeta * p.moment[index]
    variance = np.full(len(groups), 9.0)
    for _ in range(ROUNDS):
        precision = np.repeat(1.0 / variance, counts)
        covariance = np.linalg.inv(gram + np.diag(precision))
        mean = covariance @ moment
        taken = np.add.reduceat(np.diag(covariance), starts)
        squares = np.add.reduceat(mean**2, starts)
        known = np.maximum(counts - taken / variance, 1e-3)
        before, variance = variance, np.clip(squares / known, 1e-6, 1e8)
        if np.all(np.abs(variance - before) < STANDING * before):
            break
    precision = np.repeat(1.0 / variance, counts)
    covariance = np.linalg.inv(gram + np.diag(precision))
    mean = covariance @ moment
    root = np.sqrt(1.0 / precision)
    sign, log_determinant = np.linalg.slogdet(np.eye(index.size) + gram * np.outer(root, root))
    gain = float(moment @ mean)
    log_evidence = -0.5 * (zeta * p.power - gain + log_determinant) - SCALE_COST * len(groups)
    # More than there is, or no determinant of a positive matrix: of columns so alike only rounding is left.
    if gain > (1.0 + ROUNDING) * zeta * p.power or sign <= 0.0 or log_determinant < -ROUNDING:
        log_evidence = -np.inf
    raw = gram / zeta
    chi_square = (p.power - 2.0 * float(moment @ mean) / zeta + float(mean @ raw @ mean)) / p.samples
    free = covariance
    if p.whole is not None:  # sizes are told as they are, whatever part of the data speaks for them
        raw = p.whole[np.ix_(index, index)]
        free = np.linalg.inv(zeta * raw + np.diag(precision))
    size, unique = [], []
    for start, end in zip(starts, ends, strict=True):
        here = slice(start, end)
        size.append(float(np.sqrt(max(mean[here] @ raw[here, here] @ mean[here], 0.0) / p.samples)))
        block = np.linalg.inv(free[here, here])
        unique.append(float(np.sqrt(max(mean[here] @ (block @ mean[here]), 0.0) / zeta / p.samples)))

    def together(numbers: Sequence[int]) -> float:
        own = np.concatenate([np.arange(starts[i], ends[i]) for i in numbers])
        power = mean[own] @ np.linalg.solve(free[np.ix_(own, own)], mean[own])
        return float(np.sqrt(max(power, 0.0) / zeta / p.samples))

    split = np.split(np.where(np.isfinite(p.scale[index]), mean / p.scale[index], 0.0), ends[:-1])
    return Explained(
        float(log_evidence),
        chi_square,
        tuple(split),
        tuple(size),
        tuple(unique),
        float(np.sum(known)),
        covariance,
        together,
    )
