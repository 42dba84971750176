"""The shortest set of motions that answers all questions that a rig can answer.

One motion after the other is taken, the one that gains most per second: the sum over the questions of the probability
of the right answer, each counted up to TOLD. This sum has diminishing returns as more is recorded, so the greedy set is
near the best one (G. L. Nemhauser, L. A. Wolsey, M. L. Fisher, Math. Program. 14, 265 (1978)), and a gain computed
earlier bounds a later one, which saves most of the computing (M. Minoux, 1978). At last, what has become needless is
taken out again.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE

from ..regressors.signature import LAW
from .separation import Question, probabilities

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

TOLD = 0.95
"""Probability of the right answer from which on two models are told apart: nineteen of twenty."""

LEAST_GAIN = 1e-3
"""A motion that adds less to the sum of all probabilities is not worth driving."""


EVEN = 0.5
"""Probability of the right answer where two models share it."""


@dataclass(frozen=True)
class Menu:
    """Motions to choose from: their products (n, n) and durations [s], the columns' places, and the questions.

    recorded (n, n): products of what was recorded already; mixed: whether each motion passes its deflections at more
    than one speed, recorded_mixed: whether something recorded does
    """

    grams: tuple[FloatArray, ...]
    seconds: tuple[float, ...]
    places: Mapping[str, slice]
    questions: tuple[Question, ...]
    recorded: FloatArray
    mixed: tuple[bool, ...]
    recorded_mixed: bool = False

    def answers(self, chosen: Sequence[int]) -> FloatArray:
        """Return the probability of the right answer to each question, the mean over the draws of its truth.

        Where each deflection is passed at one speed only, a diagnosis does not decide between two loops.
        """
        found = probabilities(self.gram(chosen), self.places, self.questions)
        answers = np.array([float(p.mean()) for p in found])
        if self.recorded_mixed or any(self.mixed[i] for i in chosen):
            return answers
        loops = np.array([_between_loops(q) for q in self.questions])
        return np.where(loops, np.minimum(answers, EVEN), answers)

    def gram(self, chosen: Sequence[int]) -> FloatArray:
        """Return the products over all that was recorded and chosen."""
        return sum((self.grams[i] for i in chosen), start=self.recorded)


@dataclass(frozen=True)
class Choice:
    """Indices of the chosen motions in the order in which they were chosen; answers: to each question after them;
    possible: whether each question is answered by them, by all motions of the menu together, or by one of them alone.
    """

    chosen: tuple[int, ...]
    answers: FloatArray
    possible: BoolArray


def chosen_of(menu: Menu, seconds: float, progress: Callable[[str], None]) -> Choice:
    """Return the motions to drive within a time [s]."""
    every = range(len(menu.grams))
    alone = [menu.answers([i]) for i in every]
    possible = np.any([menu.answers(every) >= TOLD, *(own >= TOLD for own in alone)], axis=0)
    left, chosen = seconds, list[int]()
    answers = menu.answers(chosen)
    # gains per second, the largest first; at which length of the plan each was computed
    heap = [(-_gain(answers, own) / menu.seconds[i], i, 0) for i, own in enumerate(alone)]
    heapq.heapify(heap)
    while heap and np.any(possible & (answers < TOLD)):
        bound, i, known = heapq.heappop(heap)
        if menu.seconds[i] > left + 1e-9:
            continue
        if known < len(chosen):
            after = menu.answers([*chosen, i])
            heapq.heappush(heap, (-_gain(answers, after) / menu.seconds[i], i, len(chosen)))
            continue
        if -bound * menu.seconds[i] < LEAST_GAIN:
            break
        chosen.append(i)
        progress(f"choosing motion {len(chosen)}")
        left -= menu.seconds[i]
        answers = menu.answers(chosen)
        heapq.heappush(heap, (bound, i, -1))  # it may be driven again
    chosen, answers = _pruned(menu, chosen, answers)
    return Choice(tuple(chosen), answers, possible | (answers >= TOLD))


def _between_loops(question: Question) -> bool:
    effects = question.alternative - {LAW}
    return not question.nested and all("loop" in _traits(name) for name in (question.truth, *effects))


def _traits(name: str) -> tuple[str, ...]:
    return CATALOGUE[name].traits if name in CATALOGUE else ()


def _gain(before: FloatArray, after: FloatArray) -> float:
    return float(np.sum(np.minimum(after, TOLD) - np.minimum(before, TOLD)))


def _pruned(menu: Menu, chosen: list[int], answers: FloatArray) -> tuple[list[int], FloatArray]:
    """Leave out what every question that is answered can do without, the longest first."""
    for i in sorted(set(chosen), key=lambda i: -menu.seconds[i]):
        less = list(chosen)
        less.remove(i)
        fewer = menu.answers(less)
        told = answers >= TOLD
        if np.all(fewer[told] >= TOLD) and _gain(fewer, answers) < LEAST_GAIN * len(answers):
            chosen, answers = less, fewer
    return chosen, answers
