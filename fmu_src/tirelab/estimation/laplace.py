"""The evidence of a fitted set, by Laplace's approximation, with the discrepancy and the law's scales beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..selection.discrepancy import Discrepancy

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int_]

LAW_SCALES = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
"""Scales of a group of the law's parameters that are tried (type II)."""

PASSES = 2
"""Rounds in which the groups' scales are found one after the other."""


@dataclass(frozen=True)
class LaplaceEvidence:
    """log_likelihood: marginal; variance: V of the discrepancy."""

    log_likelihood: float
    variance: float


def laplace_evidence(
    residual: FloatArray,
    jacobian: FloatArray,
    positions: FloatArray,
    groups: IntArray,
    discrepancy: Discrepancy,
) -> LaplaceEvidence:
    """Return the evidence of a fit: residual (m,), its slopes (m, k), positions (k,) on the priors' axes.

    groups (k,): numbers from 1 on of parameters whose prior has a scale to be found, 0: the prior is as declared
    """
    power = float(residual @ residual)
    gram = jacobian.T @ jacobian
    width = np.ones(positions.size)
    best = _at(power, gram, positions, width, discrepancy)
    for _ in range(PASSES if groups.any() else 0):
        for group in np.unique(groups[groups > 0]):
            for scale in LAW_SCALES:
                trial = np.where(groups == group, scale, width)
                value = _at(power, gram, positions, trial, discrepancy)
                if value.log_likelihood > best.log_likelihood:
                    best, width = value, trial
    return best


def _at(
    power: float, gram: FloatArray, positions: FloatArray, width: FloatArray, discrepancy: Discrepancy
) -> LaplaceEvidence:
    """Return the evidence at given standard deviations of the prior, at the best V."""
    scaled = gram * np.outer(width, width)
    curvatures = np.maximum(np.linalg.eigvalsh(scaled), 0.0) if width.size else np.zeros(0)
    prior = float(np.sum((positions / width) ** 2))
    variances = discrepancy.grid()
    determinant = np.log1p(curvatures[:, None] / variances).sum(axis=0)
    values = -0.5 * (power / variances + prior + determinant) + discrepancy.beside(variances)
    best = int(np.argmax(values))
    return LaplaceEvidence(float(values[best]), float(variances[best]))
