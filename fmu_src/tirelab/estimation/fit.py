"""The fit of one set of effects with the effects' own equations, and its evidence.

The fit is one of penalised least squares (`minimise`); its evidence follows from the optimum (`evidence`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel

from ..preprocessing.data_checks import MAJORITY
from ..regressors.dataset import Dataset
from ..regressors.signature import LAW, form_error, size_of
from ..selection.search import PRIOR_ODDS, Discrepancy, slow_variance
from .evidence import Linearised, laplace_evidence
from .forms import drifts, form_errors, smooth_functions
from .minimise import Iterate, Objective, held_at_bounds, initial_iterate, minimise
from .problem import EstimationProblem, Values, law_start, problem_of, unshaped

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int_]


LAW_LOOSE = 3.0
"""Scale of the law's prior in the first round of a fit; with the scale that the evidence finds, the fit is repeated."""

REWEIGHTINGS = 4
"""Number of times that a fit is repeated with the V and the scales of the law found by the last one."""

BARE_MENTION = 1.0
"""Log odds that are worth no more (R. E. Kass, A. E. Raftery, JASA 90 (1995) 773): of two optima of one set nearer than
that, one is taken that leaves less than half; two sets that are told apart by no more leave the same."""

OPTIONAL_GAIN = 60.0
"""Largest gain in log likelihood expected from optional parameters."""

SETTLED = (0.7, 1.5)
"""Ratio of the new V to that of a fit between which it is not repeated for it; the law's scales stay within a half."""

ROUNDS = 20
LEAST_GAIN = 0.2
"""Most rounds of a fit, and the gain (twice a log likelihood) of a round below which it ends."""


@dataclass(frozen=True)
class Fit:
    """A fitted set.

    positions (k,): of its free parameters; log_likelihood: marginal (Laplace); variance: V of the discrepancy
    residual (m,), jacobian (m, k): in units of the noise; near: the linearisation from which the evidence is computed
    scales: of the form errors of each effect; drift: scale of the drift of the force's zero
    beyond_forms: sum of squares that form errors and refitted parameters leave; beyond_drift: that a drift leaves too
    slow: V of what is slow in that
    sizes: root mean square of the response that each effect adds to the others, by its name
    evaluations: simulations of all dataset's blocks that it took, from all its starts
    law_scales: of the groups of the law's parameters, where not that of their priors
    held_out_residual (h,): on held-out recordings, in units of the noise; log_predictive: its log likelihood
    beyond: effects of which the recordings ask more than they can be, such as a lag of seconds of a load cell
    plain: the set with the measured shape of a tire's law, where this fit has another one
    """

    problem: EstimationProblem
    positions: FloatArray
    log_likelihood: float
    variance: float
    residual: FloatArray
    jacobian: FloatArray
    near: Linearised
    scales: FloatArray
    drift: float
    beyond_forms: float
    beyond_drift: float
    slow: float
    sizes: Mapping[str, float]
    evaluations: int
    law_scales: Mapping[int, float] = field(default_factory=dict)
    held_out_residual: FloatArray = field(default_factory=lambda: np.zeros(0))
    log_predictive: float = 0.0
    beyond: tuple[str, ...] = ()
    plain: Fit | None = None

    @property
    def out_of_range(self) -> bool:
        """Whether one of its effects would have to be more than it can be."""
        return bool(self.beyond)

    @property
    def likelier_shape(self) -> Fit:
        """This fit, or that with the measured shape of a tire's law, if it is no less likely."""
        return self if self.plain is None else max(self.plain, self, key=_log_posterior)

    @property
    def without_held_out(self) -> float:
        """The log posterior on the fitted recordings alone, with the likelier shape, whatever its effects can be."""
        return _log_posterior(self.likelier_shape)

    @property
    def in_any_range(self) -> float:
        """The log posterior, whatever its effects can be."""
        return self.without_held_out + self.log_predictive

    @property
    def log_posterior(self) -> float:
        """Log posterior of the set, not normalised; what is out of range is another effect's."""
        return -np.inf if self.out_of_range else self.in_any_range

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the set."""
        return self.problem.names

    @property
    def hypotheses(self) -> frozenset[str]:
        """Those of the likelier shape of its law, see `EstimationProblem.hypotheses`."""
        return self.likelier_shape.problem.hypotheses

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
        """Columns (m, k + f) of all linear coefficients: of the parameters, the form errors and the drift."""
        forms = (f * scale for f, scale in zip(self.near.forms, self.scales, strict=True))
        return np.concatenate([self.jacobian, *forms, self.drift * self.near.drift], axis=1)

    @property
    def power(self) -> float:
        """Sum of squares of the residual, in units of the noise."""
        return float(self.residual @ self.residual)

    @property
    def form_error(self) -> float:
        """Root mean square of the form errors of all its effects, in units of the noise."""
        tire = self.problem.dataset.tire
        return math.sqrt(sum((form_error(name, tire) * size) ** 2 for name, size in self.sizes.items()))

    def reading_exactly(self) -> Fit:
        """Return the fit of tires that take the deflection as exact; what is fitted has the motion without noise."""
        problem, dataset = self.problem, self.problem.dataset
        dataset = replace(dataset, tire=replace(dataset.tire, reading_noise=0.0))
        return replace(self, problem=replace(problem, dataset=dataset))

    def with_discrepancy(self, discrepancy: Discrepancy) -> Fit:
        """Return the fit with its evidence under another discrepancy."""
        evidence = laplace_evidence(self.near, discrepancy.blurred(self.problem.dataset.rounding_error))
        return replace(
            self,
            log_likelihood=evidence.log_likelihood,
            variance=evidence.variance,
            scales=evidence.scales,
            drift=evidence.drift,
            beyond_forms=float(evidence.beyond_forms @ evidence.beyond_forms),
            beyond_drift=float(evidence.beyond_drift @ evidence.beyond_drift),
            slow=slow_variance(
                self.problem.dataset.apart(evidence.beyond_drift), discrepancy.effective, evidence.freedom
            ),
            law_scales=evidence.law_scales,
            plain=None if self.plain is None else self.plain.with_discrepancy(discrepancy),
        )


def _log_posterior(fit: Fit) -> float:
    return fit.log_likelihood - PRIOR_ODDS * len(fit.problem.hypotheses)


def fitted(
    dataset: Dataset, starts: Sequence[Values], discrepancy: Discrepancy, variance: float, wanted: float
) -> Fit:
    """Return a set fitted from several starts: first without the optional parameters, then the best of these with them.

    The believed law of a part may be far from its own, as that of a tire is not: it is fitted with the usual V too, as
    if nothing were left.
    variance: V at the start; the fit is repeated where it leads to another one; wanted: a log likelihood: a fit that is
    further below it than optional parameters may gain is not refined
    """
    tried = [_optimise(problem_of(dataset, s, plain=True), s, discrepancy, variance) for s in starts]
    best = max(tried, key=lambda f: f.log_likelihood)
    whole = problem_of(dataset, best.values, plain=False)
    has_optional = len(whole.parameters) > len(best.problem.parameters)
    if has_optional and best.log_likelihood >= wanted - OPTIONAL_GAIN:
        tried.append(_optimise(whole, best.values, discrepancy, best.variance))
        best, _ = _likelier(best, tried[-1])
        if LAW in best.values and dataset.tire.two_sided:
            anew = {**best.values, LAW: law_start(dataset)}
            tried.append(_optimise(whole, anew, discrepancy, discrepancy.of_forms))
            likely, less = _likelier(best, tried[-1])
            near = likely.log_likelihood - less.log_likelihood < BARE_MENTION
            best = less if near and less.power < MAJORITY * likely.power else likely
    plain = None
    if best.problem.shaped:
        if all(f.problem.shaped for f in tried):
            start = {**best.values, LAW: unshaped(best.values[LAW])}
            tried.append(_optimise(problem_of(dataset, start, plain=True), start, discrepancy, best.variance))
        plain = max((f for f in tried if not f.problem.shaped), key=lambda f: f.log_likelihood)
    return replace(best, plain=plain, evaluations=sum(f.evaluations for f in tried))


def _likelier(first: Fit, other: Fit) -> tuple[Fit, Fit]:
    """Return two fits of one set, the likelier one first; where that is not known, since a fit ends with steps that
    gain as much, the first: optional parameters of next to no size cost nothing, but would blur all others.
    """
    gain = other.log_likelihood - first.log_likelihood
    return (other, first) if gain > 0.5 * LEAST_GAIN else (first, other)


def _optimise(problem: EstimationProblem, start: Values, discrepancy: Discrepancy, variance: float) -> Fit:
    positions = problem.positions(start, off_bounds=True)
    width = _scales(problem, {}, LAW_LOOSE) * problem.widths(positions)
    objective = Objective(problem.residual, problem.low, problem.high, width, variance)
    found = initial_iterate(objective, positions)
    best: Fit | None = None
    for _ in range(REWEIGHTINGS):
        found = minimise(objective, found, ROUNDS, LEAST_GAIN)
        fit = _with_evidence(problem, found, discrepancy)
        if best is None or fit.log_likelihood > best.log_likelihood:
            best = fit
        width = _scales(problem, fit.law_scales, 1.0) * problem.widths(found.positions)
        if SETTLED[0] < fit.variance / objective.variance < SETTLED[1] and np.allclose(
            width, objective.width, rtol=0.5
        ):
            break
        objective = replace(objective, variance=fit.variance, width=width)
    assert best is not None
    return best


def _scales(problem: EstimationProblem, found: Mapping[int, float], other: float) -> FloatArray:
    """Return the scales (k,) of the priors during a fit: those found for groups of the law's parameters, else `other`.

    Where a law can follow what an effect does, a looser prior than that of the evidence would leave the fit anywhere
    between the two, and the evidence would then call the law unlikely.
    """
    return np.array([found.get(int(group), other) if group else 1.0 for group in problem.groups])


def _with_evidence(problem: EstimationProblem, found: Iterate, discrepancy: Discrepancy) -> Fit:
    curves = problem.curves(found.positions)
    forms = form_errors(curves, problem.dataset, smooth_functions(problem.dataset))
    held = held_at_bounds(found, problem.low, problem.high)
    near = Linearised(
        found.residual,
        found.jacobian[:, ~held] if held.any() else found.jacobian,
        found.positions[~held],
        # Most of a fit's memory: seven digits are enough for what is known to one.
        tuple(f.astype(np.float32) for f in forms.values()),
        tuple(form_error(name, problem.dataset.tire) for name in forms),
        drifts(problem.dataset).astype(np.float32),
        problem.groups[~held],
        problem.widths(found.positions)[~held],
    )
    fit = Fit(
        problem,
        found.positions,
        -np.inf,
        1.0,
        found.residual,
        found.jacobian,
        near,
        np.ones(len(forms)),
        1.0,
        np.inf,
        np.inf,
        1.0,
        {name: size_of(curve) for name, curve in curves.items()},
        found.evaluations,
        beyond=_beyond(problem, held, found.positions),
    )
    return fit.with_discrepancy(discrepancy)


def _beyond(problem: EstimationProblem, held: NDArray[np.bool_], positions: FloatArray) -> tuple[str, ...]:
    """Return the effects with a strength held (k,) at a limit of its valid range, other than where they vanish."""
    found = []
    for i in (i for i in np.flatnonzero(held) if problem.parameters[i].owner != LAW):
        free = problem.parameters[i]
        parameter = CATALOGUE[free.owner].parameters[free.index]
        limit = parameter.minimum if positions[i] <= free.low else parameter.maximum
        if parameter.role == "strength" and parameter.neutral != limit:
            found.append(free.owner)
    return tuple(dict.fromkeys(found))
