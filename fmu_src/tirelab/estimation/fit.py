"""One set of effects fitted in the catalogue's own forms."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..regressors.dataset import Dataset
from ..regressors.law import form_error
from ..regressors.signature import size_of
from ..selection.discrepancy import Discrepancy
from .form_error import form_errors, smooth_functions
from .laplace import Linearised, laplace_evidence
from .least_squares import Minimum, Objective, begun, minimised
from .problem import EstimationProblem, Values, problem_of

FloatArray = NDArray[np.float64]

LAW_LOOSE = 3.0
"""Scale of the law's prior while it is fitted; the evidence finds its own."""

REWEIGHTED = 4
"""Times that a fit is repeated with the V that it led to."""

OPTIONAL_GAIN = 60.0
"""What optional forms may gain in log likelihood."""

ROUNDS = 20
ENOUGH = 0.2
"""Rounds of a fit, and the gain (twice a log likelihood) below which it ends."""


@dataclass(frozen=True)
class Fit:
    """A fitted set.

    values: of every effect; log_likelihood: marginal (Laplace); variance: V of the discrepancy
    residual (m,), jacobian (m, k): in units of the noise; near: what the evidence is made of
    forms (m, f): columns of the form errors, scaled
    unformed: sum of squares that the form errors leave, the parameters giving way
    sizes: root mean squares of what each effect adds to the others; settled: whether the fit came to rest
    """

    problem: EstimationProblem
    positions: FloatArray
    log_likelihood: float
    variance: float
    residual: FloatArray
    jacobian: FloatArray
    near: Linearised
    forms: FloatArray
    unformed: float
    sizes: Mapping[str, float]
    settled: bool
    evaluations: int

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the set."""
        return self.problem.names

    @property
    def values(self) -> dict[str, tuple[float, ...]]:
        """Values of all parameters of every effect."""
        return self.problem.values(self.positions)

    @property
    def tire(self) -> TireModel:
        """The fitted tire."""
        return self.problem.tire(self.positions)

    @property
    def slopes(self) -> FloatArray:
        """What may give way (m, k + f): the parameters, and the forms of what they size."""
        return np.concatenate([self.jacobian, self.forms], axis=1)

    @property
    def power(self) -> float:
        """Sum of squares left, in units of the noise."""
        return float(self.residual @ self.residual)

    @property
    def form_error(self) -> float:
        """Root mean square of what the forms of its effects may miss, in units of the noise."""
        return math.sqrt(sum((form_error(name) * size) ** 2 for name, size in self.sizes.items()))

    def judged(self, discrepancy: Discrepancy) -> Fit:
        """Return the fit as it is judged under another discrepancy."""
        evidence = laplace_evidence(self.near, discrepancy.blurred(self.problem.dataset.rounding_error))
        return replace(
            self,
            log_likelihood=evidence.log_likelihood,
            variance=evidence.variance,
            forms=self.near.forms * evidence.scale,
            unformed=float(evidence.unformed @ evidence.unformed),
        )


def fitted(
    dataset: Dataset, starts: Sequence[Values], discrepancy: Discrepancy, variance: float, wanted: float
) -> Fit:
    """Return a set fitted from several starts: its plain forms first, then the best of them with the optional ones.

    variance: V to begin with; the fit is repeated where its own is another; wanted: a log likelihood; what is further
    behind it than optional forms may gain is not refined
    """
    plain = [_climbed(problem_of(dataset, s, plain=True), s, discrepancy, variance) for s in starts]
    best = max(plain, key=lambda f: f.log_likelihood)
    if best.log_likelihood < wanted - OPTIONAL_GAIN:
        return best
    whole = problem_of(dataset, best.values, plain=False)
    if len(whole.parameters) == len(best.problem.parameters):
        return best
    free = _climbed(whole, best.values, discrepancy, best.variance)
    return max((best, free), key=lambda f: f.log_likelihood)


def _climbed(problem: EstimationProblem, start: Values, discrepancy: Discrepancy, variance: float) -> Fit:
    width = np.where(problem.groups > 0, LAW_LOOSE, 1.0)
    objective = Objective(problem.residual, problem.low, problem.high, width, variance)
    found = begun(objective, problem.positions(start, awake=True))
    best: Fit | None = None
    for _ in range(REWEIGHTED):
        found = minimised(objective, found, ROUNDS, ENOUGH)
        fit = _judged(problem, found, discrepancy)
        if best is None or fit.log_likelihood > best.log_likelihood:
            best = fit
        if 0.7 < fit.variance / objective.variance < 1.5:
            break
        objective = replace(objective, variance=fit.variance)
    assert best is not None
    return best


def _judged(problem: EstimationProblem, found: Minimum, discrepancy: Discrepancy) -> Fit:
    curves = problem.curves(found.positions)
    forms = form_errors(curves, problem.dataset, smooth_functions(problem.dataset))
    held = _held(problem, found)
    near = Linearised(
        found.residual, found.jacobian[:, ~held], found.positions[~held], forms, problem.groups[~held]
    )
    nothing = np.zeros((found.residual.size, 0))
    fit = Fit(
        problem,
        found.positions,
        -np.inf,
        1.0,
        found.residual,
        found.jacobian,
        near,
        nothing,
        np.inf,
        {name: size_of(curve) for name, curve in curves.items()},
        found.settled,
        found.evaluations,
    )
    return fit.judged(discrepancy)


def _held(problem: EstimationProblem, found: Minimum) -> NDArray[np.bool_]:
    """Return which parameters stand at a bound that they would leave."""
    uphill = found.jacobian.T @ found.residual
    at_low, at_high = found.positions <= problem.low, found.positions >= problem.high
    return np.asarray((at_low & (uphill > 0.0)) | (at_high & (uphill < 0.0)))
