"""Penalised least squares in bounds: Levenberg's and Marquardt's steps on the axes of the priors.

Minimised is |r(q)|^2 / V + sum (q_i / w_i)^2. Steps are cut at the bounds; what stands at a bound and would leave it is
held for a step.
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
"""Part of the promised gain that a step must bring for the slopes to be updated only."""

TRIES = 8
"""Dampings tried before a step is given up."""

DAMPING = (1e-3, 1e-7, 1e7)
"""Damping at first, least and most."""


@dataclass(frozen=True)
class Objective:
    """residual: (k,) -> (m,); low, high, width (k,): bounds and standard deviations of the prior; variance: V."""

    residual: Callable[[FloatArray], FloatArray]
    low: FloatArray
    high: FloatArray
    width: FloatArray
    variance: float

    def cost(self, residual: FloatArray, q: FloatArray) -> float:
        """Return what is minimised."""
        return float(residual @ residual) / self.variance + float(np.sum((q / self.width) ** 2))

    def jacobian(self, q: FloatArray, at: FloatArray) -> FloatArray:
        """Return the slopes (m, k) of the residual `at` the positions q."""
        columns = []
        for i in range(q.size):
            aside = q.copy()
            aside[i] += STEP if q[i] + STEP <= self.high[i] else -STEP
            columns.append((self.residual(aside) - at) / (aside[i] - q[i]))
        return np.stack(columns, axis=1) if columns else np.zeros((at.size, 0))


@dataclass(frozen=True)
class Minimum:
    """positions (k,), the residual there (m,) and its slopes (m, k); settled: whether the last steps gained nothing."""

    positions: FloatArray
    residual: FloatArray
    jacobian: FloatArray
    settled: bool
    evaluations: int


def begun(objective: Objective, start: FloatArray) -> Minimum:
    """Return where a search begins."""
    q = np.clip(start, objective.low, objective.high)
    residual = objective.residual(q)
    return Minimum(q, residual, objective.jacobian(q, residual), False, 1 + q.size)


def minimised(objective: Objective, start: Minimum, rounds: int, enough: float) -> Minimum:
    """Return the minimum near a start; a round that gains less than `enough` (twice a log likelihood) is the last.

    Between rounds the slopes are updated by Broyden's rule (Math. Comp. 19 (1965) 577); they are taken anew by
    difference quotients where a step gains less than they promised, and at the end.
    """
    q, residual, slopes = start.positions, start.residual, start.jacobian
    cost = objective.cost(residual, q)
    damping, evaluations, settled, exact = DAMPING[0], start.evaluations, not q.size, True
    for _ in range(rounds if q.size else 0):
        step, left, new = np.zeros_like(q), residual, cost
        for _ in range(TRIES if exact else 1):
            trial = np.clip(q + _step(objective, q, residual, slopes, damping), objective.low, objective.high)
            step, left = trial - q, objective.residual(trial)
            new = objective.cost(left, trial)
            evaluations += 1
            if new < cost:
                damping = max(damping / 10.0, DAMPING[1])
                break
            damping = min(10.0 * damping, DAMPING[2])
        moved, small = new < cost, cost - new < enough
        if moved:
            foretold = residual + slopes @ step
            promised = cost - objective.cost(foretold, q + step)
            updated = slopes + np.outer((left - foretold) / float(step @ step), step)
            gained, q, residual, cost = cost - new, q + step, left, new
        if exact and small:
            settled, exact = True, not moved
            break
        if moved and not small and gained > TRUSTED * promised:
            slopes, exact = updated, False
        else:
            slopes, exact = objective.jacobian(q, residual), True
            evaluations += q.size
    if not exact:
        slopes = objective.jacobian(q, residual)
        evaluations += q.size
    return Minimum(q, residual, slopes, settled, evaluations)


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
