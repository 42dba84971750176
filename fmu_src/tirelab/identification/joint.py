"""One fit of a form to every sample of every recording.

    minimise  sum over surfaces g_i sum w (F - A_i x^B_i)^2,   A_i, B_i given by the form

g_i is the weight of a sample of a surface, from its noise and the autocorrelation of that. For each trial, one pass
through the samples sums the inner products of the error and its two derivatives; their triangular root replaces all
samples of the surface, so the solver sees three rows for each surface and not one for each sample, with the same sums.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .decay_search import Target, nearest
from .forms import Form, HullForm
from .noise import PowerFit
from .power_fit import inner_products
from .surfaces import Surface

Array = NDArray[np.float64]

EVALUATIONS_MOST = 200

START_PRECISION = 1e-6
"""Precision to which the fit's start is sought."""


@dataclass(frozen=True)
class JointFit:
    """What the fit found.

    logs: what the form searches (k,)
    covariance: of the logarithms of the constants (k, k), without the combinations that nothing determines
    unknown: which constants take part in such a combination (k,)
    condition: of the scaled derivatives, how much worse the worst combination of constants is known than the best
    evaluations: passes through the samples
    """

    logs: Array
    covariance: Array
    unknown: NDArray[np.bool_]
    condition: float
    evaluations: int

    @property
    def uncertainties(self) -> Array:
        """Standard uncertainties of the logarithms of the constants (k,), infinite where nothing determines them."""
        found: Array = np.where(self.unknown, np.inf, np.sqrt(np.maximum(np.diag(self.covariance), 0.0)))
        return found


def joint_fit(
    surfaces: Sequence[Surface],
    fits: Sequence[PowerFit],
    form: Form,
    start: Array,
    progress: Callable[[], None] = lambda: None,
) -> JointFit:
    """Fit `form`, from the logarithms `start` (k,), to all samples of `surfaces`, whose own fits are `fits`."""
    weights = np.array([2.0 / np.trace(fit.products @ fit.covariance) for fit in fits])
    weights /= weights.sum() * max(s.weight_sum for s in surfaces)
    if isinstance(form, HullForm):
        start = nearest(_summary(form, fits, weights), start, START_PRECISION, EVALUATIONS_MOST)
    state: dict[str, Array] = {}

    def evaluate(logs: Array) -> None:
        if "logs" in state and np.array_equal(state["logs"], logs):
            return
        pairs, by_logs = form.coefficients(logs), form.derivatives(logs)
        errors, derivatives = np.empty((len(surfaces), 3)), np.zeros((len(surfaces), 3, logs.size))
        for i, (surface, (A, B)) in enumerate(zip(surfaces, pairs.tolist(), strict=True)):
            scale = np.array([1.0, A, 1.0])
            products = weights[i] * scale[:, None] * inner_products(surface, A, B) * scale
            root = np.linalg.cholesky(products[:2, :2])
            projected = np.linalg.solve(root, products[:2, 2])
            left = max(products[2, 2] - float(projected @ projected), 0.0)
            errors[i] = *projected, np.sqrt(left)
            derivatives[i, :2] = -root.T @ by_logs[i]
        state.update(logs=logs.copy(), errors=errors.ravel(), derivatives=derivatives.reshape(-1, logs.size))
        progress()

    def errors(logs: Array) -> Array:
        evaluate(logs)
        return state["errors"]

    def derivatives(logs: Array) -> Array:
        evaluate(logs)
        return state["derivatives"]

    lower, upper = form.bounds
    found = least_squares(
        errors,
        np.clip(start, lower + 1e-9, upper - 1e-9),
        derivatives,
        bounds=(lower, upper),
        x_scale="jac",
        ftol=1e-14,
        xtol=1e-12,
        gtol=1e-15,
        max_nfev=EVALUATIONS_MOST,
    )
    return JointFit(found.x, *_covariance(form, found.x, fits, weights), int(found.nfev))


def _summary(form: HullForm, fits: Sequence[PowerFit], weights: Array) -> Target:
    """Return what the fit minimises, but for a constant, as far as the form's A and B are near the surfaces' own."""
    return Target(
        form,
        pairs=np.array([(fit.coefficient, fit.exponent) for fit in fits]),
        roots=np.stack(
            [np.linalg.cholesky(w * fit.products).T for w, fit in zip(weights, fits, strict=True)]
        ),
    )


def _covariance(
    form: Form, logs: Array, fits: Sequence[PowerFit], weights: Array
) -> tuple[Array, NDArray[np.bool_], float]:
    """Return covariance, unknown and condition of the JointFit."""
    by_logs = form.derivatives(logs)
    bread = np.zeros((logs.size, logs.size))
    meat = np.zeros_like(bread)
    for D, fit, weight in zip(by_logs, fits, weights, strict=True):
        bread += weight * D.T @ fit.products @ D
        meat += weight**2 * D.T @ fit.meat @ D
    scale = np.sqrt(np.diag(bread))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(bread / np.outer(scale, scale))
    known = values > 1e-13 * values[-1]
    inverse = (vectors[:, known] / values[known]) @ vectors[:, known].T / np.outer(scale, scale)
    combination = form.combination()
    covariance = combination @ inverse @ meat @ inverse @ combination.T
    unknown = (np.abs(combination @ vectors[:, ~known]) > 1e-6).any(axis=1)
    condition = float(np.sqrt(values[-1] / values[0])) if values[0] > 0.0 else np.inf
    return covariance, unknown, condition
