"""One set of effects fitted in the catalogue's own forms, and its evidence.

The fit is penalised least squares in bounds by Levenberg's and Marquardt's steps on the axes of the priors. Minimised
is |r(q)|^2 / V + sum (q_i / w_i)^2. Steps are cut at the bounds; what stands at a bound and would leave it is held for
a step. The evidence is Laplace's approximation, with form errors, discrepancy and the law's scales.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..regressors.dataset import Dataset
from ..regressors.signature import form_error, size_of
from ..selection.search import Discrepancy
from .problem import EstimationProblem, Values, form_errors, problem_of, smooth_functions

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int_]


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


LAW_SCALES = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
"""Scales of a group of the law's parameters that are tried (type II)."""

PASSES = 2
"""Rounds in which the groups' scales are found one after the other."""

FORM_SCALES = (1.0, 3.0, 10.0, 30.0, 100.0)
"""Scales of the form errors that are tried (type II), of each effect as far as its form is still one."""


@dataclass(frozen=True)
class Linearised:
    """A fitted set near its optimum, in units of the noise.

    residual (m,); slopes (m, k); positions (k,) on the priors' axes; forms: columns (m, f) of each effect's form errors
    errors: of each form, as declared
    groups (k,): numbers from 1 on of parameters whose prior has a scale to be found, 0: the prior is as declared
    widths (k,): standard deviations of the priors; more than 1 where a parameter's own scale was found
    """

    residual: FloatArray
    slopes: FloatArray
    positions: FloatArray
    forms: tuple[FloatArray, ...]
    errors: tuple[float, ...]
    groups: IntArray
    widths: FloatArray


@dataclass(frozen=True)
class LaplaceEvidence:
    """log_likelihood: marginal; variance: V of the discrepancy; scales: of the form errors of each effect
    unformed (m,): residual less what the form errors and the parameters that give way explain of it.
    """

    log_likelihood: float
    variance: float
    scales: FloatArray
    unformed: FloatArray


def laplace_evidence(fit: Linearised, discrepancy: Discrepancy) -> LaplaceEvidence:
    """Return the evidence of a fit."""
    power = float(fit.residual @ fit.residual)
    gram = fit.slopes.T @ fit.slopes
    width = fit.widths
    best = _of_parameters(power, gram, fit.positions, width, discrepancy)
    for _ in range(PASSES if fit.groups.any() else 0):
        for group in np.unique(fit.groups[fit.groups > 0]):
            for scale in LAW_SCALES:
                trial = np.where(fit.groups == group, scale, width)
                value = _of_parameters(power, gram, fit.positions, trial, discrepancy)
                if value[0] > best[0]:
                    best, width = value, trial
    cost = _cost_of(fit.widths)
    if not fit.forms:
        return LaplaceEvidence(best[0] - cost, best[1], np.zeros(0), fit.residual)
    found = _beside_forms(fit, width, discrepancy)
    return replace(found, log_likelihood=found.log_likelihood - cost)


def _cost_of(scales: FloatArray) -> float:
    """Return what scales cost under half-Cauchy priors, beside those of 1."""
    return float(np.sum(np.log1p(scales**2) - math.log(2.0)))


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
    """Return the evidence where the form errors explain what they can, and the parameters give way to them.

    The scales of all effects are found together first, then one after the other.
    """
    variances = discrepancy.grid()
    k, counts = width.size, [f.shape[1] for f in fit.forms]
    columns = np.concatenate([fit.slopes, *fit.forms], axis=1)
    gram, moment = columns.T @ columns, columns.T @ fit.residual
    # The slopes are those of the residual: a step along them takes the positions the other way.
    pull = np.concatenate([-fit.positions / width, np.zeros(sum(counts))])
    power = float(fit.residual @ fit.residual)
    fixed = -0.5 * (power / variances + float(pull @ pull)) + discrepancy.beside(variances)
    # What the parameters alone would still gain is not counted: a fit that stopped early must not win by it.
    alone, _, _ = _gained(gram[:k, :k] * np.outer(width, width), moment[:k] * width, pull[:k], variances)
    most = 1.0 / np.array(fit.errors)

    def of(scales: FloatArray) -> tuple[float, FloatArray, int, FloatArray]:
        wide = np.concatenate([width, np.repeat(scales, counts)])
        gained, determinant, given_way = _gained(gram * np.outer(wide, wide), moment * wide, pull, variances)
        values = fixed + 0.5 * (gained - alone - determinant)
        best = int(np.argmax(values))
        return float(values[best]) - _cost_of(scales), scales, best, given_way(best) * wide

    best = max((of(np.minimum(scale, most)) for scale in FORM_SCALES), key=lambda f: f[0])
    for i in range(len(counts)) if len(counts) > 1 else ():
        own = [np.where(np.arange(len(counts)) == i, scale, best[1]) for scale in FORM_SCALES]
        best = max(
            (best, *(of(s) for s in own if s[i] <= most[i] and s[i] != best[1][i])), key=lambda f: f[0]
        )
    likelihood, scales, index, coefficients = best
    unformed = fit.residual - columns @ coefficients
    return LaplaceEvidence(likelihood, float(variances[index]), scales, unformed)


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
    sizes: root mean squares of what each effect adds to the others
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
            forms=_scaled(self.near.forms, evidence.scales, self.residual.size),
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
    loose = np.where(problem.groups > 0, LAW_LOOSE, 1.0)
    positions = problem.positions(start, awake=True)
    width = loose * problem.widths(positions)
    objective = Objective(problem.residual, problem.low, problem.high, width, variance)
    found = begun(objective, positions)
    best: Fit | None = None
    for _ in range(REWEIGHTED):
        found = minimised(objective, found, ROUNDS, ENOUGH)
        fit = _judged(problem, found, discrepancy)
        if best is None or fit.log_likelihood > best.log_likelihood:
            best = fit
        width = loose * problem.widths(found.positions)
        if 0.7 < fit.variance / objective.variance < 1.5 and np.allclose(width, objective.width, rtol=0.5):
            break
        objective = replace(objective, variance=fit.variance, width=width)
    assert best is not None
    return best


def _judged(problem: EstimationProblem, found: Minimum, discrepancy: Discrepancy) -> Fit:
    curves = problem.curves(found.positions)
    forms = form_errors(curves, problem.dataset, smooth_functions(problem.dataset))
    held = _held(problem, found)
    near = Linearised(
        found.residual,
        found.jacobian[:, ~held],
        found.positions[~held],
        tuple(forms.values()),
        tuple(form_error(name) for name in forms),
        problem.groups[~held],
        problem.widths(found.positions)[~held],
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
        found.evaluations,
    )
    return fit.judged(discrepancy)


def _scaled(forms: Sequence[FloatArray], scales: FloatArray, rows: int) -> FloatArray:
    """Return all columns (rows, f) of the form errors at their scales."""
    scaled = [f * scale for f, scale in zip(forms, scales, strict=True)]
    return np.concatenate([np.zeros((rows, 0)), *scaled], axis=1)


def _held(problem: EstimationProblem, found: Minimum) -> NDArray[np.bool_]:
    """Return which parameters stand at a bound that they would leave."""
    uphill = found.jacobian.T @ found.residual
    at_low, at_high = found.positions <= problem.low, found.positions >= problem.high
    return np.asarray((at_low & (uphill > 0.0)) | (at_high & (uphill < 0.0)))
