"""The noise of a misfit: its level and its memory.

A filter before the converter correlates the noise of neighbouring force samples. The correlation length, here the
memory of the noise, shows in differences over growing lags: they rise up to the memory and then stay constant, while
those of a smooth misfit keep rising. They stay constant as well once they have reached the whole variation, which is
all that a short recording can show. A misfit that follows the motion is smooth where the motion is slow, so the
differences of each lag are taken there; a quick part of a recording then does not hide the memory that a slow part
shows.

What repeats at the same deflection is not noise, however quickly it changes: a ripple of the tread, for instance. Nor
is what repeats at the same distance from a reversal: the knee of a loop, which a linear model follows only in part. So
levels are also taken between visits of the same place; the smallest of all these levels is that of the noise. White
noise is at most the smallest of all: whatever is compared, all of it differs. Nor is what is rougher where the motion
is quicker noise: a stick and slip is, though no visit repeats it. Nor is what is louder in one part of the recording: a
law that is far off leaves most where the part is loaded for the first time.

The hum of the mains is noise that oscillates: it is set apart before all this.

Recordings of one series are read by one amplifier. Where the motion of one could make what looks like a noise, it is
believed if another one has a noise of this level and memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.stats import f

from .driven import FEWEST_EVENTS, FEWEST_LAGS, Driven, Visits
from .hum import mains_hum
from .levels import (
    FEWEST_IN_STATE,
    STAYS,
    falls,
    finer,
    known_levels,
    known_over,
    known_part,
    level_between,
    level_of,
    local_rms,
    most_along,
    most_apart,
    plateau_at,
    rising,
    white_level,
)

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]


STILL = 0.02
"""Speed over its root mean square, or its largest, below which the tire rests; way over the span that is no stroke."""

NEGLIGIBLE = 0.05
"""Part of a whole that does not count: of the samples, of a variance, of a noise's size, of a prior; a chance."""

STANDS_OUT = 8.0
"""Noise standard deviations: a gauge whose reading stays within them stands still, what is beyond them is no noise."""

LONGEST_PHASE = float(2.0 * np.pi / 3.0)
"""Phase p [rad] of the motion over the longest lag. Third differences of a sine are (2 sin(p / 2))^3 times it, at this
phase five times those over half the lag; a level that does not rise so much is that of noise."""


@dataclass(frozen=True)
class Noise:
    """level: standard deviation of one sample; memory: number of samples after which errors are independent; hum: root
    mean square of the part of it that is hum of the mains.
    """

    level: float
    memory: int
    hum: float = 0.0

    @property
    def told_by_series(self) -> bool:
        """Whether it is of a kind that one recording of a series may show where another one does not."""
        return self.memory > 1 or self.hum > 0.0

    @property
    def of_mains(self) -> Noise:
        """The hum of the mains alone, of which neither level nor memory is known."""
        return Noise(0.0, 1, self.hum)

    def is_like(self, other: Noise) -> bool:
        """Whether both may be of one amplifier: their levels count as the same, and their memories, which are known to
        a doubling.
        """
        levels, memories = ((self.level, other.level), (self.memory, other.memory))
        return max(levels) <= STAYS * min(levels) and max(memories) <= 2 * min(memories)


def resting(rate: FloatArray) -> BoolArray:
    """Return at which samples (n,) the tire rests; rate (n,) [m/s]."""
    return np.asarray(np.abs(rate) <= STILL * float(np.abs(rate).max()))


Left = Callable[[FloatArray], FloatArray]
"""Of signals (n, k) of the motion what a model leaves (n, k), fitted to them as it was to the misfit."""


def noise_of(
    residual: FloatArray, driven: Driven, left: Left | None = None, known: Sequence[Noise] = ()
) -> Noise:
    """Return the noise of a residual (n,), white or with a memory.

    left: of the model that left the residual. What is slow has gone into the model, so what is left of a kink that it
    cannot follow varies within a few lags, as a noise with a memory does; then the residual must have none of it.
    known: noises of other recordings of the series
    """
    return _beside_hum(residual, driven, known, lambda rest: _noise_beside_motion(rest, driven, left, known))


def _beside_hum(
    residual: FloatArray, driven: Driven, known: Sequence[Noise], noise: Callable[[FloatArray], Noise]
) -> Noise:
    """Return the noise of a residual whose hum, a noise of the reading, is apart from what `noise` sees. A hum that
    comes again with the motion is believed where the series is known to have one that is as loud.
    """
    lags, _ = _slow_lags(driven)
    hum = mains_hum(residual, driven.interval, 2.0 * lags[-1], NEGLIGIBLE)
    size = float(np.sqrt(np.mean(hum**2)))
    if not np.any(hum) or (
        max((n.hum for n in known), default=0.0) * STAYS < size and _comes_again(hum, driven)
    ):
        return noise(residual)
    found = noise(residual - hum)
    return Noise(float(np.hypot(found.level, size)), found.memory, size)


def _comes_again(line: FloatArray, driven: Driven) -> bool:
    """Return whether a line (n,) is alike in all visits of a place, as a harmonic of a motion of 5 or 10 Hz is."""
    pairs = [(one, other) for one, other, _ in driven.visits(1) if one.size >= FEWEST_EVENTS]
    return any(most_apart(line, 1, *pair) * STAYS < float(np.sqrt(np.mean(line**2))) for pair in pairs)


def _noise_beside_motion(
    residual: FloatArray, driven: Driven, left: Left | None, known: Sequence[Noise]
) -> Noise:
    """Return the noise of a residual without hum."""
    levels = _levels_of(residual, driven)
    plateau = _noise_at_plateau(levels, driven)
    kinks = None
    for found in [plateau] if plateau else _noises_at_whole_variation(levels, driven, known):
        if found.memory == 1 or left is None or any(map(found.is_like, known)):
            return found
        kinks = left(driven.kinks) if kinks is None else kinks
        visits = _seen_visits(driven, found.memory, found.memory, levels.slow)
        could = any(_may_follow(kink, found.memory, levels.slow, visits) for kink in kinks.T)
        follows = could and _follows(residual, left(driven.shapes(found.memory)), found.memory)
        if not follows:
            return found
    return levels.white(driven)


def noise_left(residual: FloatArray, driven: Driven) -> Noise | None:
    """Return the noise with a memory that is all of a residual (n,) which a fitted tire leaves; None where it is not.

    Such a residual has nothing of what the fit follows, so one more lag need not show that the level stays.
    """
    found = next(_noises_at_whole_variation(_levels_of(residual, driven), driven, (), fitted=True), None)
    # A filter that overshoots makes differences at some lags larger than the whole.
    return found and replace(found, level=min(found.level, float(np.std(residual))))


def white_noise_of(residual: FloatArray, driven: Driven, known: Sequence[Noise] = ()) -> Noise:
    """Return the noise of a residual (n,) that is known to be white; known: see `noise_of`."""
    return _beside_hum(residual, driven, known, lambda rest: _levels_of(rest, driven).white(driven))


@dataclass(frozen=True)
class _Levels:
    """Levels of a residual over doubled lags, `values`, at the samples where the motion is slow enough for all lags;
    known: the part of each that chance leaves.
    """

    residual: FloatArray
    lags: tuple[int, ...]
    slow: BoolArray
    values: tuple[float, ...]
    known: tuple[float, ...]

    @property
    def rises(self) -> list[bool]:
        """Whether each level but the first is a rise."""
        return rising(self.values, self.known)

    def noise(self, last: int) -> Noise:
        """Return the noise with the level `last`."""
        return _noise_of_level(self.values, self.rises, last)

    def white(self, driven: Driven) -> Noise:
        """Return the white noise. Where the motion is quick, a misfit that follows it varies as quickly as noise; and
        differences over each lag have all of the white noise, so that the least of their levels bounds it.
        """
        moving, level = self.slow & ~resting(driven.rate), white_level(self.residual)
        less = [level_of(self.residual, 1, moving)] if moving.sum() >= FEWEST_IN_STATE else []
        levels, known = known_levels(self.residual, finer(self.lags), self.slow)
        along = [most_along(self.residual, place) for place in driven.places(1)]
        least = min([level, *less, *along, *(levels / known).tolist()])
        return Noise(least if least * STAYS < level else level, 1)

    def beneath(self, noise: Noise) -> Noise:
        """Return a noise, or what is beneath it where it oscillates: its differences fall with the lag (`falls`), or
        are larger than the whole variation.
        """
        most = min(noise.level, local_rms(self.residual, noise.memory, self.slow))
        lags = finer(self.lags)
        levels, known = known_levels(self.residual, lags, self.slow)
        if not falls(levels, known) and level_of(self.residual, noise.memory, self.slow) <= STAYS**2 * most:
            return noise
        least, white = float(np.min((levels / known)[np.array(lags) >= noise.memory])), min(self.values)
        return Noise(least, noise.memory) if least > STAYS * white else Noise(white, 1)


def _quickens(levels: _Levels, noise: Noise, driven: Driven) -> bool:
    """Return whether a noise is rougher where the motion is quicker: what follows the motion is, and noise is not.

    Its roughness over a lag is the level there over that at its memory, which a machine that is louder while it moves
    leaves as it is. The two halves of the slow samples are compared, those of less and of more speed.
    """
    speed = uniform_filter1d(np.abs(driven.rate), 3 * noise.memory + 1, mode="nearest")
    quick = levels.slow & (speed > np.median(speed[levels.slow]))
    halves = (levels.slow & ~quick, quick)
    if min(half.sum() for half in halves) < FEWEST_LAGS * noise.memory:
        return False
    for lag in (lag for lag in finer(levels.lags) if lag < noise.memory):
        short, long = (
            [level_of(levels.residual, one, half) for half in halves] for one in (lag, noise.memory)
        )
        independent = np.array([half.sum() / one for half in halves for one in (lag, noise.memory)])
        known = float(known_part(1.0 / float(np.sum(1.0 / independent))))
        if short[1] * long[0] * known > STAYS * short[0] * long[1]:
            return True
    return False


def _swells(levels: _Levels, noise: Noise) -> bool:
    """Return whether a noise is louder in one part of the recording than in all others, which an amplifier's is not.

    There are FEWEST_LAGS parts, or fewer, of FEWEST_EVENTS memories each. F-test of the squared levels over a memory;
    two memories are one independent value there, since the noise of a steep filter is alike for longer than one.
    """
    memory, seen = noise.memory, np.flatnonzero(levels.slow)
    parts = np.array_split(seen, min(seen.size // (FEWEST_EVENTS * memory), FEWEST_LAGS) or 1)
    for part in parts if len(parts) > 1 else []:
        own = np.zeros(levels.slow.size, dtype=bool)
        own[part] = True
        both = own, levels.slow & ~own
        loud, other = (level_of(levels.residual, memory, where) for where in both)
        free = [float(where.sum()) / (2.0 * memory) for where in both]
        if len(parts) * f.sf((loud / max(other, 1e-300)) ** 2, *free) < NEGLIGIBLE:
            return True
    return False


def _slow_lags(driven: Driven) -> tuple[tuple[int, ...], BoolArray]:
    """Return the doubled lags for which the motion is slow enough in a part of the recording, and that part (n,)."""
    change, bend = driven.rate * driven.interval, driven.acceleration * driven.interval**2
    span, count = float(np.ptp(driven.deflection)), driven.deflection.size
    lags, slow = [1], np.ones(count, dtype=bool)
    while count >= FEWEST_LAGS * 2 * lags[-1]:
        slower = _where_slow(change, bend, span, 2 * lags[-1])
        if slower.sum() < FEWEST_LAGS * 2 * lags[-1]:
            break
        lags.append(2 * lags[-1])
        slow = slower
    return tuple(lags), slow


def _levels_of(residual: FloatArray, driven: Driven) -> _Levels:
    """Return the levels of a residual."""
    lags, slow = _slow_lags(driven)
    levels, known = known_levels(residual, lags, slow)
    return _Levels(residual, lags, slow, tuple(levels.tolist()), tuple(known.tolist()))


def _noise_at_plateau(levels: _Levels, driven: Driven) -> Noise | None:
    """Return the noise whose level stays constant over growing lags, without what repeats; None where none does."""
    last = plateau_at(levels.values, levels.known)
    if last == 0:
        return None
    found = levels.noise(last)
    if found.memory == 1:
        return levels.white(driven)
    found = levels.beneath(found)
    if found.memory == 1:
        return found
    if _quickens(levels, found, driven) or _swells(levels, found):
        return levels.white(driven)
    visits = _seen_visits(driven, found.memory, levels.lags[-1], levels.slow)
    between = [[level_between(levels.residual, lag, *v) for lag in levels.lags] for v in visits]
    if not all(map(plateau_at, between)):
        return None
    noises = [found, *(_noise_of_level(own, rising(own), plateau_at(own)) for own in between)]
    noises += [Noise(most_apart(levels.residual, found.memory, *v[:2]), found.memory) for v in visits]
    least, white = min(noises, key=lambda noise: noise.level), levels.white(driven)
    return least if least.level > STAYS * white.level else white


def _noises_at_whole_variation(
    levels: _Levels, driven: Driven, known: Sequence[Noise], *, fitted: bool = False
) -> Iterator[Noise]:
    """Return the noises whose level reaches the whole variation of the residual within a few lags, the longest first.

    Where no place is visited again, or where a signal of the motion would reach its variation too, one more lag has to
    show that the level stays, unless a tire was `fitted`; of such signals the residual must have nothing, unless the
    noise is known.
    """
    residual, slow = levels.residual, levels.slow
    rises = levels.rises
    for last in reversed(range(1, len(levels.lags))):
        found, lag = levels.noise(last), levels.lags[last]
        most, visits = local_rms(residual, lag, slow), _seen_visits(driven, found.memory, lag, slow)
        if found.memory == 1 or any(rises[last:]) or levels.values[last] * STAYS < most:
            continue
        if levels.beneath(found) is not found or _quickens(levels, found, driven) or _swells(levels, found):
            continue
        between = [level_between(residual, lag, *v) for v in visits]
        apart = [most_apart(residual, found.memory, *v[:2]) for v in visits]
        least = min([levels.values[last], *between, *apart])
        if least * STAYS < most:
            continue
        if any(map(Noise(least, found.memory).is_like, known)):
            yield Noise(least, found.memory)
            continue
        could = fitted or any(_may_follow(s, lag, slow, visits) for s in driven.signals.T)
        if (not visits or (could and not fitted)) and rises[min(last, len(rises) - 1)]:
            continue
        # Apart, since of all of them together a recording of a few hundred memories could not tell.
        shapes = [driven.signals, driven.late(found.memory), driven.shapes(found.memory, coarser=fitted)]
        if not (could and any(_follows(residual, own, found.memory) for own in shapes)):
            yield Noise(least, found.memory)


def _seen_visits(driven: Driven, memory: int, lag: int, seen: BoolArray) -> list[Visits]:
    """Return the pairs of each kind of visit (`Driven.visits`) with both samples `seen`.

    No kind with too few of them, or so near the ends that no difference over the lag is known.
    """
    inner = known_over(seen.size, lag)
    pairs = [
        (one[both], other[both], sign[both])
        for one, other, sign in driven.visits(memory)
        for both in [seen[one] & seen[other]]
    ]
    return [p for p in pairs if p[0].size >= FEWEST_EVENTS * memory and np.any(inner[p[0]] & inner[p[1]])]


def _may_follow(signal: FloatArray, lag: int, seen: BoolArray, visits: Sequence[Visits]) -> bool:
    """Return whether a misfit in proportion to a signal of the motion could be taken for noise of this memory.

    The lag shows the part r of the variation of the signal, beside white noise. To rise by the factor STAYS, and to
    come within that factor of the whole variation, it needs r^2 >= STAYS^2 - 1.
    """
    levels = [level_of(signal, lag, seen), *(level_between(signal, lag, *v) for v in visits)]
    return bool(min(levels) ** 2 >= (STAYS**2 - 1.0) * local_rms(signal, lag, seen) ** 2)


def _follows(residual: FloatArray, signals: FloatArray, memory: int) -> bool:
    """Return whether signals (n, k) explain a part of a residual (n,) that counts, beyond what they explain of a noise
    with a memory by chance (adjusted coefficient of determination: N. R. Draper, H. Smith, Applied Regression Analysis,
    1998, 5.2); True where there are too few memories for each of them to tell.
    """
    centred, columns = residual - residual.mean(), signals - signals.mean(axis=0)
    columns /= np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    coefficients, _, rank, _ = np.linalg.lstsq(columns, centred, rcond=None)
    free = residual.size / memory - 1.0
    if free < FEWEST_EVENTS * rank:
        return True
    left = float(np.sum((centred - columns @ coefficients) ** 2) / np.sum(centred**2))
    return bool(1.0 - left * free / (free - rank) > NEGLIGIBLE)


def _where_slow(change: FloatArray, bend: FloatArray, span: float, lag: int) -> BoolArray:
    """Return around which samples the motion is slow enough for the differences over a lag.

    change [m], bend [m]: first and second difference of the deflection; span [m] of the deflection. The frequency of a
    sine follows from bend over change, that of a triangle from change over span.
    """
    local = (uniform_filter1d(v**2, 3 * lag + 1, mode="nearest") for v in (change, bend))
    change_there, bend_there = (np.sqrt(np.maximum(mean, 0.0)) for mean in local)
    rests = change_there < STILL * float(np.sqrt(np.mean(change**2)))
    follows = bend_there * lag <= LONGEST_PHASE * change_there
    return np.asarray((rests | follows) & (np.pi * change_there * lag <= LONGEST_PHASE * span))


def _noise_of_level(levels: Sequence[float], rises: Sequence[bool], last: int) -> Noise:
    """Return the noise with the level `last`; its memory is that of the last rise before it, else 1."""
    risen = [i for i, rise in enumerate(rises[:last]) if rise]
    return Noise(levels[last], 2 ** (risen[-1] + 1)) if risen else Noise(levels[0], 1)
