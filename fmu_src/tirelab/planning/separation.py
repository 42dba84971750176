"""With which probability a set of motions tells one effect from another, before anything is recorded.

Effect i is true, with a response c of a given size. It is compared with an alternative model M: a refitted law, perhaps
with other effects, all linear in Gaussian coefficients, f = W z with z ~ N(0, 1), as in `selection.search`. What the
alternative cannot follow of c,

    S^2 = min_z |c - W z|^2 / V + |z|^2 = c' (V + W W')^-1 c,

is twice the log likelihood ratio that is to be expected: the T-optimal criterion (A. C. Atkinson, V. V. Fedorov,
Biometrika 62, 57 (1975)), averaged over the draws of c (J. Lopez-Fidalgo et al., J. R. Stat. Soc. B 69, 231 (2007)).
V = 1 + (n + sum_k f_k^2 |c_k|^2) / e is the variance, in units of the noise, of what a diagnosis cannot explain, in e
effective samples, as in `selection.search`: n is the sum of squares of the slow part of the noise, f_k the form error
of each true effect, which are the best set's: what its forms usually miss, under which a diagnosis judges all sets
(`estimation.ranking`). Both grow with every recording, so information does not add up: what tells two effects apart is
how large it is beside what all true effects may miss, over all that is recorded.

An effect seldom acts alone. It is asked for by itself and beside each other effect, which is LOUDER times as large,
stands in the true model and in the alternative, and is refitted in the latter.

Two models of equal standing: the log likelihood ratio is normal with mean S^2/2 and variance S^2, so the right one is
the likelier one with probability Phi(S/2). An alternative within the true model, M without i: twice the ratio is
noncentral chi-squared (S. S. Wilks, Ann. Math. Stat. 9, 60 (1938); A. Wald, Trans. AMS 54, 426 (1943)) with the
noncentrality S^2 and as many degrees of freedom as forms of i can be resolved; i is named where the ratio exceeds the
prior odds and what its forms cost. An effect is named alone with at least the product of these probabilities over its
alternatives, where the ratios, all of one truth, are positively correlated (D. Slepian, Bell Syst. Tech. J. 41, 463
(1962)).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr
from scipy.stats import ncx2

from ..regressors.signature import LAW, form_error
from ..selection.search import EFFECTIVE, PRIOR_ODDS
from .responses import HELD, PRIOR_OF_GAIN, PRIOR_OF_LAW, SLOW_NOISE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

FAR = 1e4
"""Noncentrality above which the chi-squared law is a normal one to all digits that are shown."""


LOUDER = 2.5
"""An effect beside which another one is asked for is so many times as large: from the middle size of a plan's table to
its largest. Two sizes drawn evenly over the logarithm between one and thirty noises differ by 30^(1 - sqrt(1/2)) = 2.7
in the median.
"""


@dataclass(frozen=True)
class Question:
    """Whether `truth` is told from the model of the names in `alternative`; size: largest response over the peak force.

    nested: whether the alternative is the true model without `truth`, else the alternative stands in its place
    beside: an effect that acts too, LOUDER times as large, and stands in the alternative; "": none
    """

    truth: str
    alternative: frozenset[str]
    size: float
    nested: bool
    beside: str = ""


def questions_of(names: Sequence[str], size: float) -> tuple[Question, ...]:
    """Return every effect against a refitted law alone, and against every other effect beside a refitted law; and a
    refitted law against nothing and against every effect. The gain with a held pressure is part of every alternative,
    so it is asked for and is no alternative of its own.
    """
    effects = [name for name in names if name != LAW]
    alternatives = [name for name in effects if name != HELD.name]
    found = []
    for truth in effects:
        found.append(Question(truth, frozenset({LAW}), size, nested=True))
        found += [
            Question(truth, frozenset({LAW, other}), size, nested=False)
            for other in alternatives
            if other != truth
        ]
    if LAW in names:
        found.append(Question(LAW, frozenset(), size, nested=True))
        found += [Question(LAW, frozenset({other}), size, nested=False) for other in alternatives]
    return tuple(found)


def questions_beside(names: Sequence[str], size: float) -> tuple[Question, ...]:
    """Return every effect beside every other one, against that one and a refitted law."""
    effects = [name for name in names if name not in (LAW, HELD.name)]
    return tuple(
        Question(truth, frozenset({LAW, beside}), size, nested=True, beside=beside)
        for truth, beside in permutations(effects, 2)
    )


def probabilities(
    gram: FloatArray, places: Mapping[str, slice], questions: Sequence[Question]
) -> list[FloatArray]:
    """Return for each question the probability of the right answer, for each draw of its truth.

    gram (n, n): products of all columns over the motions, in units of the noise; places: of their columns
    """
    found: list[FloatArray] = [np.zeros(0)] * len(questions)
    nested: dict[int, _Gain] = {}
    groups: dict[tuple[frozenset[str], float, str, bool], list[int]] = {}
    for number, question in enumerate(questions):
        key = question.alternative, question.size, question.beside, question.truth != HELD.name
        groups.setdefault(key, []).append(number)
    for (alternative, size, beside, gain), numbers in groups.items():
        weights = _weights(alternative, size, beside, places, gram.shape[0])
        if gain and PRIOR_OF_GAIN in places:
            weights[places[PRIOR_OF_GAIN]] = 1.0
        model = _Model(gram, weights)
        own = [questions[number] for number in numbers]
        for number, answer in zip(numbers, _of(own, model, places), strict=True):
            if isinstance(answer, _Gain):
                nested[number] = answer
            else:
                found[number] = answer
    for number, answer in zip(nested, _named(list(nested.values())), strict=True):
        found[number] = answer
    return found


@dataclass(frozen=True)
class _Gain:
    """Twice the log likelihood ratio of an effect over an alternative without it, noncentral chi-squared: its
    noncentrality for each draw, its degrees of freedom, and what it has to exceed.
    """

    separation: FloatArray
    freedom: float
    needed: float


class _Model:
    """An alternative model: the eigenvalues of its columns' products, and the columns turned to their directions."""

    def __init__(self, gram: FloatArray, weights: FloatArray) -> None:
        self.gram = gram
        self.powers = np.diag(gram)
        on = np.flatnonzero(weights)
        values, vectors = np.linalg.eigh(weights[on, None] * gram[np.ix_(on, on)] * weights[on])
        self.values = np.maximum(values, 0.0)
        self.turned = vectors.T @ (weights[on, None] * gram[on])

    def left(self, columns: IntArray, variance: FloatArray) -> FloatArray:
        """Return c' (V + W W')^-1 c of each of the columns c, with its own V."""
        taken = np.sum(self.turned[:, columns] ** 2 / (variance + self.values[:, None]), axis=0)
        return np.asarray(np.maximum((self.powers[columns] - taken) / variance, 0.0))

    def between(self, place: slice, variance: float) -> FloatArray:
        """Return the products of the columns at `place` with each other, as `left` has those with themselves."""
        turned = self.turned[:, place]
        taken = turned.T @ (turned / (variance + self.values[:, None]))
        return np.asarray((self.gram[place, place] - taken) / variance)


def _weights(
    alternative: frozenset[str], size: float, beside: str, places: Mapping[str, slice], count: int
) -> FloatArray:
    weights = np.zeros(count)
    for name in alternative:
        if name == LAW:
            weights[places[PRIOR_OF_LAW]] = 1.0
        else:
            place = places[name]
            weights[place] = (LOUDER if name == beside else 1.0) * size / np.sqrt(place.stop - place.start)
    return weights


def _of(
    questions: Sequence[Question], model: _Model, places: Mapping[str, slice]
) -> list[FloatArray | _Gain]:
    """Return the probabilities of questions of one size, and beside one effect, against one model; of a nested one what
    they follow from.
    """
    size, beside = questions[0].size, questions[0].beside
    owns = [places[question.truth] for question in questions]
    columns = np.concatenate([np.arange(own.start, own.stop) for own in owns])
    errors = np.repeat([form_error(q.truth) for q in questions], [own.stop - own.start for own in owns])
    missed = float(model.powers[places[SLOW_NOISE]].sum()) if SLOW_NOISE in places else 0.0
    if beside:
        missed += (form_error(beside) * LOUDER * size) ** 2 * float(np.mean(model.powers[places[beside]]))
    variance = 1.0 + (missed + (errors * size) ** 2 * model.powers[columns]) / EFFECTIVE
    separation = size**2 * model.left(columns, variance)
    alike = ndtr(0.5 * np.sqrt(separation))
    found, begin = list[FloatArray | _Gain](), 0
    for question, own in zip(questions, owns, strict=True):
        part = slice(begin, begin + own.stop - own.start)
        begin = part.stop
        if question.nested:
            forms = model.between(own, float(np.mean(variance[part])))
            found.append(_gain(separation[part], size**2 / (own.stop - own.start) * forms))
        else:
            found.append(alike[part])
    return found


def _gain(separation: FloatArray, forms: FloatArray) -> _Gain:
    """Return the law of the gain of an effect; forms: products of its draws beyond the alternative."""
    values = np.maximum(np.linalg.eigvalsh(forms), 0.0)
    freedom = max(float(np.sum(values / (1.0 + values))), 1e-3)
    return _Gain(separation, freedom, 2.0 * PRIOR_ODDS + float(np.sum(np.log1p(values))))


def _named(gains: Sequence[_Gain]) -> list[FloatArray]:
    """Return the probability that each effect is named, for each of its draws: all in one call, which is quick."""
    if not gains:
        return []
    counts = [gain.separation.size for gain in gains]
    separation = np.concatenate([gain.separation for gain in gains])
    freedom = np.repeat([gain.freedom for gain in gains], counts)
    needed = np.repeat([gain.needed for gain in gains], counts)
    normal = ndtr((freedom + separation - needed) / np.sqrt(2.0 * freedom + 4.0 * separation))
    exact = ncx2.sf(needed, freedom, np.minimum(separation, FAR))
    return np.split(np.where(separation > FAR, normal, exact), np.cumsum(counts)[:-1])
