"""Sets of effects, fitted with the effects' own equations and ranked by the evidence of these fits.

The sets that the signatures find likely are fitted first, and promising candidates alone, since what is likely at first
may lead astray; then the neighbours of the best sets, with one candidate removed, added or exchanged, as long as they
may win. A smaller set starts from the optimum of the larger one, a larger set from that of the smaller one, so that no
set is ranked below a part of itself.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.data_checks import MAJORITY
from ..regressors.dataset import Dataset, Samples
from ..regressors.signature import LAW, Beside, Signature, acts_on_signal, drawn_beside
from ..selection.search import LOST, MOST_CANDIDATES, PRIOR_ODDS, Discrepancy, discrepancy_of
from .additions import additions, not_followed, predicted_gains
from .fit import BARE_MENTION, LEAST_GAIN, Fit, fitted
from .held_out import HeldOutRecordings, predicted
from .problem import Values

FloatArray = NDArray[np.float64]

TEMPERATURE = 2.0
"""Tempering of the log odds between sets, for fits that stop early and forms that are not quite right."""

MOST_FITS = 80
"""Budget: number of fits of one diagnosis since the best set was last replaced by one that beats it (LOST)."""

MOST_WORK = 1.2e8
"""Budget: number of simulated blocks of one explanation, after which it ends however much it still gains: some 30 s of
a core of an x86-64 server, with which the whole command stays within 60 s."""

EVALUATION = 2000
"""Number of blocks in which a simulation takes as long as everything of an evaluation that does not grow with them."""

REPEATS = 2
"""Budget: number of fits of one set, each from the optimum of another set."""

MOST_EFFECTS = MOST_CANDIDATES + 1
"""Most effects of a fitted set: one more than the search finds."""

PROMISING = 5
"""Number of candidates added to a fitted set, those with the largest predicted gain."""

SWAPPED = PROMISING // 2
"""Number of candidates tried in place of one effect of a set."""

CORRECTIONS = 3
"""Budget: number of times that a set is fitted again with the distortion by its blocks subtracted."""

USUAL_MOVED = 1.2
"""Factor between the usual form errors or slow variances, old and new, from which on all evidence is computed again."""

GAIN_ERROR = 8.0
"""Error of a predicted gain, relative to another one: a candidate that is behind by more is not fitted."""


@dataclass(frozen=True)
class Ranking:
    """Fits by their log posterior, the likeliest first; discrepancy: of their evidence; held_out: for what is added."""

    fits: tuple[Fit, ...]
    discrepancy: Discrepancy
    held_out: HeldOutRecordings | None = None

    @property
    def posteriors(self) -> tuple[float, ...]:
        """Log posterior of each fit, not normalised."""
        return tuple(fit.log_posterior for fit in self.fits)

    @property
    def best(self) -> Fit:
        """The likeliest."""
        return self.fits[0]

    def of(self, names: frozenset[str]) -> Fit | None:
        """Return the fit of a set, or None where it was not fitted."""
        return next((f for f in self.fits if frozenset(f.names) == names), None)

    def behind(self, fit: Fit) -> float:
        """Return how far a fit is behind the best, in log posterior."""
        return self.best.log_posterior - fit.log_posterior

    def weights(self) -> FloatArray:
        """Return the probability of each fit, tempered."""
        weights = np.exp((np.array(self.posteriors) - self.posteriors[0]) / TEMPERATURE)
        return np.asarray(weights / weights.sum())

    def central(self, most_behind: float) -> Fit:
        """Return the likeliest set, or one that is not further behind it than `most_behind`: with fewer effects and
        nearer to the mean response of all sets by their weights, or with more and most of the squared distance gone.

        Of effects unlike all others it has those above one half, of effects that may replace each other one of them
        (M. M. Barbieri, J. O. Berger, "Optimal predictive model selection", Ann. Stat. 32 (2004) 870-897).
        """
        left = np.stack([fit.residual for fit in self.fits])
        away = np.sum((left - self.weights() @ left) ** 2, axis=1).tolist()
        near = [p for p in zip(self.fits, away, strict=True) if self.behind(p[0]) < most_behind]
        chosen = near[0]
        while nearer := [p for p in near if p[1] < _most_away(p[0], chosen)]:
            chosen = nearer[0]
        return chosen[0]

    def inclusion(self) -> dict[str, float]:
        """Return the probability of each candidate, over all fits."""
        pairs = [(fit.names, weight) for fit, weight in zip(self.fits, self.weights().tolist(), strict=True)]
        return {
            n: float(sum(w for own, w in pairs if n in own))
            for n in sorted({n for own, _ in pairs for n in own})
        }


@dataclass
class FittedSets:
    """The sets that were fitted so far; made by `begun`, continued by `ranked`."""

    dataset: Dataset
    signatures: Mapping[str, Signature]
    noise: Discrepancy
    discrepancy: Discrepancy
    held_out: HeldOutRecordings | None
    fits: dict[frozenset[str], Fit] = field(default_factory=dict)
    others: dict[frozenset[str], Mapping[str, Signature]] = field(default_factory=dict)
    times: Counter[frozenset[str]] = field(default_factory=Counter)
    begun: set[Hashable] = field(default_factory=set)
    followed: set[frozenset[str]] = field(default_factory=set)
    count: int = 0
    assessed: FloatArray = field(default_factory=lambda: np.zeros(2))
    assessed_at: int = 0
    gained_at: int = 0
    work: int = 0
    most_work: float = MOST_WORK

    @property
    def best_fit(self) -> Fit:
        """The likeliest so far."""
        return self.fits[self.best()]

    @property
    def spent(self) -> bool:
        """Whether as many sets as the budget allows were fitted since a decisive gain, or as much simulated."""
        return self.count - self.gained_at >= MOST_FITS or self.work >= self.most_work

    def update_discrepancy(self) -> bool:
        """Compute the evidence of all sets with the usual form error of the best one (their own would favour sets whose
        forms are declared to be good), beside the slow noise that it leaves; return whether these have changed.
        """
        if self.assessed_at == self.count:
            return False
        before, self.assessed_at = self.assessed, self.count
        self._assess(self.best_fit)
        # What is slow in the rest of the best set is no noise where another set explains it.
        least = min(filter(self._would_win, self.fits.values()), key=lambda fit: fit.slow, default=None)
        if least is not None:
            self._assess(least)
            self._assess(self.best_fit)
        return self.assessed is not before

    def _assess(self, by: Fit) -> None:
        found = np.array([by.form_error, by.slow])
        if np.all((self.assessed / USUAL_MOVED <= found) & (found <= self.assessed * USUAL_MOVED)):
            return
        self.assessed, self.discrepancy = found, self._beside(by)
        self.fits = {names: fit.with_discrepancy(self.discrepancy) for names, fit in self.fits.items()}

    def _beside(self, fit: Fit) -> Discrepancy:
        return self.noise.above(fit.form_error).beside_slow(fit.slow)

    def _would_win(self, fit: Fit) -> bool:
        """Whether a set would be ahead of the best one beside the slow noise that it leaves itself."""
        best, ratio = self.best_fit, self.assessed[1] / max(fit.slow, 1.0)
        most = 0.5 * self.noise.effective * np.log(max(ratio, 1.0))
        if ratio < USUAL_MOVED or best.log_posterior - fit.log_posterior > most:
            return False
        own = self._beside(fit)
        return fit.with_discrepancy(own).log_posterior > best.with_discrepancy(own).log_posterior

    def posterior(self, names: frozenset[str]) -> float:
        return self.fits[names].log_posterior

    def best(self) -> frozenset[str]:
        return max(self.fits, key=self.posterior)

    def fit(self, starts: Sequence[Values], variance: float) -> None:
        """Fit a set from several starts, once from the same ones."""
        if (begun := (*(tuple(s.items()) for s in starts), variance, self.discrepancy)) in self.begun:
            return
        self.begun.add(begun)
        key, best = frozenset(starts[0]), self.best_fit if self.fits else None
        wanted = -np.inf if best is None else best.without_held_out + PRIOR_ODDS * len(key)
        found = fitted(self.dataset, starts, self.discrepancy, variance, wanted)
        found, self.count = predicted(self.held_out, found), self.count + 1
        self.work += found.evaluations * (EVALUATION + found.residual.size)
        self.times[key] += 1
        if best is not None and found.log_posterior > best.log_posterior + LOST:
            self.gained_at = self.count
        pair = found, self.fits.get(key, found)
        own, kept = ((not fit.out_of_range, fit.without_held_out) for fit in pair)
        if key not in self.fits or own > kept:
            self.fits[key] = found

    def beside(self, base: Fit) -> Mapping[str, Signature]:
        """Return the signatures of all other candidates beside a fitted set: anew of those that act on its signal."""
        names = frozenset(base.names)
        if names not in self.others:
            self.others.clear()  # one set of them at a time: they are large
            to = Beside(base.tire, self.dataset.misfit - base.residual, base.residual)
            self.others[names] = {
                n: drawn_beside(s, self.dataset, to) if _depends(n, base.names) else s
                for n, s in self.signatures.items()
                if n not in names
            }
        return self.others[names]

    def add(self, base: Fit, name: str) -> None:
        """Fit a set with one more candidate, from the optimum of the smaller one."""
        if self.times[frozenset({*base.names, name})] >= REPEATS:
            return
        self.fit([{**base.values, name: values} for values in self.additions(base, name)], base.variance)

    def additions(self, base: Fit, name: str) -> list[tuple[float, ...]]:
        """Return the values from which a candidate is added to a fitted set, the best first."""
        return additions(self.beside(base)[name], base.residual, base.slopes, base.variance, self.dataset)

    def remove(self, base: Fit, name: str) -> None:
        """Fit a set without one of its candidates, from the optimum of the larger one."""
        if self.times[frozenset(base.names) - {name}] >= REPEATS:
            return
        self.fit([{n: v for n, v in base.values.items() if n != name}], base.variance)


def begun(
    dataset: Dataset,
    signatures: Sequence[Signature],
    discrepancy: Discrepancy,
    starts: Sequence[tuple[float, Mapping[str, FloatArray]]],
    held_out: HeldOutRecordings | None = None,
    most_work: float = MOST_WORK,
) -> FittedSets:
    """Return the empty set and the sets to begin with, fitted.

    starts: the latter, the likeliest first: V, and what each candidate is to explain (m,) in units of the noise
    held_out: recordings that take part in the posterior; most_work: budget in place of MOST_WORK
    """
    noise, known = discrepancy_of(dataset.misfit, 0.0), {s.name: s for s in signatures}
    sets = FittedSets(dataset, known, noise, discrepancy, held_out, most_work=most_work)
    sets.fit([{}], discrepancy.highest)
    no_slopes = np.zeros((dataset.misfit.size, 0))
    for variance, parts in starts:
        if parts and len(parts) <= MOST_EFFECTS:
            first = {n: additions(known[n], part, no_slopes, 1.0, dataset)[0] for n, part in parts.items()}
            sets.fit([first], variance)
    sets.update_discrepancy()
    return sets


def ranked(sets: FittedSets, alike: Callable[[str], Sequence[str]]) -> Ranking:
    """Return the sets that can still win, fitted and ranked; alike: effects that a motion does not tell from one."""
    sets.followed.add(nothing := frozenset[str]())
    if nothing in sets.fits:
        _fit_neighbours(sets, nothing)
    while not sets.spent:
        best = sets.posterior(sets.best())
        open_sets = [n for n in sets.fits if n not in sets.followed and sets.posterior(n) > best - LOST]
        if not open_sets:
            break
        sets.followed.add(names := max(open_sets, key=sets.posterior))
        _fit_neighbours(sets, names)
        if sets.update_discrepancy():
            sets.followed.clear()
    _refit_below_subsets(sets)
    _fit_alike(sets, sets.best_fit, alike)
    return Ranking(_in_order(sets.fits.values()), sets.discrepancy, sets.held_out)


def _fit_alike(sets: FittedSets, best: Fit, alike: Callable[[str], Sequence[str]]) -> None:
    """Fit the best set with another candidate in place of each that the motion, or what it explains, does not tell from
    it: sets that leave the same share their probability.
    """
    for name in best.names:
        if (less := sets.fits.get(frozenset(best.names) - {name})) is None:
            continue
        explained = less.residual - best.residual
        others = {n: s for n, s in sets.beside(less).items() if n not in best.names and not s.silent}
        missed = {n: not_followed(s, explained, less, best.variance) for n, s in others.items()}
        nearest = sorted((n for n in others if missed[n] < BARE_MENTION), key=missed.__getitem__)[:SWAPPED]
        for other in [n for n in others if n in nearest or n in alike(name)]:
            sets.add(less, other)


def _depends(name: str, beside: Sequence[str]) -> bool:
    """Whether a response depends on the effects beside it: it acts on their signal, or one of them on its."""
    # The law's is that of the baseline: what a ceiling or a lag makes of it is left to the fit.
    return bool(beside) and name != LAW and any(map(acts_on_signal, (name, *beside)))


def _most_away(fit: Fit, other: tuple[Fit, float]) -> float:
    """Return the squared distance below which a set takes the place of another one at its distance, 0 for never."""
    names, replaced = fit.hypotheses, other[0].hypotheses
    return other[1] if names < replaced else MAJORITY * other[1] if names > replaced else 0.0


def _in_order(fits: Iterable[Fit]) -> tuple[Fit, ...]:
    return tuple(sorted(fits, key=lambda f: -f.log_posterior))


def with_parts(ranking: Ranking, fit: Fit) -> Ranking:
    """Return the ranking with each set fitted that lacks one candidate of a fit, to know what the candidate explains.

    The search may have ended before it fitted them; else the same ranking is returned.
    """
    found = []
    for name in fit.names:
        if ranking.of(frozenset(fit.names) - {name}) is None:
            start = [{n: v for n, v in fit.values.items() if n != name}]
            less = fitted(fit.problem.dataset, start, ranking.discrepancy, fit.variance, -np.inf)
            found.append(predicted(ranking.held_out, less))
    return replace(ranking, fits=_in_order([*ranking.fits, *found])) if found else ranking


def corrected(ranking: Ranking, samples: Samples) -> Ranking:
    """Return the ranking in which every set that can still win, and every part of it, is fitted to the samples.

    The distortion of the response by averaging over blocks is computed at the optimum and subtracted, and the fit is
    repeated: a deferred correction (H. J. Stetter, "The defect correction principle and discretization methods", Numer.
    Math. 29 (1978) 425-443). Parts are included because an effect may have been added only to follow this distortion.
    """
    winning = [frozenset(f.names) for f in ranking.fits if ranking.behind(f) < LOST]
    found = (
        predicted(ranking.held_out, _corrected(f, samples, ranking.discrepancy))
        if any(names.issuperset(f.names) for names in winning)
        else f
        for f in ranking.fits
    )
    return replace(ranking, fits=_in_order(found))


def _corrected(fit: Fit, samples: Samples, discrepancy: Discrepancy) -> Fit:
    for _ in range(CORRECTIONS):
        dataset = fit.problem.dataset
        left_out = samples.left_out(dataset, fit.tire)
        pairs = zip(left_out, dataset.experiments, strict=True)
        new = dataset.stacked([own - e.left_out for own, e in pairs])
        if new @ new < LEAST_GAIN * fit.variance:
            break
        fit = fitted(dataset.corrected(left_out), [fit.values], discrepancy, fit.variance, np.inf)
    return fit


def _fit_neighbours(sets: FittedSets, names: frozenset[str]) -> None:
    """Fit the neighbours of a set: with one candidate removed, one added, one exchanged for another."""
    base = sets.fits[names]
    for name in sorted(names):
        sets.remove(base, name)
    if len(names) < MOST_EFFECTS:
        _add_promising(sets, names, names, PROMISING)
        # Its groups of parameters have scales of their own, which no prediction with one size knows.
        if LAW in sets.signatures.keys() - names and not sets.spent:
            sets.add(base, LAW)
    for name in sorted(names):
        _add_promising(sets, names - {name}, names, SWAPPED)


def _add_promising(sets: FittedSets, names: frozenset[str], beside: frozenset[str], most: int) -> None:
    """Add the candidates that may bring a fitted set near the best one, or that promise as much as the one they
    replace; beside: the set whose neighbours are fitted, of which none is added.
    """
    base, best = sets.fits[names], sets.posterior(sets.best())
    signatures = sets.beside(base)
    others = [n for n, s in signatures.items() if n not in beside and not s.silent]
    replaced = [n for n in signatures if n in beside - names]
    gains = predicted_gains([signatures[n] for n in (*others, *replaced)], base, sets.discrepancy)
    # A fit may gain far more than was predicted, so a prediction is compared with that of the effect it would replace.
    wanted = min([best + PRIOR_ODDS - sets.posterior(names), *gains[len(others) :]])
    # What the law promises is known of one size for all its groups: it is one more, and takes no other's place.
    law_last = sorted(zip(gains, others, strict=False), key=lambda pair: (pair[1] == LAW, -pair[0]))
    for gain, name in (p for i, p in enumerate(law_last) if i < most or p[1] == LAW):
        if gain > wanted - GAIN_ERROR and not sets.spent:
            sets.add(base, name)


def _refit_below_subsets(sets: FittedSets) -> None:
    """Fit every set again, from the optimum of a subset, that could win if it left as little as that one does.

    A gain within TEMPERATURE is what the ranking allows for fits that stop early.
    """
    for names in sorted(sets.fits, key=len):
        for subset in [n for n in sets.fits if n < names]:
            own, fit = sets.fits[names], sets.fits[subset]
            gain = sets.discrepancy.profile(fit.power)[0] - sets.discrepancy.profile(own.power)[0]
            if gain > TEMPERATURE and own.log_posterior + gain >= sets.posterior(sets.best()) - LOST:
                added = {n: sets.additions(fit, n) for n in sorted(names - subset)}
                if all(added.values()):  # beside the subset none of them is silent
                    sets.fit([{**fit.values, **{n: v[0] for n, v in added.items()}}], fit.variance)
