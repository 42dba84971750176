"""With which probability a set of motions tells one effect from another, before anything is recorded.

Effect i is true, with a response c of a given size. It is compared with a rival model M: a refitted law, perhaps with
other effects, all linear in Gaussian coefficients, f = W z with z ~ N(0, 1), as in `selection.search`.
What the rival cannot follow of c,

    S^2 = min_z |c - W z|^2 / V + |z|^2 = c' (V + W W')^-1 c,

is twice the log likelihood ratio that is to be expected: the T-optimal criterion (A. C. Atkinson, V. V. Fedorov,
Biometrika 62, 57 (1975)), averaged over the draws of c (J. Lopez-Fidalgo et al., J. R. Stat. Soc. B 69, 231 (2007)).
V = 1 + f^2 |c|^2 / e is the variance, in units of the noise, of what the forms miss: f of the response, in e effective
samples, as in `selection.search`. f is the form error of the true effect, which is the best set's: what its forms
usually miss, under which a diagnosis judges all sets (`estimation.ranking`).

Two models of equal standing: the log likelihood ratio is normal with mean S^2/2 and variance S^2, so the right one is
the likelier one with probability Phi(S/2). A rival within the true model, M without i: twice the ratio is noncentral
chi-squared (S. S. Wilks, Ann. Math. Stat. 9, 60 (1938); A. Wald, Trans. AMS 54, 426 (1943)) with the noncentrality S^2
and as many degrees of freedom as forms of i can be resolved; i is named where the ratio exceeds the prior odds and what
its forms cost. An effect is named alone with at least the product of these probabilities over its rivals, where the
ratios, all of one truth, are positively correlated (D. Slepian, Bell Syst. Tech. J. 41, 463 (1962)).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr
from scipy.stats import ncx2

from ..regressors.signature import LAW, form_error
from ..selection.search import EFFECTIVE, PRIOR_ODDS
from .responses import HELD, PRIOR_OF_GAIN, PRIOR_OF_LAW

FloatArray = NDArray[np.float64]

FAR = 1e4
"""Noncentrality above which the chi-squared law is a normal one to all digits that are shown."""


@dataclass(frozen=True)
class Question:
    """Whether `truth` is told from the model of the names in `rival`; size: largest response over the peak force.

    nested: whether the rival is the true model without `truth`, else the rival stands in its place
    """

    truth: str
    rival: frozenset[str]
    size: float
    nested: bool


def questions_of(names: Sequence[str], size: float) -> tuple[Question, ...]:
    """Return every effect against a refitted law alone, and against every other effect beside a refitted law; and a
    refitted law against nothing and against every effect. The gain with a held pressure is part of every rival, so it
    is asked for and is no rival of its own.
    """
    effects = [name for name in names if name != LAW]
    rivals = [name for name in effects if name != HELD.name]
    found = []
    for truth in effects:
        found.append(Question(truth, frozenset({LAW}), size, nested=True))
        found += [
            Question(truth, frozenset({LAW, other}), size, nested=False) for other in rivals if other != truth
        ]
    if LAW in names:
        found.append(Question(LAW, frozenset(), size, nested=True))
        found += [Question(LAW, frozenset({other}), size, nested=False) for other in rivals]
    return tuple(found)


def probabilities(
    gram: FloatArray, places: Mapping[str, slice], questions: Sequence[Question]
) -> list[FloatArray]:
    """Return for each question the probability of the right answer, for each draw of its truth.

    gram (n, n): products of all columns over the motions, in units of the noise; places: of their columns
    """
    found: list[FloatArray] = [np.zeros(0)] * len(questions)
    groups: dict[tuple[frozenset[str], float, bool], list[int]] = {}
    for number, question in enumerate(questions):
        key = question.rival, question.size, question.truth != HELD.name
        groups.setdefault(key, []).append(number)
    for (rival, size, gain), numbers in groups.items():
        weights = _weights(rival, size, places, gram.shape[0])
        if gain and PRIOR_OF_GAIN in places:
            weights[places[PRIOR_OF_GAIN]] = 1.0
        model = _Model(gram, weights)
        for number in numbers:
            found[number] = _of(questions[number], model, places)
    return found


class _Model:
    """A rival model: the eigenvalues of its columns' products, and the columns turned to their directions."""

    def __init__(self, gram: FloatArray, weights: FloatArray) -> None:
        self.gram = gram
        on = np.flatnonzero(weights)
        values, vectors = np.linalg.eigh(weights[on, None] * gram[np.ix_(on, on)] * weights[on])
        self.values = np.maximum(values, 0.0)
        self.turned = vectors.T @ (weights[on, None] * gram[on])

    def left(self, place: slice, variance: FloatArray) -> FloatArray:
        """Return c' (V + W W')^-1 c of each column c at `place`, with its own V."""
        total = np.diag(self.gram)[place]
        taken = np.sum(self.turned[:, place] ** 2 / (variance + self.values[:, None]), axis=0)
        return np.asarray(np.maximum((total - taken) / variance, 0.0))

    def between(self, place: slice, variance: float) -> FloatArray:
        """Return the products of the columns at `place` with each other, as `left` has those with themselves."""
        turned = self.turned[:, place]
        taken = turned.T @ (turned / (variance + self.values[:, None]))
        return np.asarray((self.gram[place, place] - taken) / variance)


def _weights(rival: frozenset[str], size: float, places: Mapping[str, slice], count: int) -> FloatArray:
    weights = np.zeros(count)
    for name in rival:
        if name == LAW:
            weights[places[PRIOR_OF_LAW]] = 1.0
        else:
            place = places[name]
            weights[place] = size / np.sqrt(place.stop - place.start)
    return weights


def _of(question: Question, model: _Model, places: Mapping[str, slice]) -> FloatArray:
    place, size = places[question.truth], question.size
    power = size**2 * np.diag(model.gram)[place]
    variance = 1.0 + form_error(question.truth) ** 2 * power / EFFECTIVE
    separation = size**2 * model.left(place, variance)
    if not question.nested:
        return np.asarray(ndtr(0.5 * np.sqrt(separation)))
    draws = place.stop - place.start
    forms = size**2 / draws * model.between(place, float(np.mean(variance)))
    values = np.maximum(np.linalg.eigvalsh(forms), 0.0)
    freedom = max(float(np.sum(values / (1.0 + values))), 1e-3)
    needed = 2.0 * PRIOR_ODDS + float(np.sum(np.log1p(values)))
    normal = ndtr((freedom + separation - needed) / np.sqrt(2.0 * freedom + 4.0 * separation))
    exact = ncx2.sf(needed, freedom, np.minimum(separation, FAR))
    return np.asarray(np.where(separation > FAR, normal, exact))
