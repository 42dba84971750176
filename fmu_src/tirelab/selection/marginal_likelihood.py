"""Marginal likelihood of a set of signatures: linear in Gaussian coefficients, so known in closed form.

    misfit = sum_i s_i (m_i + A_i z_i) + discrepancy + noise,   z ~ N(0, 1)

s_i is the size of candidate i, V the variance of the discrepancy: both are found by the marginal likelihood (type II).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import minimize

from ..regressors.signature import Signature
from .discrepancy import Discrepancy

FloatArray = NDArray[np.float64]

SIZES = (0.03, 0.1, 0.3, 1.0, 3.0)
"""Sizes tried first, as parts of the misfit."""

ROUNDS = 12
NARROWEST, WIDEST = 1e-3, 100.0
"""Bounds of a size, as parts of the misfit."""


@dataclass(frozen=True)
class NormalEquations:
    """Products of all signatures' columns with each other and with the misfit.

    gram (k, k), moment (k,), power: of the misfit; places: of each candidate its columns, the mean first
    """

    gram: FloatArray
    moment: FloatArray
    power: float
    places: Mapping[str, slice]
    signed: Mapping[str, bool]
    columns: FloatArray


@dataclass(frozen=True)
class Evidence:
    """Log marginal likelihood of a set at its best sizes (units of the noise) and variance V."""

    names: tuple[str, ...]
    log_likelihood: float
    sizes: tuple[float, ...]
    variance: float


def normal_equations(signatures: Sequence[Signature], misfit: FloatArray) -> NormalEquations:
    """Return the products of the signatures' columns."""
    columns = np.concatenate([np.empty((misfit.size, 0)), *(s.columns for s in signatures)], axis=1)
    places, begin = {}, 0
    for s in signatures:
        width = 1 + s.basis.shape[1]
        places[s.name] = slice(begin, begin + width)
        begin += width
    return NormalEquations(
        columns.T @ columns,
        columns.T @ misfit,
        float(misfit @ misfit),
        places,
        {s.name: s.signed for s in signatures},
        columns,
    )


def evidence_of(
    names: Sequence[str],
    equations: NormalEquations,
    discrepancy: Discrepancy,
    start: Evidence | None = None,
    *,
    polish: bool = True,
) -> Evidence:
    """Return the evidence of a set, begun at the sizes of a set that shares names with it.

    polish: whether sizes and variance are climbed to the top; else the best of a few are taken
    """
    known = dict(zip(start.names, start.sizes, strict=True)) if start is not None else {}
    if not names:
        likelihoods = [discrepancy.likelihood(equations.power, float(v)) for v in discrepancy.grid()]
        best = int(np.argmax(likelihoods))
        return Evidence((), float(likelihoods[best]), (), float(discrepancy.grid()[best]))
    unit = math.sqrt(equations.power / discrepancy.samples)
    begin = start.variance if start is not None else 0.25 * discrepancy.highest
    tries = []
    new = [n for n in names if n not in known]
    signs_of = [(1.0, -1.0) if equations.signed[n] and n in new else (1.0,) for n in names]
    for part, signs in itertools.product(SIZES if new else (1.0,), itertools.product(*signs_of)):
        chosen = [known.get(n, part * unit * sign) for n, sign in zip(names, signs, strict=True)]
        tries += [(chosen, max(begin / f, discrepancy.lowest)) for f in (1.0, 8.0, 64.0)]
    likelihoods = [_likelihood(names, s, v, equations, discrepancy)[0] for s, v in tries]
    best = int(np.argmax(likelihoods))
    sizes, variance = tries[best]
    if not polish:
        return Evidence(tuple(names), likelihoods[best], tuple(sizes), variance)
    direction = np.sign(sizes)

    def cost(q: FloatArray) -> float:
        return -_likelihood(names, direction * np.exp(q[:-1]), math.exp(q[-1]), equations, discrepancy)[0]

    first = np.append(np.log(np.maximum(np.abs(sizes), 1e-4 * unit)), math.log(variance))
    bounds = [(math.log(NARROWEST * unit), math.log(WIDEST * unit))] * len(names)
    bounds.append((math.log(discrepancy.lowest), math.log(discrepancy.highest)))
    answer = minimize(cost, first, method="L-BFGS-B", bounds=bounds, options={"maxiter": ROUNDS})
    found = direction * np.exp(answer.x[:-1])
    return Evidence(tuple(names), -float(answer.fun), tuple(found.tolist()), math.exp(answer.x[-1]))


def parts_of(
    evidence: Evidence, equations: NormalEquations, discrepancy: Discrepancy
) -> dict[str, FloatArray]:
    """Return what each candidate of a set explains of the misfit, in units of the noise."""
    if not evidence.names:
        return {}
    _, coefficients = _likelihood(evidence.names, evidence.sizes, evidence.variance, equations, discrepancy)
    parts, begin = {}, 0
    for name, size in zip(evidence.names, evidence.sizes, strict=True):
        place = equations.places[name]
        width = place.stop - place.start - 1
        own = np.append(size, coefficients[begin : begin + width])
        parts[name] = equations.columns[:, place] @ own
        begin += width
    return parts


def _likelihood(
    names: Sequence[str],
    sizes: Sequence[float] | FloatArray,
    variance: float,
    equations: NormalEquations,
    discrepancy: Discrepancy,
) -> tuple[float, FloatArray]:
    """Return the log marginal likelihood and the coefficients of the bases at their posterior mean."""
    places = [equations.places[n] for n in names]
    means = np.array([p.start for p in places])
    free = np.concatenate([np.arange(p.start + 1, p.stop) for p in places])
    scale = np.concatenate([np.full(p.stop - p.start - 1, s) for p, s in zip(places, sizes, strict=True)])
    s = np.asarray(sizes)
    gram, moment = equations.gram, equations.moment
    power = equations.power - 2.0 * s @ moment[means] + s @ gram[np.ix_(means, means)] @ s
    if not free.size:
        return discrepancy.likelihood(power, variance), np.zeros(0)
    right = scale * (moment[free] - gram[np.ix_(free, means)] @ s)
    left = scale[:, None] * gram[np.ix_(free, free)] * scale / variance
    left[np.diag_indices(free.size)] += 1.0
    factor = cholesky(left, lower=True, check_finite=False)
    z = solve_triangular(factor, right, lower=True, check_finite=False)
    remaining = power - float(z @ z) / variance
    determinant = 2.0 * float(np.log(np.diag(factor)).sum())
    mean = scale * solve_triangular(factor.T, z, lower=False, check_finite=False) / variance
    return discrepancy.likelihood(remaining, variance) - 0.5 * determinant, mean
