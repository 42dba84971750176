"""Sets of effects ranked by what they leave when they are fitted in the catalogue's own forms.

Sets that the signatures find likely are fitted first, begun at the drawn forms that come nearest to what is still
missing. From the best of them on, one candidate is taken out and one put in in turn, as long as that may win: what is
left out begins at the optimum of the larger set, what is put in at that of the smaller one, so no set is judged worse
than its own subset.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE
from scipy.linalg import solve_triangular

from ..regressors.dataset import Dataset, Samples
from ..regressors.signature import LAW, Signature, strengthened
from ..selection.search import LOST, MOST, PRIOR_ODDS, Discrepancy, discrepancy_of
from .fit import ENOUGH, Fit, fitted
from .problem import Values, law_start, with_readings

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Addition:
    """A candidate beside a fit: values to begin at."""

    name: str
    values: tuple[float, ...]


def additions(
    signature: Signature, missing: FloatArray, slopes: FloatArray, variance: float, dataset: Dataset
) -> list[Addition]:
    """Return the best drawn forms of a candidate for what is `missing` (m,), the likeliest first, at most two.

    slopes (m, k): of what is already fitted, which may give way; variance: V. The second one is of the other kind,
    plain or with its optional forms, where the first is not.
    """
    factor = np.linalg.cholesky(slopes.T @ slopes / variance + np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)

    def beside(columns: FloatArray) -> FloatArray:
        return np.asarray(columns - across.T @ (across @ columns))

    if signature.name == LAW:
        return [Addition(LAW, law_start(dataset))]
    target = beside(missing)
    curves = signature.curves.T
    power = np.maximum(np.einsum("ij,ij->j", curves, beside(curves)), 1e-12 * curves.shape[0])
    size = curves.T @ target / power
    if not signature.signed:
        size = np.maximum(size, 0.0)
    gains = 0.5 * size**2 * power / variance
    effect = CATALOGUE[signature.name]
    found: list[Addition] = []
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
        factor_on = float(size[k] / signature.sizes[k]) if gains[k] > 0.0 else 0.02
        scaled = strengthened(effect, values, factor_on)
        found.append(Addition(signature.name, with_readings(signature.name, scaled, dataset)))
        if len(kinds) == 2:
            break
    return found


def promises(signatures: Sequence[Signature], base: Fit, discrepancy: Discrepancy) -> list[float]:
    """Return the log likelihood that each candidate may gain beside a fit, by its signature; what is fitted gives way.

    Like the marginal likelihood of a set, linearised about the fit, at the best of a few sizes.
    """
    before, variance = discrepancy.profile(base.unformed)
    slopes = base.slopes
    factor = np.linalg.cholesky(slopes.T @ slopes / variance + np.eye(slopes.shape[1]))
    across = solve_triangular(factor, slopes.T, lower=True) / np.sqrt(variance)
    left = float(np.sqrt(base.unformed / base.residual.size))
    found = []
    for signature in signatures:
        columns = signature.columns - across.T @ (across @ signature.columns)
        gram, moment = columns.T @ columns, columns.T @ base.residual
        values, vectors = np.linalg.eigh(gram)
        values, turned = np.maximum(values, 0.0), vectors.T @ moment
        best = -np.inf
        for size in (0.03 * left, 0.1 * left, 0.3 * left, left, 3.0 * left, 10.0 * left):
            z = size * turned / (values * size**2 + variance)
            power = base.unformed - 2.0 * size * float(z @ turned) + size**2 * float(z @ (values * z))
            after, new = discrepancy.profile(power)
            determinant = float(np.log1p(values * size**2 / new).sum())
            best = max(best, after - before - 0.5 * determinant - 0.5 * float(z @ z))
        found.append(best)
    return found


BEGUN = 3
"""Sets of the selection that are fitted before anything else, beside the best one of each size."""

TEMPERATURE = 2.0
"""Tempering of the posterior odds between sets: fits that stop early and forms that are not quite right."""

REACH = TEMPERATURE * LOST
"""A fitted set this far behind the best in log posterior is not followed up, as in the search but tempered."""

MOST_FITS = 40
"""Budget: fits of one diagnosis."""

REPEATS = 2
"""Budget: fits of one set, from the optima of others."""

MOST_EFFECTS = MOST + 1
"""Effects of a fitted set: one may come in beside those that a search finds."""

PROMISING = 5
"""Candidates put in beside a fitted set, the most promising first."""

SWAPPED = PROMISING // 2
"""Candidates put in the place of one of its own."""

CORRECTIONS = 3
"""Budget: times that a set is fitted again with what its blocks leave out."""

USUAL_MOVED = 1.2
"""Factor to another usual error of the forms from which on the sets are judged again."""

HOPE = 8.0
"""A promise may err by this much in log posterior, beside another promise, before it is not followed."""


@dataclass(frozen=True)
class Ranking:
    """Fits by their log posterior (not normalised), the likeliest first; discrepancy: under which they are judged."""

    fits: tuple[Fit, ...]
    posteriors: tuple[float, ...]
    discrepancy: Discrepancy

    @property
    def best(self) -> Fit:
        """The likeliest."""
        return self.fits[0]

    def of(self, names: frozenset[str]) -> Fit | None:
        """Return the fit of a set, or None where it was not fitted."""
        return next((f for f in self.fits if frozenset(f.names) == names), None)

    def behind(self, fit: Fit) -> float:
        """Return how far a fit is behind the best, in log posterior."""
        return self.posteriors[0] - next(
            p for f, p in zip(self.fits, self.posteriors, strict=True) if f is fit
        )

    def weights(self) -> FloatArray:
        """Return the probability of each fit, tempered."""
        weights = np.exp((np.array(self.posteriors) - self.posteriors[0]) / TEMPERATURE)
        return np.asarray(weights / weights.sum())

    def inclusion(self) -> dict[str, float]:
        """Return the probability of each candidate, over all fits."""
        pairs = list(zip(self.fits, self.weights().tolist(), strict=True))
        names = {name for fit in self.fits for name in fit.names}
        return {n: float(sum(w for fit, w in pairs if n in fit.names)) for n in sorted(names)}


@dataclass
class _Board:
    """What was fitted so far; only `ranked` makes and fills it."""

    dataset: Dataset
    signatures: Mapping[str, Signature]
    noise: Discrepancy
    discrepancy: Discrepancy
    fits: dict[frozenset[str], Fit] = field(default_factory=dict)
    times: Counter[frozenset[str]] = field(default_factory=Counter)
    count: int = 0
    usual: float = 0.0
    judged: int = 0

    def judge_again(self) -> bool:
        """Judge all sets under what the forms of the best one usually miss; return whether that has moved.

        One error for all sets: one of their own would favour those whose forms are thought to be good.
        """
        usual = self.fits[self.best()].form_error
        near = self.usual / USUAL_MOVED <= usual <= self.usual * USUAL_MOVED
        if self.judged == self.count or (self.judged and near):
            return False
        self.usual, self.judged = usual, self.count
        self.discrepancy = self.noise.above(usual)
        self.fits = {names: fit.judged(self.discrepancy) for names, fit in self.fits.items()}
        return True

    def posterior(self, names: frozenset[str]) -> float:
        return self.fits[names].log_likelihood - PRIOR_ODDS * len(names)

    def best(self) -> frozenset[str]:
        return max(self.fits, key=self.posterior)

    def fit(self, starts: Sequence[Values], variance: float) -> Fit:
        key = frozenset(starts[0])
        wanted = self.posterior(self.best()) + PRIOR_ODDS * len(key) if self.fits else -np.inf
        found = fitted(self.dataset, starts, self.discrepancy, variance, wanted)
        self.count += 1
        self.times[key] += 1
        if key not in self.fits or found.log_likelihood > self.fits[key].log_likelihood:
            self.fits[key] = found
        return found

    def put_in(self, base: Fit, name: str) -> None:
        """Fit a set with one more candidate, from the optimum of the smaller one."""
        if self.times[frozenset({*base.names, name})] >= REPEATS:
            return
        found = additions(self.signatures[name], base.residual, base.slopes, base.variance, self.dataset)
        self.fit([{**base.values, name: a.values} for a in found], base.variance)

    def take_out(self, base: Fit, name: str) -> None:
        """Fit a set without one of its candidates, from the optimum of the larger one."""
        if self.times[frozenset(base.names) - {name}] >= REPEATS:
            return
        self.fit([{n: v for n, v in base.values.items() if n != name}], base.variance)


def ranked(
    dataset: Dataset,
    signatures: Sequence[Signature],
    discrepancy: Discrepancy,
    starts: Sequence[tuple[float, Mapping[str, FloatArray]]],
    alike: Callable[[str], Sequence[str]],
) -> Ranking:
    """Return the sets that can still win, fitted and ranked.

    starts: sets to begin with, the likeliest first: V, and what each candidate is to explain (m,) in units of the noise
    alike: effects that the motion cannot tell from one; the best set is fitted with each of them in its place
    """
    noise = discrepancy_of(dataset.misfit, 0.0)
    board = _Board(dataset, {s.name: s for s in signatures}, noise, discrepancy)
    board.fit([{}], discrepancy.highest)
    for variance, parts in starts:
        if parts and len(parts) <= MOST_EFFECTS:
            board.fit([_start(parts, board)], variance)
    board.judge_again()
    followed: set[frozenset[str]] = set()
    while board.count < MOST_FITS:
        best = board.posterior(board.best())
        open_sets = [n for n in board.fits if n not in followed and board.posterior(n) > best - REACH]
        if not open_sets:
            break
        names = max(open_sets, key=board.posterior)
        followed.add(names)
        _follow(board, names)
        if board.judge_again():
            followed.clear()
    _nested(board)
    best_names = board.best()
    for name in sorted(best_names - {LAW}):
        less = board.fits.get(best_names - {name})
        for other in alike(name):
            if less is not None and other in board.signatures and other not in best_names:
                board.put_in(less, other)
    return _in_order(board.fits.values(), board.discrepancy)


def _in_order(fits: Iterable[Fit], discrepancy: Discrepancy) -> Ranking:
    pairs = sorted(((f.log_likelihood - PRIOR_ODDS * len(f.names), f) for f in fits), key=lambda p: -p[0])
    return Ranking(tuple(f for _, f in pairs), tuple(p for p, _ in pairs), discrepancy)


def corrected(ranking: Ranking, samples: Samples) -> Ranking:
    """Return the ranking where what can still win is fitted to the samples: what its blocks leave out is added to them.

    So is every part of it: an effect beside it may have been found for what the blocks leave out of the others.
    A deferred correction: what the blocks leave out is taken at the optimum, and the fit repeated with it. H. J.
    Stetter, "The defect correction principle and discretization methods", Numer. Math. 29 (1978) 425-443.
    """
    winning = [frozenset(f.names) for f in ranking.fits if ranking.behind(f) < LOST]
    found = (
        _corrected(f, samples, ranking.discrepancy)
        if any(names.issuperset(f.names) for names in winning)
        else f
        for f in ranking.fits
    )
    return _in_order(found, ranking.discrepancy)


def _corrected(fit: Fit, samples: Samples, discrepancy: Discrepancy) -> Fit:
    for _ in range(CORRECTIONS):
        dataset = fit.problem.dataset
        left_out = samples.left_out(dataset, fit.tire)
        pairs = zip(left_out, dataset.experiments, strict=True)
        new = dataset.stacked([own - e.left_out for own, e in pairs])
        if new @ new < ENOUGH * fit.variance:
            break
        fit = fitted(dataset.corrected(left_out), [fit.values], discrepancy, fit.variance, -np.inf)
    return fit


def _follow(board: _Board, names: frozenset[str]) -> None:
    """Fit the neighbours of a set that may win against the best: one candidate out, one in, one for another."""
    base = board.fits[names]
    for name in sorted(names):
        board.take_out(base, name)
    if len(names) < MOST_EFFECTS:
        _promising(board, names, names, PROMISING)
    for name in sorted(names):
        _promising(board, names - {name}, names, SWAPPED)


def _promising(board: _Board, names: frozenset[str], beside: frozenset[str], most: int) -> None:
    """Put in what may bring a fitted set within reach of the best, or promises as much as what it is to replace.

    beside: the set that is followed, of which nothing is put in
    """
    base, best = board.fits[names], board.posterior(board.best())
    others = [n for n in board.signatures if n not in beside]
    replaced = [n for n in board.signatures if n in beside - names]
    gains = promises([board.signatures[n] for n in (*others, *replaced)], base, board.discrepancy)
    # A fit may bring far more than its promise did, so a promise is held against that of what it would replace.
    wanted = min([best + PRIOR_ODDS - board.posterior(names), *gains[len(others) :]])
    for gain, name in sorted(zip(gains, others, strict=False), reverse=True)[:most]:
        if gain > wanted - HOPE and board.count < MOST_FITS:
            board.put_in(base, name)


def _start(parts: Mapping[str, FloatArray], board: _Board) -> dict[str, tuple[float, ...]]:
    """Return values for what each candidate is to explain."""
    none = np.zeros((board.dataset.misfit.size, 0))
    values: dict[str, tuple[float, ...]] = {}
    for name, part in parts.items():
        if name == LAW:
            values[name] = law_start(board.dataset)
            continue
        values[name] = additions(board.signatures[name], part, none, 1.0, board.dataset)[0].values
    return values


def _nested(board: _Board) -> None:
    """Fit every set again that leaves more than a subset of it."""
    for names in sorted(board.fits, key=len):
        for less in list(board.fits):
            if less < names and board.fits[less].power < 0.999 * board.fits[names].power:
                if board.posterior(names) < board.posterior(board.best()) - REACH:
                    continue
                start = dict(board.fits[less].values)
                for name in names - less:
                    own = board.fits[less]
                    if name == LAW:
                        start[name] = law_start(board.dataset)
                    else:
                        start[name] = additions(
                            board.signatures[name], own.residual, own.slopes, own.variance, board.dataset
                        )[0].values
                board.fit([start], board.fits[less].variance)
