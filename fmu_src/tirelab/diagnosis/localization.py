"""Localization of the misfit: the residual over every coordinate of a recording.

Along time, deflection, rate, acceleration, radius, force, cycle, largest deflection so far, direction and recording,
two kinds of spans are searched: those in which the squared error beyond the noise is denser than elsewhere, and those
in which the mean residual differs from elsewhere. They are spans of maximum sum (Kadane's algorithm, Bentley 1984), so
that they begin and end where the residual changes. For time, cycle and history, "elsewhere" means at the same
deflections and directions of the same recording; otherwise the deep half of every cycle would be a place.

Places are ranked by concentration: their part of the excess error minus their part of the samples, or the part of it
that their own mean explains, whichever is larger.

A span is reported if noise alone would hardly show it anywhere. The sum of its squares, and that of the squared means
of its bins, are compared with the chi-squared law with as many degrees of freedom as the noise has independent samples
in it; the probability is multiplied by the number of spans that were examined. What shows in a single sample may be a
false reading, so the span has to show as well without its largest one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from radialtire import TireModel
from scipy.stats import chi2

from ..names import REFITTED_LAW
from ..preprocessing.data_checks import compared, spikes
from ..preprocessing.motion import BoolArray, FloatArray, IndexArray
from ..preprocessing.samples import RawDataset, RawExperiment, Recorded
from ..regressors.dataset import arranged
from ..simulation.simulate import simulate
from .binning import Axis, axes_of

DEPTHS = 12
"""Number of parts of the deflection, for loading and for unloading, within which samples count as alike."""

DENSE = 1.0
"""Least excess of a sample in a span, as a part of the noise's variance. With less, noise alone would shift the ends of
a span by more than a few independent samples."""

LOCATED = 1e-3
"""Probability of reporting any span in noise alone, over all spans of all coordinates together."""

MEAN_DIFFERS = 0.35
"""Least difference between a mean in a span and the mean elsewhere, as a part of the noise; for the same reason."""

LEAST, DENSER = 0.03, 1.5
"""Least concentration of a place; and how many times denser than elsewhere its part of the error is at least, if the
concentration comes from that part. A span whose part of the error is that of its samples is not a place."""

MOST_SPANS = 4
"""Most spans along one coordinate (along time: in one recording)."""


@dataclass(frozen=True)
class Span:
    """One place of the misfit.

    by: coordinate; start, stop: its bounds in `unit` (direction: -1 unloading, +1 loading; cycle and recording: numbers
    from 1; radius [m]: infinite is flat); label: its name where numbers do not say it; recording: the one
    whose time it is, where there are several
    share: part of the squared error beyond the noise, 0 to 1; samples: part of the samples, 0 to 1
    mean_residual [N]: recording less simulation; size: root mean square of the error beyond the noise, over the noise
    chance: that noise alone shows such a place anywhere, 0 to 1
    concentration: rank of the place, 0 to 1
    """

    by: str
    start: float
    stop: float
    unit: str
    label: str
    recording: str | None
    share: float
    samples: float
    mean_residual: float
    size: float
    chance: float
    concentration: float

    def to_dict(self) -> dict[str, object]:
        """Return the span as the entry of `where` in diagnosis.json."""
        entry: dict[str, object] = {
            "by": self.by,
            "from": _finite(self.start),
            "to": _finite(self.stop),
            "unit": self.unit,
            "label": self.label,
            "share": self.share,
            "samples": self.samples,
            "mean_residual": self.mean_residual,
            "size": self.size,
            "chance": self.chance,
        }
        return entry if self.recording is None else {**entry, "recording": self.recording}


def _finite(value: float) -> float | str:
    if np.isfinite(value):
        return float(value)
    return "inf" if value > 0.0 else "-inf"


def localize(
    recordings: Sequence[Recorded],
    dataset: RawDataset,
    residuals: Sequence[FloatArray],
    noises: Sequence[FloatArray],
    left: Sequence[FloatArray] | None = None,
) -> tuple[Span, ...]:
    """Return the places of the residuals [N], the most concentrated first, of equals the larger; none in noise alone.

    noises (n,) [N]: noise floor of every sample of each recording; left [N]: residuals of a correction that explains
    everything: they are noise, and their correlation gives the number of independent samples; None: the noise counts as
    white
    """
    samples = _samples(dataset, residuals, noises, left, compared(recordings))
    axes = [(axis, _bins(axis, samples)) for axis in axes_of(recordings, dataset, samples.kept)]
    looked_at = 3 * sum(sum(n * (n + 1) // 2 for n in np.diff(axis.parts)) for axis, _ in axes)
    # If the noise floor is too high, the densest span has more excess than all samples together.
    whole = max(float(np.sum(samples.excess)), *(_most(axis, bins.excess) for axis, bins in axes), 1e-300)
    found = [s for axis, bins in axes for s in _spans(axis, replace(bins, whole=whole), looked_at)]
    return tuple(sorted(found, key=lambda s: (-round(s.concentration, 9), -s.share)))


def law_corrected(
    recordings: Sequence[Recorded],
    before: Sequence[FloatArray],
    baseline: TireModel,
    corrected: TireModel,
    named: Sequence[str],
) -> list[FloatArray]:
    """Return the residuals [N] of the baseline with the corrected law, in which the other effects are localized.

    named: effects by which the corrected tire differs; before [N]: residuals of the baseline, returned where its law
    was not corrected, or nothing but the law was
    """
    others = set(named) - {REFITTED_LAW}
    if REFITTED_LAW not in named or not others:
        return list(before)
    # The shape, the preload and the gap of a refitted law are effects of the tire that no verdict names.
    law = replace(corrected, effects=tuple(pair for pair in corrected.effects if pair[0].name not in others))
    law = arranged(law, [(effect.name, v) for effect, v in baseline.effects if effect.name in others])
    return [r.force - simulate(law, r) for r in recordings]


def _most(axis: Axis, values: FloatArray) -> float:
    """Return the largest sum of neighbouring bins of an axis."""
    bounds = zip(axis.parts[:-1], axis.parts[1:], strict=True)
    return max(float(np.sum(values[slice(*_largest(values[a:b], a))])) for a, b in bounds)


def _largest(values: FloatArray, offset: int) -> tuple[int, int]:
    """Return the bounds of the largest sum of neighbouring values, counted from `offset` on."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    last = int(np.argmax(sums - np.minimum.accumulate(sums)))
    return offset + int(np.argmin(sums[: last + 1])), offset + last


@dataclass(frozen=True)
class _Samples:
    """The compared samples of all recordings end to end, without spikes; arrays of one length.

    residual [N]; variance [N^2]: of the noise; excess [N^2]: squared residual minus variance; alike_excess [N^2],
    alike_residual [N]: means over the samples at the same deflection and direction; together: for each recording,
    numbers n of samples and how many of n count as one, because the noise is correlated; kept: for each recording,
    indices into its rows
    """

    residual: FloatArray
    variance: FloatArray
    excess: FloatArray
    alike_excess: FloatArray
    alike_residual: FloatArray
    together: tuple[tuple[FloatArray, FloatArray], ...]
    kept: tuple[IndexArray, ...]


def _samples(
    dataset: RawDataset,
    residuals: Sequence[FloatArray],
    noises: Sequence[FloatArray],
    left: Sequence[FloatArray] | None,
    followed: Sequence[BoolArray],
) -> _Samples:
    parts, kept = [], []
    for record, residual, noise, seen in zip(dataset.experiments, residuals, noises, followed, strict=True):
        chosen = np.flatnonzero((seen & ~spikes(residual))[record.rows])
        variance = noise[record.rows][chosen] ** 2
        own = residual[record.rows][chosen]
        excess = own**2 - variance
        parts.append((own, variance, excess, *_alike(record, chosen, (excess, own))))
        kept.append(chosen)
    own, variance, excess, alike, usual = (np.concatenate(values) for values in zip(*parts, strict=True))
    together = [(np.ones(1), np.ones(1)) for _ in noises]
    if left is not None:
        rows = zip(dataset.experiments, left, kept, strict=True)
        together = [_correlation(values[record.rows][chosen]) for record, values, chosen in rows]
    return _Samples(own, variance, excess, alike, usual, tuple(together), tuple(kept))


def _correlation(noise: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return lengths n of blocks, and for each how many samples c of a correlated noise count as one.

    The variance of the mean of n samples is c/n times theirs; with 12 blocks it is known to a third.
    """
    length, power, found = 1, float(np.mean(noise**2)), [(1.0, 1.0)]
    while noise.size >= 24 * length and power > 0.0:
        length *= 2
        blocks = noise[: noise.size // length * length].reshape(-1, length)
        counted = length * float(np.mean(np.mean(blocks, axis=1) ** 2)) / power
        found.append((float(length), max(found[-1][1], counted)))
    lengths, counts = zip(*found, strict=True)
    return np.array(lengths), np.array(counts)


def _alike(record: RawExperiment, chosen: IndexArray, values: Sequence[FloatArray]) -> list[FloatArray]:
    """Return the means of `values` at the deflection and direction of each sample."""
    depth = record.sampled.motion.deflection[chosen]
    edges = np.quantile(depth, np.linspace(0.0, 1.0, DEPTHS + 1)[1:-1])
    cell = 2 * np.searchsorted(edges, depth) + (record.sampled.motion.direction[chosen] > 0.0)
    count = np.maximum(np.bincount(cell, minlength=2 * DEPTHS), 1)
    return [(np.bincount(cell, v, minlength=2 * DEPTHS) / count)[cell] for v in values]


@dataclass(frozen=True)
class _Bins:
    """What the bins of an axis hold; arrays of one value a bin.

    numbers: of samples; total [N]: sum of the residual; apart [N]: sum of the residual minus the mean elsewhere
    variance [N^2]: of the noise, summed; squares: of the residual over the noise, summed; excess, usual [N^2]: squares
    minus variance, summed, and the same for as many samples elsewhere; whole [N^2]: excess of all bins
    largest: residual [N] and noise variance [N^2] of the sample with the largest residual over its noise
    together: as in `_Samples`
    """

    numbers: FloatArray
    total: FloatArray
    apart: FloatArray
    variance: FloatArray
    squares: FloatArray
    excess: FloatArray
    usual: FloatArray
    whole: float
    largest: tuple[FloatArray, FloatArray]
    together: tuple[tuple[FloatArray, FloatArray], ...]

    def counted(self, number: FloatArray | float) -> FloatArray:
        """Return how many of this number of samples count as one; the largest value of all recordings."""
        return np.asarray(np.max([np.interp(number, *curve) for curve in self.together], axis=0))

    @cached_property
    def means(self) -> FloatArray:
        """Square of each bin's mean residual over that of its noise."""
        return self.total**2 / np.maximum(self.variance * self.counted(self.numbers), 1e-300)

    def scores(self) -> tuple[FloatArray, ...]:
        """Return what each bin adds to a span by four criteria: the squares of its samples, the square of its mean, its
        mean above and its mean below that elsewhere.

        The squared mean finds a small force earlier; half of the usual error separates such means from zero.
        """
        unit = self.variance * self.counted(self.numbers) / np.maximum(self.numbers, 1.0)
        usual = np.sqrt(max(self.whole, 0.0) / float(np.sum(self.numbers)))
        least = np.maximum(0.5 * usual * self.numbers, MEAN_DIFFERS * np.sqrt(self.variance * self.numbers))
        return (
            self.excess - np.maximum(self.usual, DENSE * self.variance),
            unit * (self.means - 1.0) - np.maximum(self.usual, DENSE * unit),
            self.apart - least,
            -self.apart - least,
        )

    def log_chance(self, a: int, b: int) -> float:
        """Return the log probability of the bins [a, b) in noise alone, the larger one of all their samples and of all
        but the largest.
        """
        own = [v[a:b] for v in (self.numbers, self.total, self.variance, self.squares)]
        residual, variance = (v[a:b] for v in self.largest)
        ratio = residual**2 / variance
        lone = np.arange(b - a) == np.argmax(ratio)
        less = [v - lone * of_one for v, of_one in zip(own, (1.0, residual, variance, ratio), strict=True)]
        return max(self._log_chance(*own), self._log_chance(*less))

    def _log_chance(
        self, numbers: FloatArray, total: FloatArray, variance: FloatArray, squares: FloatArray
    ) -> float:
        """Return the log probability of bins in noise alone: the smallest one of three tests; the values as above."""
        held = numbers > 0.5
        if not held.any():
            return 0.0
        numbers, total, variance, squares = (v[held] for v in (numbers, total, variance, squares))
        number = float(np.sum(numbers))
        together = float(self.counted(number))
        bins_together = together / float(self.counted(number / numbers.size))
        means = float(np.sum(total**2 / (variance * self.counted(numbers))))
        tests = (
            (float(np.sum(squares)) / together, number / together),
            (means / bins_together, numbers.size / bins_together),
            (float(np.sum(total)) ** 2 / (float(np.sum(variance)) * together), 1.0),
        )
        return min(float(chi2.logsf(value, freedom)) for value, freedom in tests)

    def share(self, a: int, b: int) -> float:
        """Return the part of the excess error in the bins [a, b)."""
        return float(np.clip(np.sum(self.excess[a:b]) / self.whole, 0.0, 1.0))

    def size(self, a: int, b: int) -> float:
        """Return the root mean square of the error beyond the noise in the bins [a, b), over that of the noise."""
        excess, variance = float(np.sum(self.excess[a:b])), float(np.sum(self.variance[a:b]))
        return float(np.sqrt(max(excess, 0.0) / max(variance, 1e-300)))

    def concentration(self, a: int, b: int) -> float:
        """Return the rank of the bins [a, b) as a place; 0 where they are none."""
        share, usual = self.share(a, b), float(np.sum(self.usual[a:b])) / self.whole
        number = float(np.sum(self.numbers[a:b]))
        dense = share - number / float(np.sum(self.numbers))
        if share - usual < LEAST or share * (1.0 - usual) < DENSER * usual * (1.0 - share):
            dense = 0.0
        apart = float(np.sum(self.apart[a:b]))
        mean = min(apart**2 / number / self.whole, share)
        if mean < LEAST or apart * float(np.sum(self.total[a:b])) <= 0.0:
            mean = 0.0
        return max(dense, mean)


def _bins(axis: Axis, samples: _Samples) -> _Bins:
    def summed(values: FloatArray) -> FloatArray:
        return np.asarray(np.bincount(axis.bin_of, values, axis.start.size), dtype=np.float64)

    one = np.ones(samples.excess.size)
    order = np.argsort(samples.residual**2 / samples.variance, kind="stable")
    largest = np.zeros(axis.start.size, dtype=int)
    largest[axis.bin_of[order]] = order  # the last one of a bin stays
    usual, level = (
        (samples.alike_excess, samples.alike_residual)
        if axis.slow
        else (one * np.mean(samples.excess), one * np.mean(samples.residual))
    )
    return _Bins(
        summed(one),
        summed(samples.residual),
        summed(samples.residual - level),
        summed(samples.variance),
        summed(samples.residual**2 / samples.variance),
        summed(samples.excess),
        summed(usual),
        float(np.sum(samples.excess)),
        (samples.residual[largest], samples.variance[largest]),
        samples.together,
    )


def _spans(axis: Axis, bins: _Bins, looked_at: int) -> list[Span]:
    """Return the places on an axis that noise alone does not show, at most `MOST_SPANS` in each part."""
    scores, found = bins.scores(), []
    for part, bounds in enumerate(zip(axis.parts[:-1], axis.parts[1:], strict=True)):
        pieces = [bounds]
        for _ in range(MOST_SPANS):
            best = _best(pieces, scores, bins, np.log(LOCATED / looked_at))
            if best is None:
                break
            concentration, a, b, piece = best
            pieces.remove(piece)
            pieces += [p for p in ((piece[0], a), (b, piece[1])) if p[1] > p[0]]
            number = float(np.sum(bins.numbers[a:b]))
            found.append(
                Span(
                    axis.by,
                    float(np.min(axis.start[a:b])),
                    float(np.max(axis.stop[a:b])),
                    axis.unit,
                    axis.label(a, b - 1),
                    axis.recordings[part] if axis.recordings else None,
                    bins.share(a, b),
                    number / float(np.sum(bins.numbers)),
                    float(np.sum(bins.total[a:b])) / number,
                    bins.size(a, b),
                    float(np.exp(bins.log_chance(a, b) + np.log(looked_at))),
                    concentration,
                )
            )
    return found


_Piece = tuple[int, int]


def _best(
    pieces: Sequence[_Piece], scores: Sequence[FloatArray], bins: _Bins, least: float
) -> tuple[float, int, int, _Piece] | None:
    """Return the most concentrated span in `pieces` whose log chance is below `least`: rank, bins [a, b), piece."""
    found = []
    for piece in pieces:
        for score in scores:
            a, b = _largest(score[piece[0] : piece[1]], piece[0])
            if b > a and bins.log_chance(a, b) < least and (rank := bins.concentration(a, b)) > 0.0:
                found.append((rank, a, b, piece))
    return max(found, default=None)
