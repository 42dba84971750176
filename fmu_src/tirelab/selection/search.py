"""Beam search over sets of candidates by the marginal likelihood of their signatures, one candidate more at a time.

The model is linear in normally distributed coefficients, so its marginal likelihood is known in closed form:

    misfit = sum_i s_i (m_i + A_i z_i) + discrepancy + noise,   z ~ N(0, 1)

The size s_i of candidate i and the variance V of noise and discrepancy maximise the marginal likelihood (type II).

The discrepancy of a form that is not quite right is smooth: over n blocks it has about e effective samples (e << n). In
units of the noise each of them has the variance V = 1 + n tau^2 / e, where tau is the root mean square of the
discrepancy. The part of the residual beyond the noise lies in these e samples, so with a sum of squares q of the
residual

    2 ln p(V) = -(q - (n - e)) / V - e ln V,

with its maximum at V = (q - (n - e)) / e. A set is thus ranked by e ln(what it leaves), and every set has its own V.
The usual discrepancy f follows from the measured form errors. It may also be smaller: below f its prior density is
constant, so that tau or less has the probability tau / f, by which a smaller V is penalised. A set that leaves far less
than f is taken to have good forms, because wrong ones would hardly fit so well by chance. Discrepancies below the noise
count alike. No V is tried below that of the slow noise, which the best set shows: its residual, summed over as many
samples as one of the e stands for, would have the variance of white noise if V = 1 were right.

M. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63, 425 (2001); J. Brynjarsdottir, A. O'Hagan, Inverse Problems 30 (2014).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from scipy.linalg.lapack import dpotrf, dtrtrs
from scipy.optimize import minimize

from ..regressors.signature import LAW, Signature, candidates, form_error

FloatArray = NDArray[np.float64]


EFFECTIVE, FEWEST_EACH = 30.0, 3.0
"""Effective samples of a discrepancy. By its autocorrelation, the residual of recorded dampers has 30 to 60 of them,
that of pistons 100 to 200; with more than 30, larger sets often win over simpler ones. And the
fewest samples for each: the noise beside it needs some."""

LIKE_NOISE = 1.0
"""Root mean square of a discrepancy, in units of the noise, up to which the forms of a set count as exact."""

MOST_TAKEN = 0.5
"""Largest part of a residual's slow sums that the parameters of its set are taken to have fitted away."""

GRID = 40
"""Number of variances V that are tried."""


@dataclass(frozen=True)
class Discrepancy:
    """The law of the discrepancy, see the docstring of the module.

    samples: n; effective: e; usual: V of the usual discrepancy f; highest: V of the whole misfit; exact: V of a
    discrepancy as large as the noise, the lowest V where it is less than the usual one; forms: the usual V without slow
    noise
    """

    samples: int
    effective: float
    usual: float
    highest: float
    exact: float = math.inf
    forms: float = math.inf

    @property
    def of_forms(self) -> float:
        """The usual V of the form errors alone, whatever slow noise lies beside them."""
        return min(self.forms, self.usual)

    @property
    def lowest(self) -> float:
        """The lowest V."""
        return min(self.exact, self.usual)

    def terms_of(self, variance: FloatArray) -> FloatArray:
        """Return the terms of the log likelihood but -q / 2V, for several V, with the penalty below the usual."""
        e = self.effective
        flat = 0.5 * (self.samples - e) / variance - 0.5 * e * np.log(variance)
        missed = np.minimum(variance, self.usual) - 1.0
        return np.asarray(flat + 0.5 * np.log(missed / (self.usual - 1.0)) if self.usual > 1.0 else flat)

    def likelihood(self, power: float, variance: float) -> float:
        """Return the log likelihood of a sum of squares left at one V."""
        return -0.5 * power / variance + float(self.terms_of(np.array(variance)))

    def above(self, form_error: float) -> Discrepancy:
        """Return the discrepancy where the usual one is larger by this form error, a root mean square in units of the
        noise.
        """
        usual = self.usual + self._of(form_error)
        return replace(self, usual=usual, highest=max(self.highest, 2.0 * usual))

    def blurred(self, error: float) -> Discrepancy:
        """Return the discrepancy where the reading adds this error to exact and to wrong forms, in units of the
        noise.
        """
        return replace(self.above(error), exact=self.exact + self._of(error))

    def beside_slow(self, variance: float) -> Discrepancy:
        """Return the discrepancy beside a slow noise of this V (see `slow_variance`), below which nothing is told."""
        usual = max(self.usual, variance)
        return replace(
            self,
            usual=usual,
            exact=max(self.exact, variance),
            highest=max(self.highest, 2.0 * usual),
            forms=self.of_forms if usual > self.usual else self.forms,
        )

    @cached_property
    def grid(self) -> FloatArray:
        """Variances V to try: from the lowest to the highest."""
        return np.geomspace(self.lowest, self.highest, GRID)

    @cached_property
    def terms(self) -> FloatArray:
        """The terms of the log likelihood (see `terms_of`) on the grid."""
        return self.terms_of(self.grid)

    def profile(self, power: float) -> tuple[float, float]:
        """Return the log likelihood of a sum of squares left at its best V, and that V.

        With q' = q - (n - e): above the usual V the maximum is at V = q' / e; below it, where the penalty has the slope
        1 / 2 (V - 1), at the larger root of (e - 1) V^2 - (q' + e) V + q' = 0.
        """
        e = self.effective
        left = power - (self.samples - e)
        tried = {min(max(left / e, self.usual), self.highest)}
        if self.lowest < self.usual:
            under = max((left + e) ** 2 - 4.0 * (e - 1.0) * left, 0.0)
            root = (left + e + math.sqrt(under)) / (2.0 * (e - 1.0))
            tried.add(min(max(root, self.lowest), self.usual))
        return max((self.likelihood(power, variance), variance) for variance in tried)

    def size(self, variance: float) -> float:
        """Return tau in units of the noise."""
        return math.sqrt(max(variance - 1.0, 0.0) * self.effective / self.samples)

    def _of(self, error: float) -> float:
        """Return the increase of V by an error, a root mean square in units of the noise."""
        return error**2 * self.samples / self.effective


def slow_variance(residuals: Sequence[FloatArray], effective: float, freedom: float) -> float:
    """Return the V of what is slow in residuals, in units of the noise: the mean square of their sums over as many
    samples as one of `effective` stands for, over the root of that number; 1 for white noise.

    freedom: of the model that left them: so many squares are missing from the mean, MOST_TAKEN of them at most
    """
    length = max(round(sum(r.size for r in residuals) / effective), 1)
    every = np.concatenate(
        [r[: r.size // length * length].reshape(-1, length).sum(axis=1) for r in residuals]
    )
    left = every.size - min(freedom, MOST_TAKEN * every.size)
    return float(every @ every) / (length * left) if every.size else 1.0


def beside_noise(samples: int) -> Discrepancy:
    """Return the discrepancy over so many samples of noise, without form errors: see `Discrepancy.above`."""
    effective = min(EFFECTIVE, samples / FEWEST_EACH)
    return Discrepancy(samples, effective, 1.0, math.inf, 1.0 + LIKE_NOISE**2 * samples / effective)


def discrepancy_of(misfit: FloatArray, missed: float) -> Discrepancy:
    """Return the discrepancy for a misfit (n,) in units of the noise; missed: usual form error, as a part of the
    misfit.
    """
    law, power = beside_noise(misfit.size), float(misfit @ misfit)
    usual = 1.0 + missed**2 * max(power - law.samples, 0.0) / law.effective
    return replace(law, usual=usual, highest=max(2.0 * power / law.effective, 2.0 * usual))


def usual_form_error(tire: TireModel) -> float:
    """Return the root mean square of all form errors of what may be missing of a tire: the usual one of a set before
    its effects are known.
    """
    return float(np.sqrt(np.mean([form_error(name, tire) ** 2 for name in (LAW, *candidates())])))


SIZES, STARTS = (0.03, 0.1, 0.3, 1.0, 3.0), (1.0, 8.0, 64.0)
"""Sizes of a candidate that are tried first, as parts of the misfit, and divisors of V: a larger set leaves less."""

ITERATIONS = 12
"""Most iterations in the maximisation of a set's marginal likelihood."""

LEAST_SIZE, MOST_SIZE = 1e-3, 100.0
"""Bounds of a size, as parts of the misfit."""


@dataclass(frozen=True)
class NormalEquations:
    """Normal equations of all signatures' columns and the misfit.

    gram (k, k); moment (k,); power: sum of squares of the misfit; places: columns of each candidate, the mean first;
    signed: whether its size may be negative; columns (n, k)
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

    @property
    def log_posterior(self) -> float:
        """Log posterior of the set, not normalised."""
        return self.log_likelihood - PRIOR_ODDS * len(self.names)


def normal_equations(signatures: Sequence[Signature], misfit: FloatArray) -> NormalEquations:
    """Return the normal equations of the signatures; misfit (n,) in units of the noise."""
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
    """Return the evidence of a set; start: evidence of a set that shares names with it, from whose sizes to start.

    polish: whether sizes and variance are optimised; else the best of a few values is taken
    """
    known = dict(zip(start.names, start.sizes, strict=True)) if start is not None else {}
    if not names:
        likelihoods = [discrepancy.likelihood(equations.power, float(v)) for v in discrepancy.grid]
        best = int(np.argmax(likelihoods))
        return Evidence((), float(likelihoods[best]), (), float(discrepancy.grid[best]))
    unit = math.sqrt(equations.power / discrepancy.samples)
    begin = start.variance if start is not None else discrepancy.highest / 4.0
    tries = []
    new = [n for n in names if n not in known]
    signs_of = [(1.0, -1.0) if equations.signed[n] and n in new else (1.0,) for n in names]
    for part, signs in itertools.product(SIZES if new else (1.0,), itertools.product(*signs_of)):
        chosen = [known.get(n, part * unit * sign) for n, sign in zip(names, signs, strict=True)]
        tries += [(chosen, max(begin / f, discrepancy.usual)) for f in STARTS]
    likelihoods = [_likelihood(names, s, v, equations, discrepancy)[0] for s, v in tries]
    best = int(np.argmax(likelihoods))
    sizes, variance = tries[best]
    if not polish:
        return Evidence(tuple(names), likelihoods[best], tuple(sizes), variance)
    direction = np.sign(sizes)

    def cost(q: FloatArray) -> float:
        return -_likelihood(names, direction * np.exp(q[:-1]), math.exp(q[-1]), equations, discrepancy)[0]

    first = np.append(np.log(np.maximum(np.abs(sizes), 1e-4 * unit)), math.log(variance))
    bounds = [(math.log(LEAST_SIZE * unit), math.log(MOST_SIZE * unit))] * len(names)
    # Below the usual V the penalty has another slope; the rough ranking of the search does not need it.
    bounds.append((math.log(discrepancy.usual), math.log(discrepancy.highest)))
    answer = minimize(cost, first, method="L-BFGS-B", bounds=bounds, options={"maxiter": ITERATIONS})
    found = direction * np.exp(answer.x[:-1])
    return Evidence(tuple(names), -float(answer.fun), tuple(found.tolist()), math.exp(answer.x[-1]))


def parts_of(
    evidence: Evidence, equations: NormalEquations, discrepancy: Discrepancy
) -> dict[str, FloatArray]:
    """Return what each candidate of a set explains of the misfit, in units of the noise."""
    if not evidence.names:
        return {}
    _, found = _likelihood(evidence.names, evidence.sizes, evidence.variance, equations, discrepancy)
    coefficients = found()
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
) -> tuple[float, Callable[[], FloatArray]]:
    """Return the log marginal likelihood, and a function for the coefficients of the bases at their posterior mean."""
    places = [equations.places[n] for n in names]
    means = np.array([p.start for p in places])
    free = np.concatenate([np.arange(p.start + 1, p.stop) for p in places])
    s = np.asarray(sizes)
    scale = np.repeat(s, [p.stop - p.start - 1 for p in places])
    gram, moment = equations.gram, equations.moment
    power = equations.power - 2.0 * s @ moment[means] + s @ gram[means][:, means] @ s
    if not free.size:
        return discrepancy.likelihood(power, variance), lambda: np.zeros(0)
    own = gram[free]
    right = scale * (moment[free] - own[:, means] @ s)
    left = scale[:, None] * own[:, free] * scale / variance
    left[np.diag_indices(free.size)] += 1.0
    # Called straight from LAPACK: these are small, and what checks them first would take longer.
    factor, _ = dpotrf(left, lower=1)
    z, _ = dtrtrs(factor, right, lower=1)
    remaining = power - float(z @ z) / variance
    determinant = 2.0 * float(np.log(np.diag(factor)).sum())
    likelihood = discrepancy.likelihood(remaining, variance) - 0.5 * determinant
    return likelihood, lambda: np.asarray(scale * dtrtrs(factor, z, lower=1, trans=1)[0] / variance)


PRIOR_ODDS = 5.0
"""Gain in log likelihood at which a candidate is as likely present as absent. It is the prior of one effect, if any,
out of a dozen candidates, with a margin so that what is named is worth naming."""

POLISHED, MOST_CANDIDATES = 8, 5
"""Number of sets of each size that are optimised, and most candidates in a set."""

BEAM = POLISHED // 2
"""Number of sets kept from one size to the next."""

LOST = 10.0
"""A set this far behind the best in log posterior cannot win any more; if no set of a size is nearer, the search
ends."""


@dataclass(frozen=True)
class Selection:
    """Evidence of sets by their log posterior (not normalised), the likeliest first."""

    ranked: tuple[Evidence, ...]

    def starts(self, best: int) -> tuple[Evidence, ...]:
        """Return the `best` sets, then the best one of each size: a fit may find what the signatures miss."""
        sizes = {len(e.names): e for e in reversed(self.ranked)}
        return tuple(dict.fromkeys((*self.ranked[:best], *(sizes[k] for k in sorted(sizes)))))


def search(equations: NormalEquations, discrepancy: Discrepancy) -> Selection:
    """Return the sets that the search visited."""
    order = {name: i for i, name in enumerate(equations.places)}
    found: dict[tuple[str, ...], Evidence] = {(): evidence_of((), equations, discrepancy)}
    frontier: list[tuple[str, ...]] = [()]

    def optimise(names: tuple[str, ...], start: Evidence) -> None:
        found[names] = evidence_of(names, equations, discrepancy, start)

    for size in range(1, MOST_CANDIDATES + 1):
        rough: dict[tuple[str, ...], Evidence] = {}
        for base, name in itertools.product(frontier, order):
            names = tuple(sorted({*base, name}, key=order.__getitem__))
            if name not in base and names not in rough:
                rough[names] = evidence_of(names, equations, discrepancy, found[base], polish=False)
        if not rough:
            break
        best = sorted(rough, key=lambda n: -rough[n].log_likelihood)[:POLISHED]
        for names in best:
            optimise(names, rough[names])
        frontier = sorted(best, key=lambda n: -found[n].log_posterior)[:BEAM]
        if size <= 2:
            continue
        # Later candidates may have made an earlier one unnecessary.
        for base, removed in ((names, name) for names in frontier[:2] for name in names):
            less = tuple(n for n in base if n != removed)
            if less not in found:
                optimise(less, found[base])
        if found[frontier[0]].log_posterior < max(e.log_posterior for e in found.values()) - LOST:
            break
    return Selection(tuple(sorted(found.values(), key=lambda e: -e.log_posterior)))
