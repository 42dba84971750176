"""Candidates to be added to a fitted set: which of them promise most, and from which values their fit starts."""

from __future__ import annotations

from collections.abc import Callable, Sequence

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

PREDICTED_SIZES = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
"""Sizes of a candidate at which its gain is predicted, as parts of what is left."""

LEAST_START = 0.02
"""Part of a drawn strength from which a candidate starts that explains nothing of what is left."""


def _beside(slopes: FloatArray, variance: float) -> Callable[[FloatArray], FloatArray]:
    """Return the function that takes out of columns (m,) or (m, n) what refitted parameters follow of them.

    slopes (m, k): of these parameters; variance: V. Their products are known to rounding only, which may be more than V
    beside slopes that are large and nearly alike: nothing less than that is told apart.
    """
    gram = slopes.T @ slopes / variance
    rounding = np.finfo(float).eps * slopes.shape[0] * np.trace(gram)
    factor = np.linalg.cholesky(gram + (1.0 + rounding) * np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)
    return lambda columns: np.asarray(columns - across.T @ (across @ columns))


def additions(
    signature: Signature, missing: FloatArray, slopes: FloatArray, variance: float, dataset: Dataset
) -> list[tuple[float, ...]]:
    """Return values to start from: of the drawn responses that follow the residual `missing` (m,) best, at most two.

    The second one is of the other kind than the first: without or with optional parameters.
    slopes (m, k): of the parameters already fitted, which are refitted linearly; variance: V
    """
    if signature.name == LAW:
        return [law_start(dataset)]
    beside = _beside(slopes, variance)
    target = beside(missing)
    curves = signature.curves.T
    power = np.maximum(np.einsum("ij,ij->j", curves, beside(curves)), 1e-12 * curves.shape[0])
    size = curves.T @ target / power
    if not signature.signed:
        size = np.maximum(size, 0.0)
    gains = 0.5 * size**2 * power / variance
    effect = CATALOGUE[signature.name]
    found: list[tuple[float, ...]] = []
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
        factor_on = float(size[k] / signature.sizes[k]) if gains[k] > 0.0 else LEAST_START
        scaled = strengthened(effect, values, factor_on)
        found.append(with_readings(signature.name, scaled, dataset))
        if len(kinds) == 2:
            break
    return found


def outside(columns: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return the function that takes out of a curve (m,) what columns (m, n) follow of it, with any coefficients."""
    vectors, values, _ = np.linalg.svd(columns, full_matrices=False)
    vectors = vectors[:, values > 1e-9 * values[0]]
    return lambda curve: np.asarray(curve - vectors @ (vectors.T @ curve))


def not_followed(signature: Signature, explained: FloatArray, base: Fit, variance: float) -> float:
    """Return what a candidate, added to a fit, cannot explain at least of what another one does, `explained` (m,): a
    log likelihood at this V, of the part outside its columns and the slopes of the fit (see `Fit.slopes`).
    """
    left = outside(np.concatenate([signature.columns, base.slopes], axis=1))(explained)
    return 0.5 * float(left @ left) / variance


def followed(signature: Signature, explained: FloatArray, base: Fit) -> float:
    """Return the cosine between what an effect explains beside a fit, `explained` (m,), and the nearest response of a
    candidate, both without what the slopes of the fit follow.
    """
    asked, columns = explained, signature.columns
    if base.slopes.shape[1]:
        beside = outside(base.slopes)
        asked, columns = beside(asked), np.column_stack([beside(column) for column in columns.T])
    left, whole = outside(columns)(asked), float(asked @ asked)
    return float(np.sqrt(max(1.0 - float(left @ left) / whole, 0.0))) if whole else 0.0


def predicted_gains(signatures: Sequence[Signature], base: Fit, discrepancy: Discrepancy) -> list[float]:
    """Return the gain in log likelihood that each candidate, added to a fit, should bring by its signature.

    It is the marginal likelihood linearised about the fit, whose parameters are refitted, at the best of a few sizes.
    """
    before, variance = discrepancy.profile(base.beyond_drift)
    beside = _beside(base.slopes, variance)
    left = float(np.sqrt(base.beyond_drift / base.residual.size))
    found = []
    for signature in signatures:
        columns = beside(signature.columns)
        gram, moment = columns.T @ columns, columns.T @ base.residual
        values, vectors = np.linalg.eigh(gram)
        values, turned = np.maximum(values, 0.0), vectors.T @ moment
        best = -np.inf
        for size in (part * left for part in PREDICTED_SIZES):
            z = size * turned / (values * size**2 + variance)
            power = base.beyond_drift - 2.0 * size * float(z @ turned) + size**2 * float(z @ (values * z))
            after, new = discrepancy.profile(power)
            determinant = float(np.log1p(values * size**2 / new).sum())
            best = max(best, after - before - 0.5 * determinant - 0.5 * float(z @ z))
        found.append(best)
    return found
