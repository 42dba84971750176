"""Where the fit of a set begins: at the drawn forms that come nearest to what is still missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.linalg import solve_triangular

from ..regressors.dataset import Dataset
from ..regressors.law import LAW
from ..regressors.signature import Signature, strengthened
from ..selection.discrepancy import Discrepancy
from .fit import Fit
from .problem import law_start, with_readings

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Addition:
    """A candidate beside a fit: values to begin at, and what it may gain in log likelihood by them."""

    name: str
    values: tuple[float, ...]
    gain: float


def additions(
    signature: Signature, missing: FloatArray, slopes: FloatArray, variance: float, dataset: Dataset
) -> list[Addition]:
    """Return the best drawn forms of a candidate for what is `missing` (m,), the likeliest first, at most two.

    slopes (m, k): of what is already fitted, which may give way; variance: V. The second one is of the other kind,
    plain or with its optional forms, where the first is not.
    """
    factor = np.linalg.cholesky(slopes.T @ slopes / variance + np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)

    def beside(columns: FloatArray) -> FloatArray:
        return np.asarray(columns - across.T @ (across @ columns))

    target = beside(missing)
    if signature.name == LAW:
        basis = signature.basis
        gram = basis.T @ beside(basis) / variance + np.eye(basis.shape[1])
        right = basis.T @ target / variance
        gain = 0.5 * float(right @ np.linalg.solve(gram, right))
        return [Addition(LAW, law_start(dataset), gain)]
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
        found.append(
            Addition(signature.name, with_readings(signature.name, scaled, dataset), float(gains[k]))
        )
        if len(kinds) == 2:
            break
    return found


def promises(signatures: Sequence[Signature], base: Fit, discrepancy: Discrepancy) -> list[float]:
    """Return the log likelihood that each candidate may gain beside a fit, by its signature; what is fitted gives way.

    Like the marginal likelihood of a set, linearised about the fit, at the best of a few sizes.
    """
    before, variance = discrepancy.profile(base.unformed)
    slopes = base.slopes
    factor = np.linalg.cholesky(slopes.T @ slopes / variance + np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)
    left = float(np.sqrt(base.unformed / base.residual.size))
    found = []
    for signature in signatures:
        columns = signature.columns - across.T @ (across @ signature.columns)
        gram, moment = columns.T @ columns, columns.T @ base.residual
        values, vectors = np.linalg.eigh(gram)
        values, turned = np.maximum(values, 0.0), vectors.T @ moment
        best = -np.inf
        for size in (0.03 * left, 0.1 * left, 0.3 * left, left, 3.0 * left, 10.0 * left):
            z = size * turned / (values * size**2 + variance)
            power = base.unformed - 2.0 * size * float(z @ turned) + size**2 * float(z @ (values * z))
            after, new = discrepancy.profile(power)
            determinant = float(np.log1p(values * size**2 / new).sum())
            best = max(best, after - before - 0.5 * determinant - 0.5 * float(z @ z))
        found.append(best)
    return found
