"""The evidence of a fitted set: Laplace's approximation, with form errors, drift, discrepancy and the law's scales."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..selection.search import Discrepancy

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int_]


LAW_SCALES = (1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
"""Scales of a group of the law's parameters that are tried (type II), the smallest for one that is not changed."""

PASSES = 2
"""Number of rounds in which the scales of the groups are found one after the other."""

FORM_SCALES = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
"""Scales of the form errors that are tried (type II); the form error of an effect is at most the whole effect."""

DRIFT_SCALES = tuple(scale for scale in LAW_SCALES if scale <= 1.0)
"""Scales of the drift that are tried, as parts of the misfit; the smallest stands for none."""


@dataclass(frozen=True)
class Linearised:
    """A fitted set near its optimum, in units of the noise.

    residual (m,); slopes (m, k); positions (k,) on the axes of the priors
    forms: for each effect the columns (m, f) of its form errors; errors: for each effect its form error, as declared
    drift (m, d): columns of a drift of the force's zero, as large as the misfit
    groups (k,): number of the group of a parameter whose prior's scale is to be found; 0: the prior is as declared
    widths (k,): standard deviations of the priors; more than 1 for a parameter with a scale of its own
    """

    residual: FloatArray
    slopes: FloatArray
    positions: FloatArray
    forms: tuple[NDArray[np.floating], ...]
    errors: tuple[float, ...]
    drift: NDArray[np.floating]
    groups: IntArray
    widths: FloatArray


@dataclass(frozen=True)
class LaplaceEvidence:
    """log_likelihood: marginal; variance: V of the discrepancy
    scales: of the form errors of each effect; drift: of the drift
    law_scales: those of the groups of the law's parameters, by their numbers
    beyond_forms (m,): residual minus what the form errors explain of it together with the parameters, refitted to them
    and to the drift; beyond_drift (m,): minus what the drift explains too
    freedom: number of coefficients that the data determine, sum of c / (c + V) over the curvatures c
    """

    log_likelihood: float
    variance: float
    scales: FloatArray
    drift: float
    beyond_forms: FloatArray
    beyond_drift: FloatArray
    freedom: float
    law_scales: Mapping[int, float]


def laplace_evidence(fit: Linearised, discrepancy: Discrepancy) -> LaplaceEvidence:
    """Return the evidence of a fit."""
    power = float(fit.residual @ fit.residual)
    gram = fit.slopes.T @ fit.slopes
    width, law_scales = fit.widths, dict[int, float]()
    best = _parameter_evidence(power, gram, fit.positions, width, discrepancy)
    for _ in range(PASSES if fit.groups.any() else 0):
        for group in np.unique(fit.groups[fit.groups > 0]):
            for scale in LAW_SCALES:
                trial = np.where(fit.groups == group, scale, width)
                value = _parameter_evidence(power, gram, fit.positions, trial, discrepancy)
                if value[0] > best[0]:
                    best, width = value, trial
                    law_scales[int(group)] = scale
    found = _evidence_with_forms(fit, width, discrepancy)
    cost = _cost_of_scales(fit.widths)
    return replace(found, log_likelihood=found.log_likelihood - cost, law_scales=law_scales)


def _cost_of_scales(scales: FloatArray) -> float:
    """Return the cost of all scales: the log of the half-Cauchy prior density at 1 over that at the scale.

    Below 1 the density is taken as constant, so that a form as good as s or better has the probability s.
    """
    return float(np.sum(np.where(scales < 1.0, -np.log(scales), np.log1p(scales**2) - math.log(2.0))))


def _parameter_evidence(
    power: float, gram: FloatArray, positions: FloatArray, width: FloatArray, discrepancy: Discrepancy
) -> tuple[float, float]:
    """Return the evidence at given standard deviations of the prior, without form errors, at the best V."""
    variances = discrepancy.grid
    curvatures = np.maximum(np.linalg.eigvalsh(gram * np.outer(width, width)), 0.0) if width.size else width
    determinant = np.log1p(curvatures[:, None] / variances).sum(axis=0)
    prior = float(np.sum((positions / width) ** 2))
    values = -0.5 * (power / variances + prior + determinant) + discrepancy.terms
    best = int(np.argmax(values))
    return float(values[best]), float(variances[best])


def _evidence_with_forms(fit: Linearised, width: FloatArray, discrepancy: Discrepancy) -> LaplaceEvidence:
    """Return the evidence with form errors and a drift: linear coefficients beside the parameters, which are refitted.

    One scale for the forms of all effects is found first, then that of the drift and those of the effects one by one.
    """
    variances = discrepancy.grid
    k, counts = width.size, [fit.drift.shape[1], *(f.shape[1] for f in fit.forms)]
    columns = np.concatenate([fit.slopes, fit.drift, *fit.forms], axis=1)
    gram, moment = columns.T @ columns, columns.T @ fit.residual
    # The slopes are those of the residual: a step along them takes the positions the other way.
    pull = np.concatenate([-fit.positions / width, np.zeros(sum(counts))])
    power = float(fit.residual @ fit.residual)
    fixed = -0.5 * (power / variances + float(pull @ pull)) + discrepancy.terms
    # The gain that the parameters alone could still make is not counted: a fit that stopped early must not win by it.
    alone, _, _ = _linear_gain(gram[:k, :k] * np.outer(width, width), moment[:k] * width, pull[:k], variances)
    none, most = DRIFT_SCALES[0], 1.0 / np.array(fit.errors)

    def of(scales: FloatArray) -> tuple[float, FloatArray, int, FloatArray]:
        wide = np.concatenate([width, np.repeat(np.where(scales > none, scales, 0.0), counts)])
        free = np.flatnonzero(wide)  # without the columns of a drift that is none
        scaled = gram[np.ix_(free, free)] * np.outer(wide[free], wide[free])
        gained, determinant, given_way = _linear_gain(
            scaled, moment[free] * wide[free], pull[free], variances
        )
        values = fixed + 0.5 * (gained - alone - determinant)
        best = int(np.argmax(values))
        coefficients = np.zeros(wide.size)
        coefficients[free] = given_way(best) * wide[free]
        return float(values[best]) - _cost_of_scales(scales), scales, best, coefficients

    together = [np.append(none, np.minimum(scale, most)) for scale in (FORM_SCALES if fit.forms else (1.0,))]
    best = max((of(scales) for scales in together), key=lambda f: f[0])
    tried = [DRIFT_SCALES, *([s for s in FORM_SCALES if s <= m] for m in most)]
    for i, own in enumerate(tried):
        changed = (np.where(np.arange(len(counts)) == i, s, best[1]) for s in own if s != best[1][i])
        best = max((best, *map(of, changed)), key=lambda f: f[0])
    likelihood, scales, index, coefficients = best
    beyond_drift = fit.residual - columns @ coefficients
    beyond_forms = beyond_drift + fit.drift @ coefficients[k : k + counts[0]]
    variance, drift = float(variances[index]), float(scales[0]) if scales[0] > none else 0.0
    wide = np.concatenate([width, np.repeat(scales, counts)])
    freedom = _freedom(gram * np.outer(wide, wide), variance)
    return LaplaceEvidence(likelihood, variance, scales[1:], drift, beyond_forms, beyond_drift, freedom, {})


def _freedom(gram: FloatArray, variance: float) -> float:
    curvatures = np.maximum(np.linalg.eigvalsh(gram), 0.0)
    return float(np.sum(curvatures / (curvatures + variance)))


def _linear_gain(
    gram: FloatArray, moment: FloatArray, pull: FloatArray, variances: FloatArray
) -> tuple[FloatArray, FloatArray, Callable[[int], FloatArray]]:
    """Return for each V the gain of linear coefficients (twice a log likelihood), the log determinant of their
    curvature, and a function from the index of V to the coefficients.

    gram (k, k), moment (k,): normal equations; pull (k,): distance of each coefficient from the centre of its prior, in
    standard deviations
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
