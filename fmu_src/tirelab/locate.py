"""Where simulation and recording part: the residual against everything that a recording knows.

Along time, deflection, rate, acceleration, radius, force, cycle, largest deflection so far, direction and recording the
spans are looked for in which the squared error beyond the noise is denser than elsewhere: the spans of largest sum of
excess less what so many samples have on average (Kadane's maximum sum, Bentley 1984), bounded where the residual says
so and not by a grid. In time, cycles and history "on average" means at the same deflections and directions of the
same recording, else every cycle's deep half would be a place. Places are ranked by concentration: their part of the
excess error less their part of the samples.

A span is told where noise alone would hardly show it anywhere: its squares, and the squares of its bins' means, are
held against chi square with as many degrees of freedom as the noise has independent samples (a block as long as its
correlation counts once), and the chance is multiplied by the number of spans that were looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from .coordinates import Axis, axes_of
from .explain.motion import FloatArray, IndexArray
from .explain.scene import Record, Scene
from .held_out import Recorded
from .noise import Noise

DEPTHS = 12
"""Spans of deflection which, loading and unloading apart, tell what error a sample has on average."""

DENSE = 0.5
"""Samples belong to a span where their excess is at least this part of the noise's variance: less would let a walk of
noise alone carry an end away by more than some ten samples."""

LOCATED = 1e-3
"""Chance, over all spans of all coordinates together, of telling any span where there is noise alone."""

LEAST, DENSER = 0.03, 2.0
"""A place holds at least so much more of the excess than so many samples have on average, so many times as densely as
the samples outside: what holds its samples' share of the error is no place."""

MOST_SPANS = 3
"""Spans along one coordinate (in time: of one recording) at most."""


@dataclass(frozen=True)
class Span:
    """One place of the misfit.

    by: coordinate; start, stop: its bounds in `unit` (direction: -1 unloading, +1 loading; cycle and recording: numbers
    from 1; radius [m]: infinite is flat); label: what it is called where numbers do not say it; recording: the one
    that is meant, where a time is told of one among several
    share: part of the squared error beyond the noise, 0 to 1; samples: part of the samples, 0 to 1
    mean_residual [N]: recording less simulation; chance: that noise alone shows such a place anywhere, 0 to 1
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
    chance: float

    @property
    def concentration(self) -> float:
        """Part of the excess error beyond the samples' part: the rank of a place."""
        return self.share - self.samples

    def to_contract(self) -> dict[str, object]:
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
            "chance": self.chance,
        }
        return entry if self.recording is None else {**entry, "recording": self.recording}


def _finite(value: float) -> float | str:
    if np.isfinite(value):
        return float(value)
    return "inf" if value > 0.0 else "-inf"


def locate(
    recordings: Sequence[Recorded], scene: Scene, residuals: Sequence[FloatArray], noises: Sequence[Noise]
) -> tuple[Span, ...]:
    """Return the places of the residuals [N] of each recording, the most concentrated first; none in noise alone."""
    samples = _samples(scene, residuals, noises)
    axes = axes_of(recordings, scene, samples.kept)
    looked_at = 3 * sum(sum(n * (n + 1) // 2 for n in np.diff(axis.parts)) for axis in axes)
    found = [span for axis in axes for span in _spans(axis, samples, looked_at)]
    return tuple(sorted(found, key=lambda s: -s.concentration))


@dataclass(frozen=True)
class _Samples:
    """The compared samples of all recordings end to end, without spikes; arrays of one length.

    residual [N]; variance [N^2]: of the noise; excess [N^2]: square beyond it; alike [N^2]: mean excess of samples like
    this one; together: samples of the noise that count as one; kept: of each recording, indices into its rows
    """

    residual: FloatArray
    variance: FloatArray
    excess: FloatArray
    alike: FloatArray
    together: FloatArray
    kept: tuple[IndexArray, ...]

    @property
    def whole(self) -> float:
        """Excess of all samples together [N^2]."""
        return max(float(np.sum(self.excess)), 1e-12)


def _samples(scene: Scene, residuals: Sequence[FloatArray], noises: Sequence[Noise]) -> _Samples:
    parts: list[tuple[FloatArray, FloatArray, FloatArray, FloatArray]] = []
    kept = []
    for record, residual, noise in zip(scene.records, residuals, noises, strict=True):
        chosen = np.flatnonzero(noise.weight > 0.0)
        spread = noise.spread[chosen]
        variance = noise.level**2 * spread**2 / float(np.mean(spread**2))
        own = residual[record.rows][chosen]
        excess = own**2 - variance
        parts.append(
            (own, variance, _alike(record, chosen, excess), np.full(own.size, noise.correlation_samples))
        )
        kept.append(chosen)
    residual, variance, alike, together = (np.concatenate(values) for values in zip(*parts, strict=True))
    return _Samples(residual, variance, residual**2 - variance, alike, together, tuple(kept))


def _alike(record: Record, chosen: IndexArray, excess: FloatArray) -> FloatArray:
    """Return the mean excess at the deflection and direction of each sample."""
    depth = record.thin.motion.deflection[chosen]
    edges = np.quantile(depth, np.linspace(0.0, 1.0, DEPTHS + 1)[1:-1])
    cell = 2 * np.searchsorted(edges, depth) + (record.thin.motion.direction[chosen] > 0.0)
    count = np.maximum(np.bincount(cell, minlength=2 * DEPTHS), 1)
    return np.asarray((np.bincount(cell, excess, minlength=2 * DEPTHS) / count)[cell])


@dataclass(frozen=True)
class _Bins:
    """What the bins of an axis hold; arrays of one value a bin.

    numbers: of samples; total [N]: of the residual; variance [N^2]: of the noise, summed; squares: of the residual over
    the noise, summed; excess, usual [N^2]: square beyond the noise, and what so many samples have on average
    together: samples of the noise that count as one
    """

    numbers: FloatArray
    total: FloatArray
    variance: FloatArray
    squares: FloatArray
    excess: FloatArray
    usual: FloatArray
    together: float

    @property
    def means(self) -> FloatArray:
        """Square of each bin's mean residual over that of its noise."""
        return self.total**2 / np.maximum(self.variance * self.together, 1e-300)

    def scores(self) -> tuple[FloatArray, FloatArray]:
        """Return what each bin adds to a span: by its samples, and by its mean, which shows a faint force sooner."""
        unit = self.variance * self.together / np.maximum(self.numbers, 1.0)
        return (
            self.excess - np.maximum(self.usual, DENSE * self.variance),
            unit * (self.means - 1.0) - np.maximum(self.usual, DENSE * unit),
        )

    def log_chance(self, a: int, b: int) -> float:
        """Return the logarithm of the chance that noise alone fills the bins [a, b) so: the least of three tests."""
        squares, means, total, variance = (
            float(np.sum(v[a:b])) for v in (self.squares, self.means, self.total, self.variance)
        )
        blocks = float(np.sum(self.numbers[a:b])) / self.together
        tests = (
            (squares / self.together, blocks),
            (means, float(b - a)),
            (total**2 / (variance * self.together), 1.0),
        )
        return min(float(chi2.logsf(value, freedom)) for value, freedom in tests)


def _bins(axis: Axis, samples: _Samples) -> _Bins:
    def summed(values: FloatArray) -> FloatArray:
        return np.asarray(np.bincount(axis.bin_of, values, axis.start.size), dtype=np.float64)

    whole = np.full(samples.excess.size, np.mean(samples.excess))
    return _Bins(
        summed(np.ones(whole.size)),
        summed(samples.residual),
        summed(samples.variance),
        summed(samples.residual**2 / samples.variance),
        summed(samples.excess),
        summed(samples.alike if axis.slow else whole),
        float(np.max(samples.together)),
    )


def _spans(axis: Axis, samples: _Samples, looked_at: int) -> list[Span]:
    """Return the spans of an axis that noise alone does not show, at most `MOST_SPANS` of each part."""
    bins = _bins(axis, samples)
    scores, found = bins.scores(), []
    for part, bounds in enumerate(zip(axis.parts[:-1], axis.parts[1:], strict=True)):
        pieces = [bounds]
        for _ in range(MOST_SPANS):
            best = _best(pieces, scores, bins.log_chance)
            if best is None or best[0] + np.log(looked_at) > np.log(LOCATED):
                break
            log_chance, a, b, piece = best
            pieces.remove(piece)
            pieces += [p for p in ((piece[0], a), (b, piece[1])) if p[1] > p[0]]
            share = float(np.clip(np.sum(bins.excess[a:b]) / samples.whole, 0.0, 1.0))
            usual = float(np.sum(bins.usual[a:b])) / samples.whole
            if share - usual < LEAST or share * (1.0 - usual) < DENSER * usual * (1.0 - share):
                continue
            number = float(np.sum(bins.numbers[a:b]))
            found.append(
                Span(
                    axis.by,
                    float(np.min(axis.start[a:b])),
                    float(np.max(axis.stop[a:b])),
                    axis.unit,
                    axis.label(a, b - 1),
                    axis.recordings[part] if axis.recordings else None,
                    share,
                    number / samples.residual.size,
                    float(np.sum(bins.total[a:b])) / number,
                    float(np.exp(log_chance + np.log(looked_at))),
                )
            )
    return found


_Piece = tuple[int, int]


def _best(
    pieces: Sequence[_Piece], scores: Sequence[FloatArray], log_chance: Callable[[int, int], float]
) -> tuple[float, int, int, _Piece] | None:
    """Return the span of `pieces` that noise shows least: log of its chance, its bins [a, b), and its piece."""
    found = []
    for piece in pieces:
        for score in scores:
            sums = np.concatenate([[0.0], np.cumsum(score[piece[0] : piece[1]])])
            b = int(np.argmax(sums - np.minimum.accumulate(sums)))
            a = int(np.argmin(sums[: b + 1]))
            if b > a:
                found.append((log_chance(piece[0] + a, piece[0] + b), piece[0] + a, piece[0] + b, piece))
    return min(found, default=None)
