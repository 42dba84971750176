"""Penalised least squares within bounds, by the method of Levenberg and Marquardt.

It minimises |r(q)|^2 / V + sum (q_i / w_i)^2: the residual r in units of the noise, the positions q on the axes of the
priors, their standard deviations w and the variance V of noise and discrepancy. Steps are cut at the bounds; a
parameter at a bound that would leave it is held for that step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


STEP = 2e-3
"""Step of the difference quotients, in standard deviations of the prior."""

LONGEST = 1.5
"""Longest step, in standard deviations of the prior."""

TRUSTED = 0.5
"""Part of the predicted gain that a step must reach for the slopes to be updated instead of computed anew."""

TRIES = 8
"""Number of dampings tried before a step is given up."""

DAMPING, DAMPED = (1e-3, 1e-7, 1e7), 10.0
"""Damping factor: first, smallest and largest; and by how much a step changes it (D. W. Marquardt, J. SIAM 11 (1963)
431)."""


@dataclass(frozen=True)
class Objective:
    """What is minimised: residual: (k,) -> (m,); low, high, width (k,): bounds and standard deviations of the prior;
    variance: V.
    """

    residual: Callable[[FloatArray], FloatArray]
    low: FloatArray
    high: FloatArray
    width: FloatArray
    variance: float

    def cost(self, residual: FloatArray, q: FloatArray) -> float:
        """Return |r|^2 / V + sum (q_i / w_i)^2."""
        return float(residual @ residual) / self.variance + float(np.sum((q / self.width) ** 2))

    def jacobian(self, q: FloatArray, at: FloatArray) -> FloatArray:
        """Return the slopes (m, k) of the residual at the positions q, where it is `at`."""
        columns = []
        for i in range(q.size):
            aside = q.copy()
            aside[i] += STEP if q[i] + STEP <= self.high[i] else -STEP
            columns.append((self.residual(aside) - at) / (aside[i] - q[i]))
        return np.stack(columns, axis=1) if columns else np.zeros((at.size, 0))


@dataclass(frozen=True)
class Iterate:
    """positions (k,), residual (m,) and slopes (m, k) there; converged: whether the last steps gained next to
    nothing.
    """

    positions: FloatArray
    residual: FloatArray
    jacobian: FloatArray
    converged: bool
    evaluations: int


def initial_iterate(objective: Objective, start: FloatArray) -> Iterate:
    """Return the start of a minimisation, moved into the bounds."""
    q = np.clip(start, objective.low, objective.high)
    residual = objective.residual(q)
    return Iterate(q, residual, objective.jacobian(q, residual), False, 1 + q.size)


def minimise(objective: Objective, start: Iterate, rounds: int, enough: float) -> Iterate:
    """Return the minimum near a start; it ends with a round that gains less than `enough` (twice a log likelihood).

    Between rounds the slopes are updated by Broyden's rule (Math. Comp. 19 (1965) 577). They are computed anew by
    difference quotients where a step gains much less than they predicted, and before the last step, which is a short
    one: after it they are updated.
    """
    q, residual, slopes = start.positions, start.residual, start.jacobian
    cost = objective.cost(residual, q)
    damping, evaluations, converged, exact = DAMPING[0], start.evaluations, not q.size, True
    for _ in range(rounds if q.size else 0):
        step, left, new = np.zeros_like(q), residual, cost
        for _ in range(TRIES if exact else 1):
            trial = np.clip(q + _step(objective, q, residual, slopes, damping), objective.low, objective.high)
            step, left = trial - q, objective.residual(trial)
            new = objective.cost(left, trial)
            evaluations += 1
            if new < cost:
                damping = max(damping / DAMPED, DAMPING[1])
                break
            damping = min(DAMPED * damping, DAMPING[2])
        moved, small = new < cost, cost - new < enough
        if moved:
            predicted = residual + slopes @ step
            promised = cost - objective.cost(predicted, q + step)
            updated = slopes + np.outer((left - predicted) / float(step @ step), step)
            gained, q, residual, cost = cost - new, q + step, left, new
        if exact and small:
            converged, slopes = True, updated if moved else slopes
            break
        if moved and not small and gained > TRUSTED * promised:
            slopes, exact = updated, False
        else:
            slopes, exact = objective.jacobian(q, residual), True
            evaluations += q.size
    if not exact:
        slopes = objective.jacobian(q, residual)
        evaluations += q.size
    return Iterate(q, residual, slopes, converged, evaluations)


def _step(
    objective: Objective, q: FloatArray, residual: FloatArray, jacobian: FloatArray, damping: float
) -> FloatArray:
    gradient = jacobian.T @ residual / objective.variance + q / objective.width**2
    held = ((q <= objective.low) & (gradient > 0.0)) | ((q >= objective.high) & (gradient < 0.0))
    free = ~held
    step = np.zeros_like(q)
    if not free.any():
        return step
    own = jacobian[:, free]
    curvature = own.T @ own / objective.variance + np.diag(1.0 / objective.width[free] ** 2)
    curvature[np.diag_indices_from(curvature)] *= 1.0 + damping
    step[free] = -np.linalg.solve(curvature, gradient[free])
    longest = float(np.max(np.abs(step)))
    return step * min(1.0, LONGEST / longest) if longest > 0.0 else step


def held_at_bounds(found: Iterate, low: FloatArray, high: FloatArray) -> NDArray[np.bool_]:
    """Return which parameters (k,) stand at a bound, `low` or `high` (k,), beyond which the residual would fall."""
    uphill = found.jacobian.T @ found.residual
    at_low, at_high = found.positions <= low, found.positions >= high
    return np.asarray((at_low & (uphill > 0.0)) | (at_high & (uphill < 0.0)))
