"""The evidence of a fitted set, by Laplace's approximation, with form errors, discrepancy and the law's scales."""

from __future__ import annotations

import math
from collections.abc import Callable
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

FORM_SCALES = (1.0, 3.0, 10.0)
"""Scales of the form errors that are tried (type II)."""


@dataclass(frozen=True)
class Linearised:
    """A fitted set near its optimum, in units of the noise.

    residual (m,); slopes (m, k); positions (k,) on the priors' axes; forms (m, f): columns of the form errors
    groups (k,): numbers from 1 on of parameters whose prior has a scale to be found, 0: the prior is as declared
    """

    residual: FloatArray
    slopes: FloatArray
    positions: FloatArray
    forms: FloatArray
    groups: IntArray


@dataclass(frozen=True)
class LaplaceEvidence:
    """log_likelihood: marginal; variance: V of the discrepancy; scale: of the form errors
    unformed (m,): residual less what the form errors and the parameters that give way explain of it.
    """

    log_likelihood: float
    variance: float
    scale: float
    unformed: FloatArray


def laplace_evidence(fit: Linearised, discrepancy: Discrepancy) -> LaplaceEvidence:
    """Return the evidence of a fit."""
    power = float(fit.residual @ fit.residual)
    own = fit.slopes.T @ fit.slopes
    width = np.ones(fit.positions.size)
    best = _of_parameters(power, own, fit.positions, width, discrepancy)
    for _ in range(PASSES if fit.groups.any() else 0):
        for group in np.unique(fit.groups[fit.groups > 0]):
            for scale in LAW_SCALES:
                trial = np.where(fit.groups == group, scale, width)
                value = _of_parameters(power, own, fit.positions, trial, discrepancy)
                if value[0] > best[0]:
                    best, width = value, trial
    if not fit.forms.size:
        return LaplaceEvidence(*best, 1.0, fit.residual)
    return _beside_forms(fit, width, discrepancy)


def _of_parameters(
    power: float, gram: FloatArray, positions: FloatArray, width: FloatArray, discrepancy: Discrepancy
) -> tuple[float, float]:
    """Return the evidence at given standard deviations of the prior, without form errors, at the best V."""
    variances = discrepancy.grid()
    curvatures = np.maximum(np.linalg.eigvalsh(gram * np.outer(width, width)), 0.0) if width.size else width
    determinant = np.log1p(curvatures[:, None] / variances).sum(axis=0)
    prior = float(np.sum((positions / width) ** 2))
    values = -0.5 * (power / variances + prior + determinant) + discrepancy.beside(variances)
    best = int(np.argmax(values))
    return float(values[best]), float(variances[best])


def _beside_forms(fit: Linearised, width: FloatArray, discrepancy: Discrepancy) -> LaplaceEvidence:
    """Return the evidence where the form errors explain what they can, and the parameters give way to them."""
    variances = discrepancy.grid()
    k = width.size
    columns = np.concatenate([fit.slopes, fit.forms], axis=1)
    gram, moment = columns.T @ columns, columns.T @ fit.residual
    # The slopes are those of the residual: a step along them takes the positions the other way.
    pull = np.concatenate([-fit.positions / width, np.zeros(fit.forms.shape[1])])
    power = float(fit.residual @ fit.residual)
    fixed = -0.5 * (power / variances + float(pull @ pull)) + discrepancy.beside(variances)
    # What the parameters alone would still gain is not counted: a fit that stopped early must not win by it.
    alone, _, _ = _gained(gram[:k, :k] * np.outer(width, width), moment[:k] * width, pull[:k], variances)
    found = []
    for scale in FORM_SCALES:
        wide = np.concatenate([width, np.full(fit.forms.shape[1], scale)])
        gained, determinant, given_way = _gained(gram * np.outer(wide, wide), moment * wide, pull, variances)
        values = fixed + 0.5 * (gained - alone - determinant)
        best = int(np.argmax(values))
        cost = math.log1p(scale**2) - math.log(2.0)
        found.append((float(values[best]) - cost, best, scale, given_way(best) * wide))
    likelihood, best, scale, coefficients = max(found, key=lambda f: f[0])
    unformed = fit.residual - columns @ coefficients
    return LaplaceEvidence(likelihood, float(variances[best]), scale, unformed)


def _gained(
    gram: FloatArray, moment: FloatArray, pull: FloatArray, variances: FloatArray
) -> tuple[FloatArray, FloatArray, Callable[[int], FloatArray]]:
    """Return for each V what linear coefficients gain (twice a log likelihood), the log determinant of their curvature,
    and the coefficients; pull: how far each already is from its prior's centre, in standard deviations.
    """
    if not moment.size:
        none = np.zeros(variances.size)
        return none, none, lambda index: moment
    values, vectors = np.linalg.eigh(gram)
    values = np.maximum(values, 0.0)
    stretched = values[:, None] + variances
    turned = (vectors.T @ moment)[:, None] - (vectors.T @ pull)[:, None] * variances
    gained = (turned**2 / stretched).sum(axis=0) / variances
    determinant = np.log(stretched / variances).sum(axis=0)
    return gained, determinant, lambda index: np.asarray(vectors @ (turned / stretched)[:, index])
