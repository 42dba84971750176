"""Search over sets of candidates by the marginal likelihood of their signatures: a beam, one candidate at a time.

The likelihood is linear in Gaussian coefficients, so known in closed form:

    misfit = sum_i s_i (m_i + A_i z_i) + discrepancy + noise,   z ~ N(0, 1)

s_i is the size of candidate i, V the variance of the discrepancy: both are found by the marginal likelihood (type II).

A form that is not quite right leaves something smooth: over n blocks it has about e effective samples (e << n). In
units of the noise each of them has the variance V = 1 + n tau^2 / e, with tau the root mean square of the discrepancy.
What the set leaves beyond the noise lies in these e samples, so with a residual of the sum of squares q

    2 ln p(V) = -(q - (n - e)) / V - e ln V,

highest at V = (q - (n - e)) / e: a set is priced by e ln(what it leaves). V is a number of every set, found by the
marginal likelihood. What forms usually miss, f, follows from their measured errors. They may also be better: the
density of a miss is flat below f, so one of tau or less has the chance tau / f, which is the price of a smaller V. A
set that leaves far less than f has good forms, for wrong ones do not meet there by chance. Below the noise one miss is
like another.

M. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63, 425 (2001); J. Brynjarsdottir, A. O'Hagan, Inverse Problems 30 (2014).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import minimize

from ..regressors.signature import Signature

FloatArray = NDArray[np.float64]


EFFECTIVE = 30.0
"""Effective samples of a discrepancy. What is left of recorded dampers has 30 to 60 by its autocorrelation, of pistons
100 to 200; more than 30 let many a set win over a simpler one."""

LIKE_NOISE = 1.0
"""Root mean square of a remainder like the noise, in units of it: forms that leave no more are taken for exact."""

GRID = 40
"""Variances that are tried."""


@dataclass(frozen=True)
class Discrepancy:
    """samples: n; effective: e; usual: V of what forms usually miss, highest: V of the whole misfit
    exact: V of a remainder like the noise; where that is less than the usual V, it is the lowest.
    """

    samples: int
    effective: float
    usual: float
    highest: float
    exact: float = math.inf

    @property
    def lowest(self) -> float:
        """The lowest V."""
        return min(self.exact, self.usual)

    def beside(self, variance: FloatArray) -> FloatArray:
        """Return what the log likelihood holds beside -q / 2V, for several V: with the price of a V below the usual."""
        e = self.effective
        flat = 0.5 * (self.samples - e) / variance - 0.5 * e * np.log(variance)
        missed = np.minimum(variance, self.usual) - 1.0
        return np.asarray(flat + 0.5 * np.log(missed / (self.usual - 1.0)) if self.usual > 1.0 else flat)

    def likelihood(self, power: float, variance: float) -> float:
        """Return the log likelihood of a sum of squares left at one V."""
        return -0.5 * power / variance + float(self.beside(np.array(variance)))

    def above(self, form_error: float) -> Discrepancy:
        """Return the discrepancy of a set whose forms usually miss this much, a root mean square in units of the
        noise.
        """
        usual = self.usual + self._of(form_error)
        return replace(self, usual=usual, highest=max(self.highest, 2.0 * usual))

    def blurred(self, error: float) -> Discrepancy:
        """Return the discrepancy where the reading adds this much whatever the forms are, in units of the noise."""
        return replace(self.above(error), exact=self.exact + self._of(error))

    def grid(self) -> FloatArray:
        """Variances V to try: from the lowest to the highest."""
        return np.geomspace(self.lowest, self.highest, GRID)

    def profile(self, power: float) -> tuple[float, float]:
        """Return the log likelihood of a sum of squares left at its best V, and that V.

        Above the usual V it is highest where e V = q', with q' = q - (n - e); below it, where the price has the slope
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
        """Return what a root mean square in units of the noise adds to V."""
        return error**2 * self.samples / self.effective


def beside_noise(samples: int) -> Discrepancy:
    """Return the discrepancy's law over so many samples where nothing is missed but what forms are said to miss."""
    effective = min(EFFECTIVE, samples / 3.0)
    return Discrepancy(samples, effective, 1.0, math.inf, 1.0 + LIKE_NOISE**2 * samples / effective)


def discrepancy_of(misfit: FloatArray, missed: float) -> Discrepancy:
    """Return the discrepancy's law for a misfit (n,) in units of the noise; missed: part of it by forms."""
    law, power = beside_noise(misfit.size), float(misfit @ misfit)
    usual = 1.0 + missed**2 * max(power - law.samples, 0.0) / law.effective
    return replace(law, usual=usual, highest=max(2.0 * power / law.effective, 2.0 * usual))


def usual_form_error() -> float:
    """Return the root mean square of all form errors: what a set may miss of a misfit before its effects are known."""
    return float(np.sqrt(np.mean([effect.form_error**2 for effect in CATALOGUE.values()])))


SIZES = (0.03, 0.1, 0.3, 1.0, 3.0)
"""Sizes tried first, as parts of the misfit."""

ROUNDS = 12
NARROWEST, WIDEST = 1e-3, 100.0
"""Bounds of a size, as parts of the misfit."""


@dataclass(frozen=True)
class NormalEquations:
    """Products of all signatures' columns with each other and with the misfit.

    gram (k, k), moment (k,), power: of the misfit; places: of each candidate its columns, the mean first
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


def normal_equations(signatures: Sequence[Signature], misfit: FloatArray) -> NormalEquations:
    """Return the products of the signatures' columns."""
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
    """Return the evidence of a set, begun at the sizes of a set that shares names with it.

    polish: whether sizes and variance are climbed to the top; else the best of a few are taken
    """
    known = dict(zip(start.names, start.sizes, strict=True)) if start is not None else {}
    if not names:
        likelihoods = [discrepancy.likelihood(equations.power, float(v)) for v in discrepancy.grid()]
        best = int(np.argmax(likelihoods))
        return Evidence((), float(likelihoods[best]), (), float(discrepancy.grid()[best]))
    unit = math.sqrt(equations.power / discrepancy.samples)
    begin = start.variance if start is not None else 0.25 * discrepancy.highest
    tries = []
    new = [n for n in names if n not in known]
    signs_of = [(1.0, -1.0) if equations.signed[n] and n in new else (1.0,) for n in names]
    for part, signs in itertools.product(SIZES if new else (1.0,), itertools.product(*signs_of)):
        chosen = [known.get(n, part * unit * sign) for n, sign in zip(names, signs, strict=True)]
        tries += [(chosen, max(begin / f, discrepancy.usual)) for f in (1.0, 8.0, 64.0)]
    likelihoods = [_likelihood(names, s, v, equations, discrepancy)[0] for s, v in tries]
    best = int(np.argmax(likelihoods))
    sizes, variance = tries[best]
    if not polish:
        return Evidence(tuple(names), likelihoods[best], tuple(sizes), variance)
    direction = np.sign(sizes)

    def cost(q: FloatArray) -> float:
        return -_likelihood(names, direction * np.exp(q[:-1]), math.exp(q[-1]), equations, discrepancy)[0]

    first = np.append(np.log(np.maximum(np.abs(sizes), 1e-4 * unit)), math.log(variance))
    bounds = [(math.log(NARROWEST * unit), math.log(WIDEST * unit))] * len(names)
    # Below the usual V the price has another slope: a rough ranking can do without.
    bounds.append((math.log(discrepancy.usual), math.log(discrepancy.highest)))
    answer = minimize(cost, first, method="L-BFGS-B", bounds=bounds, options={"maxiter": ROUNDS})
    found = direction * np.exp(answer.x[:-1])
    return Evidence(tuple(names), -float(answer.fun), tuple(found.tolist()), math.exp(answer.x[-1]))


def parts_of(
    evidence: Evidence, equations: NormalEquations, discrepancy: Discrepancy
) -> dict[str, FloatArray]:
    """Return what each candidate of a set explains of the misfit, in units of the noise."""
    if not evidence.names:
        return {}
    _, coefficients = _likelihood(evidence.names, evidence.sizes, evidence.variance, equations, discrepancy)
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
) -> tuple[float, FloatArray]:
    """Return the log marginal likelihood and the coefficients of the bases at their posterior mean."""
    places = [equations.places[n] for n in names]
    means = np.array([p.start for p in places])
    free = np.concatenate([np.arange(p.start + 1, p.stop) for p in places])
    scale = np.concatenate([np.full(p.stop - p.start - 1, s) for p, s in zip(places, sizes, strict=True)])
    s = np.asarray(sizes)
    gram, moment = equations.gram, equations.moment
    power = equations.power - 2.0 * s @ moment[means] + s @ gram[np.ix_(means, means)] @ s
    if not free.size:
        return discrepancy.likelihood(power, variance), np.zeros(0)
    right = scale * (moment[free] - gram[np.ix_(free, means)] @ s)
    left = scale[:, None] * gram[np.ix_(free, free)] * scale / variance
    left[np.diag_indices(free.size)] += 1.0
    factor = cholesky(left, lower=True, check_finite=False)
    z = solve_triangular(factor, right, lower=True, check_finite=False)
    remaining = power - float(z @ z) / variance
    determinant = 2.0 * float(np.log(np.diag(factor)).sum())
    mean = scale * solve_triangular(factor.T, z, lower=False, check_finite=False) / variance
    return discrepancy.likelihood(remaining, variance) - 0.5 * determinant, mean


PRIOR_ODDS = 5.0
"""What a candidate must gain in log likelihood before it is as likely as not: one of a dozen candidates is there, or
none; and it is worth naming."""

POLISHED, MOST = 8, 5
"""Sets polished among a size's candidates, candidates of a set."""

BEAM = POLISHED // 2
"""Sets kept from one size to the next."""

LOST = 10.0
"""Sets this far behind, in log posterior, do not win: a size of sets whose best is ends the search."""


@dataclass(frozen=True)
class Selection:
    """Sets by their posterior (log, not normalised), the likeliest first."""

    ranked: tuple[Evidence, ...]

    def starts(self, best: int) -> tuple[Evidence, ...]:
        """Return the `best` sets, then the best one of each size: a fit may find what the signatures miss."""
        sizes = {len(e.names): e for e in reversed(self.ranked)}
        return tuple(dict.fromkeys((*self.ranked[:best], *(sizes[k] for k in sorted(sizes)))))

    def posterior(self, evidence: Evidence) -> float:
        """Return the log posterior of a set."""
        return evidence.log_likelihood - PRIOR_ODDS * len(evidence.names)


def search(equations: NormalEquations, discrepancy: Discrepancy) -> Selection:
    """Return the sets that were visited."""
    order = {name: i for i, name in enumerate(equations.places)}
    found: dict[tuple[str, ...], Evidence] = {(): evidence_of((), equations, discrepancy)}
    frontier: list[tuple[str, ...]] = [()]

    def posterior(names: tuple[str, ...]) -> float:
        return found[names].log_likelihood - PRIOR_ODDS * len(names)

    def polished(names: tuple[str, ...], start: Evidence) -> None:
        found[names] = evidence_of(names, equations, discrepancy, start)

    for size in range(1, MOST + 1):
        rough: dict[tuple[str, ...], Evidence] = {}
        for base in frontier:
            for name in order:
                names = tuple(sorted({*base, name}, key=order.__getitem__))
                if name not in base and names not in rough:
                    rough[names] = evidence_of(names, equations, discrepancy, found[base], polish=False)
        if not rough:
            break
        best = sorted(rough, key=lambda n: -rough[n].log_likelihood)[:POLISHED]
        for names in best:
            polished(names, rough[names])
        frontier = sorted(best, key=lambda n: -posterior(n))[:BEAM]
        if size > 2:  # a candidate that came first may have been made needless since
            for names in frontier[:2]:
                for out in names:
                    less = tuple(n for n in names if n != out)
                    if less not in found:
                        polished(less, found[names])
        top = max(posterior(n) for n in found)
        if size > 2 and posterior(frontier[0]) < top - LOST:
            break
    ranked = sorted(found.values(), key=lambda e: -(e.log_likelihood - PRIOR_ODDS * len(e.names)))
    return Selection(tuple(ranked))
