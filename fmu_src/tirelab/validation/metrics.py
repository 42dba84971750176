"""Statistics of the scores of a proof, each with its 95 % interval."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.stats import binomtest

from ..diagnosis.diagnosis_file import NOTHING
from .score import OUTCOMES, Score

COVERAGE = 0.95
"""Coverage of all intervals."""

SIZE_EDGES = (0.0, 2.0, 4.0, 8.0, 16.0, 32.0, np.inf)
"""Classes of effect size over noise: octaves, as the rig draws sizes evenly over the logarithm from 1 to 30."""

CONFIDENCE_EDGES = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0)
"""Classes of stated confidence, closer where verdicts are."""

ANY_EFFECT = "any effect"
"""Name of the curve over all effects together."""

RESAMPLES = 2000

NO_NAME = "(nothing)"
"""Column of the confusion matrix for an effect that got no name, row for a name without an effect."""


@dataclass(frozen=True)
class Rate:
    """`hits` of `trials`, and the interval of the rate behind them (Wilson 1927, J. Am. Stat. Assoc. 22, 209)."""

    hits: int
    trials: int

    @property
    def value(self) -> float:
        """The rate; NaN where there is no trial."""
        return self.hits / self.trials if self.trials else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval; 0 to 1 where there is no trial."""
        if not self.trials:
            return 0.0, 1.0
        found = binomtest(self.hits, self.trials).proportion_ci(COVERAGE, method="wilson")
        return float(found.low), float(found.high)

    @classmethod
    def of(cls, answers: Iterable[bool]) -> Rate:
        """Count answers that are true."""
        listed = list(answers)
        return cls(sum(listed), len(listed))


@dataclass(frozen=True)
class Mean:
    """A mean over `trials`, and its interval by resampling them (percentiles of 2000 bootstrap means)."""

    value: float
    interval: tuple[float, float]
    trials: int

    @classmethod
    def of(cls, values: Iterable[float]) -> Mean:
        """The mean of some values; NaN where there is none."""
        listed = np.array(list(values), dtype=np.float64)
        if listed.size == 0:
            return cls(float("nan"), (float("nan"), float("nan")), 0)
        rng = np.random.default_rng(1)
        means = listed[rng.integers(listed.size, size=(RESAMPLES, listed.size))].mean(axis=1)
        tail = 50.0 * (1.0 - COVERAGE)
        low, high = np.percentile(means, [tail, 100.0 - tail])
        return cls(float(listed.mean()), (float(low), float(high)), int(listed.size))


@dataclass(frozen=True)
class Point:
    """One point of a curve: class from `low` to `high`, mean of what is on the abscissa, and a rate."""

    low: float
    high: float
    at: float
    rate: Rate


def exact(scores: Sequence[Score]) -> Rate:
    """How often exactly a right set was named; a failed diagnosis is a miss."""
    return Rate.of(s.exact for s in scores)


def among(scores: Sequence[Score]) -> Rate:
    """How often a right set was the verdict or one of its alternatives."""
    return Rate.of(s.among for s in scores)


def false_alarms(scores: Sequence[Score]) -> Rate:
    """How often something was named where nothing was hidden, of the trials in which nothing was hidden."""
    return Rate.of(s.false_alarm for s in scores if s.kind == "none")


def recognised(scores: Sequence[Score]) -> Rate:
    """How often the verdict was "unknown" where something outside the catalogue was hidden."""
    return Rate.of(s.recognised for s in scores if s.open)


def wrongly_unknown(scores: Sequence[Score]) -> Rate:
    """How often the verdict was "unknown" where every hidden effect is in the catalogue."""
    return Rate.of(s.recognised for s in scores if not s.beyond_catalogue)


def near_floor(scores: Sequence[Score], within: float, *, alike: bool, noise_free: bool = False) -> Rate:
    """How often the corrected tire's held-out RMSE is at most 1 + `within` times the noise floor, inside the catalogue.

    alike: on tests of the diagnosed kinds, or on tests of other kinds
    noise_free: whether the tire is given the noise-free deflection
    A failed diagnosis, and a verdict without a corrected tire, count as misses.
    """
    return Rate.of(
        s.held_out is not None
        and (s.held_out.alike if alike else s.held_out.other).near(within, noise_free=noise_free)
        for s in scores
        if not s.beyond_catalogue
    )


def brier(scores: Sequence[Score]) -> Mean:
    """Brier score of the stated confidence: mean of (confidence - exact)^2 over all verdicts.

    Where several sets count as right, the alternatives that leave the same belong to the confidence.
    Failed diagnoses state no confidence and are left out.
    Source: Brier, Monthly Weather Review 78, 1 (1950).
    """
    return Mean.of(
        (s.confidence + (0.0 if s.single_answer else s.same) - float(s.exact)) ** 2
        for s in scores
        if s.confidence is not None
    )


def naming(scores: Sequence[Score]) -> dict[str, list[Point]]:
    """How often each hidden effect, and any of them, was named, by classes of its size over the noise.

    Trials in which a set without the effect counts as right too (the recordings cannot show it) are left out.
    """
    pairs: dict[str, list[tuple[float, bool]]] = defaultdict(list)
    for s in scores:
        for effect, size in s.sizes.items():
            if s.demands(effect):
                pairs[effect].append((size, s.named(effect)))
    everything = [pair for listed in pairs.values() for pair in listed]
    curves = {ANY_EFFECT: curve(everything, SIZE_EDGES)} if everything else {}
    return curves | {effect: curve(pairs[effect], SIZE_EDGES) for effect in sorted(pairs)}


def curve(pairs: Sequence[tuple[float, bool]], edges: Sequence[float]) -> list[Point]:
    """Points of the classes that hold anything; a value at an edge belongs to the class below it."""
    points = []
    for low, high in pairwise(edges):
        inside = [(x, hit) for x, hit in pairs if low < x <= high or (x == low == edges[0])]
        if inside:
            at = float(np.mean([x for x, _ in inside]))
            points.append(Point(low, high, at, Rate.of(hit for _, hit in inside)))
    return points


def confusion(scores: Sequence[Score]) -> dict[str, dict[str, float]]:
    """How often each hidden effect (row) was given each name (column).

    An effect that is both hidden and named is a hit. A missed effect counts in equal parts for the wrong names of the
    verdict, or for "(nothing)" where there is none. Wrong names of a verdict that misses no effect count in the row
    "(nothing)". Every other row sums to the number of trials that hold its effect.
    """
    table: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))
    for s in scores:
        if s.verdict is None:
            continue
        true, named = s.reference, s.verdict
        missed, wrong = true - named, named - true - NOTHING
        for name in true & named:
            table[name][name] += 1.0
        for name in missed:
            for other in wrong or {NO_NAME}:
                table[name][other] += 1.0 / max(len(wrong), 1)
        if not missed:
            for other in wrong:
                table[NO_NAME][other] += 1.0
    # in one order, so that the same scores make the same proof.json
    return {row: dict(sorted(columns.items())) for row, columns in sorted(table.items())}


@dataclass(frozen=True)
class RegionSummary:
    """Overlap for one effect along one coordinate: median, and how often it is at least half."""

    effect: str
    by: str
    median: float
    half: Rate


def regions(scores: Sequence[Score]) -> list[RegionSummary]:
    """How well the regions of localized effects were found, whether or not the effect was named."""
    overlaps: dict[tuple[str, str], list[float]] = defaultdict(list)
    for s in scores:
        for region in s.regions:
            overlaps[region.effect, region.by].append(region.overlap)
    return [
        RegionSummary(effect, by, float(np.median(values)), Rate.of(v >= 0.5 for v in values))
        for (effect, by), values in sorted(overlaps.items())
    ]


RIGHT_BEFORE, RIGHT_WITH = (
    "verdicts repeated with the recommended recording: right before",
    "right with it",
)


def discriminations(scores: Sequence[Score]) -> dict[str, Rate]:
    """What the recommended test decided, for the verdicts with the truth among their alternatives; and how many were
    right before it and with it, of all that were repeated.
    """
    repeated = [
        s for s in scores if s.discrimination is not None and s.discrimination.right_after is not None
    ]
    found = [s.discrimination for s in scores if s.discrimination is not None]
    true = [x for x in found if x.truth_among]
    return {
        "truth among the alternatives": Rate(len(true), len(found)),
        **{f"of these: {o}": Rate.of(x.outcome == o for x in true) for o in OUTCOMES},
        RIGHT_BEFORE: Rate.of(s.exact for s in repeated),
        RIGHT_WITH: Rate.of(bool(s.discrimination and s.discrimination.right_after) for s in repeated),
    }


def by_kind(scores: Sequence[Score], figure: Callable[[Sequence[Score]], Rate]) -> dict[str, Rate]:
    """A figure for every kind of trial."""
    return {kind: figure([s for s in scores if s.kind == kind]) for kind in sorted({s.kind for s in scores})}
