"""How far stated probabilities can be trusted: Brier skill, reliability, and how many answers the rig accepts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .metrics import CONFIDENCE_EDGES, COVERAGE, RESAMPLES, Mean, Point, Rate, curve
from .score import Score
from .wide_kinds import holds, is_wide, named, several_answers, sound

Pair = tuple[float, bool]
"""A stated probability, and whether it came true."""


def confidence_pairs(scores: Sequence[Score]) -> list[list[Pair]]:
    """The confidence of every verdict, and whether all that it names held (`wide_kinds.holds`).

    Where several sets count as right, since the recordings cannot tell them apart, the probability of the alternatives
    that leave the same belongs to it.
    """
    return [
        [(s.confidence + (s.same if several_answers(s) else 0.0), holds(s))]
        for s in scores
        if s.confidence is not None
    ]


def effect_pairs(scores: Sequence[Score]) -> list[list[Pair]]:
    """The probability of every named effect, trial by trial, and whether it is there: hidden, not only arguable."""
    return [[(p, name in s.right[0]) for name, p in _stated(s)] for s in scores if named(s)]


def skill(trials: Sequence[Sequence[Pair]]) -> Mean:
    """Brier skill over the constant rate: 1 - sum (p - hit)^2 / sum (rate - hit)^2; NaN where all or none came true.

    rate: the part that came true, the best constant. The interval resamples the trials (percentiles of the bootstrap
    skills). Source: Murphy, J. Appl. Meteorology 12, 215 (1973).
    """
    sums = np.array(
        [(sum((p - h) ** 2 for p, h in pairs), sum(h for _, h in pairs), len(pairs)) for pairs in trials],
        dtype=np.float64,
    ).reshape(-1, 3)
    count = int(np.sum(sums[:, 2]))
    value = _skill(sums[None])[0] if count else float("nan")
    if np.isnan(value):
        return Mean(float("nan"), (float("nan"), float("nan")), count)
    rng = np.random.default_rng(1)
    skills = _skill(sums[rng.integers(len(sums), size=(RESAMPLES, len(sums)))])
    tail = 50.0 * (1.0 - COVERAGE)
    low, high = np.percentile(skills[np.isfinite(skills)], [tail, 100.0 - tail])
    return Mean(float(value), (float(low), float(high)), count)


def reliability(scores: Sequence[Score]) -> list[Point]:
    """How often all that verdicts name held, by classes of their stated confidence."""
    return curve([pair for pairs in confidence_pairs(scores) for pair in pairs], CONFIDENCE_EDGES)


def effect_reliability(scores: Sequence[Score]) -> list[Point]:
    """How often named effects are there, by classes of their stated probability."""
    return curve([pair for pairs in effect_pairs(scores) for pair in pairs], CONFIDENCE_EDGES)


@dataclass(frozen=True)
class Answers:
    """How many answers the rig accepts.

    several: trials that accept more than one set; exact_single: exact verdicts where one set alone is right; the same
    by the rig's own fits in the kinds whose answers follow a rule; alternatives: stated per verdict
    """

    several: Rate
    exact_single: Rate
    several_as_derived: Rate
    exact_as_derived: Rate
    exact_single_as_derived: Rate
    alternatives: Mean


def answers(scores: Sequence[Score]) -> Answers:
    """Return how many answers the rig accepts, and the rates on trials that accept one."""
    ruled = [s for s in scores if not is_wide(s)]
    return Answers(
        several=Rate.of(several_answers(s) for s in scores),
        exact_single=Rate.of(sound(s) for s in scores if not several_answers(s)),
        several_as_derived=Rate.of(not s.single_answer_as_derived for s in ruled),
        exact_as_derived=Rate.of(s.exact_as_derived for s in ruled),
        exact_single_as_derived=Rate.of(s.exact_as_derived for s in ruled if s.single_answer_as_derived),
        alternatives=Mean.of(float(len(s.alternatives)) for s in scores if s.verdict is not None),
    )


def skills(scores: Sequence[Score]) -> dict[str, Mean]:
    """Brier skill of the confidence and of the probabilities of effects, over all kinds together."""
    pairs: dict[str, Callable[[Sequence[Score]], list[list[Pair]]]] = {
        "confidence of the verdict": confidence_pairs,
        "probability of a named effect": effect_pairs,
    }
    return {what: skill(of(scores)) for what, of in pairs.items()}


def _stated(score: Score) -> list[tuple[str, float]]:
    return [(name, score.probabilities[name]) for name in sorted(named(score)) if name in score.probabilities]


def _skill(sums: NDArray[np.float64]) -> NDArray[np.float64]:
    """Skill of each sample of trials; sums: squares, hits and counts, shape (samples, trials, 3)."""
    squares, hits, counts = np.moveaxis(np.sum(sums, axis=1), -1, 0)
    constant = hits * (1.0 - hits / np.maximum(counts, 1.0))
    return np.where(constant > 0.0, 1.0 - squares / np.where(constant > 0.0, constant, 1.0), np.nan)
