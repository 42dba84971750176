"""Candidates to be added to a fitted set: which of them promise most, and from which values their fit starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.linalg import solve_triangular

from ..regressors.dataset import Dataset
from ..regressors.draws import strengthened
from ..regressors.signature import LAW, Signature
from ..selection.search import Discrepancy
from .fit import Fit
from .problem import law_start, with_readings

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Addition:
    """A candidate to be added to a fit, with the values of its parameters to start from."""

    name: str
    values: tuple[float, ...]


def additions(
    signature: Signature, missing: FloatArray, slopes: FloatArray, variance: float, dataset: Dataset
) -> list[Addition]:
    """Return the drawn responses of a candidate that follow the residual `missing` (m,) best, at most two, best first.

    The second one is of the other kind than the first: without or with optional parameters.
    slopes (m, k): of the parameters already fitted, which are refitted linearly; variance: V
    """
    factor = np.linalg.cholesky(slopes.T @ slopes / variance + np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)

    def beside(columns: FloatArray) -> FloatArray:
        return np.asarray(columns - across.T @ (across @ columns))

    if signature.name == LAW:
        return [Addition(LAW, law_start(dataset))]
    target = beside(missing)
    curves = signature.curves.T
    power = np.maximum(np.einsum("ij,ij->j", curves, beside(curves)), 1e-12 * curves.shape[0])
    size = curves.T @ target / power
    if not signature.signed:
        size = np.maximum(size, 0.0)
    gains = 0.5 * size**2 * power / variance
    effect = CATALOGUE[signature.name]
    found: list[Addition] = []
    kinds: set[bool] = set()
    for k in np.argsort(-gains):
        values = signature.values[k]
        optional = any(
            p.optional and p.role != "reading" and v != p.start
            for p, v in zip(effect.parameters, values, strict=True)
        )
        if optional in kinds:
            continue
        kinds.add(optional)
        factor_on = float(size[k] / signature.sizes[k]) if gains[k] > 0.0 else 0.02
        scaled = strengthened(effect, values, factor_on)
        found.append(Addition(signature.name, with_readings(signature.name, scaled, dataset)))
        if len(kinds) == 2:
            break
    return found


def predicted_gains(signatures: Sequence[Signature], base: Fit, discrepancy: Discrepancy) -> list[float]:
    """Return the gain in log likelihood that each candidate, added to a fit, should bring by its signature.

    It is the marginal likelihood linearised about the fit, whose parameters are refitted, at the best of a few sizes.
    """
    before, variance = discrepancy.profile(base.beyond_forms)
    slopes = base.slopes
    factor = np.linalg.cholesky(slopes.T @ slopes / variance + np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)
    left = float(np.sqrt(base.beyond_forms / base.residual.size))
    found = []
    for signature in signatures:
        columns = signature.columns - across.T @ (across @ signature.columns)
        gram, moment = columns.T @ columns, columns.T @ base.residual
        values, vectors = np.linalg.eigh(gram)
        values, turned = np.maximum(values, 0.0), vectors.T @ moment
        best = -np.inf
        for size in (0.03 * left, 0.1 * left, 0.3 * left, left, 3.0 * left, 10.0 * left):
            z = size * turned / (values * size**2 + variance)
            power = base.beyond_forms - 2.0 * size * float(z @ turned) + size**2 * float(z @ (values * z))
            after, new = discrepancy.profile(power)
            determinant = float(np.log1p(values * size**2 / new).sum())
            best = max(best, after - before - 0.5 * determinant - 0.5 * float(z @ z))
        found.append(best)
    return found
