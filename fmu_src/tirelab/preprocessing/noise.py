"""The noise of a misfit, and the noise floor of a recording.

The noise floor is the root mean square of all sources together over the recorded samples:

    amplifier: noise of the force's reading; one that steps by q errs by q / sqrt(12) at least, as a gauge does
    gauge:     noise of the deflection's reading times the stiffness
    steps:     a gauge that steps by q leaves stiffness x q / sqrt(12)

A filter before the converter correlates the noise of neighbouring force samples. The correlation length, here the
memory of the noise, shows in differences over growing lags: they rise up to the memory and then stay constant, while
those of a smooth misfit keep rising (variogram: G. Matheron, Economic Geology 58 (1963) 1246-1266; third differences in
place of first ones). They stay constant as well once they have reached the whole variation, which is all that a short
recording can show. A misfit that follows the motion is smooth where the motion is slow, so the differences of each lag
are taken there; a quick part of a recording then does not hide the memory that a slow part shows.

What repeats at the same deflection is not noise, however quickly it changes: a ripple of the tread, for instance. Nor
is what repeats at the same distance from a reversal: the knee of a loop, which a linear model follows only in part. So
the differences are also taken between visits of the same place (pure error of replicates: N. R. Draper, H. Smith,
Applied Regression Analysis, 1998, 2.1); the smallest of all these levels is that of the noise.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from .driven import FEWEST_LAGS, Driven, Visits
from .spread import TRIMMED, trimmed_sigma

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]


STILL = 0.02
"""Speed over its root mean square, or its largest, below which the tire rests."""

NEGLIGIBLE = 0.05
"""Part of a whole that does not count: of the samples, of a variance, of a noise's size, of a prior; a chance."""

STANDS_OUT = 8.0
"""Noise standard deviations: a gauge whose reading stays within them stands still, what is beyond them is no noise."""

FEWEST_EVENTS = 10
"""Fewest events that are no chance: samples of a hold, changes of a reading, memories of noise between two visits, or
for each shape that a misfit may have."""

Scalar = TypeVar("Scalar", bound=np.generic)

SHARE_OF_STEP = 1.0 / float(np.sqrt(12.0))
"""Root mean square error of a reading that is rounded to steps, in steps."""

STAYS = float(np.sqrt(2.0) ** 0.5)
"""Factor of growth for a doubled lag below which differences count as constant: half the exponent of a random walk, the
roughest noise that has a memory."""

FEWEST_IN_STATE = 5 * FEWEST_LAGS
STATE_LAGS = (1, 2, 4, 8, 16)
"""Fewest samples at rest, or moving, whose noise is then known to a tenth, and the lags over which it has to stay."""

LONGEST_PHASE = float(2.0 * np.pi / 3.0)
"""Phase p [rad] of the motion over the longest lag. Third differences of a sine are (2 sin(p / 2))^3 times it, at this
phase five times those over half the lag; a level that does not rise so much is that of noise."""

OF_THIRD = float(np.sqrt(20.0))
"""Standard deviation of third differences of white noise of standard deviation 1: the squared weights 1 + 9 + 9 + 1."""


@dataclass(frozen=True)
class NoiseFloor:
    """amplifier, gauge, steps [N]: root mean squares at the recorded samples; step [m] of the gauge, 0: none seen."""

    amplifier: float
    gauge: float
    steps: float
    step: float

    @property
    def level(self) -> float:
        """The whole noise floor [N]: root of the sum of squares."""
        return float(np.sqrt(self.amplifier**2 + self.gauge**2 + self.steps**2))


@dataclass(frozen=True)
class Noise:
    """level: standard deviation of one sample; memory: number of samples after which errors are independent."""

    level: float
    memory: int


def white_level(residual: FloatArray) -> float:
    """Return the standard deviation of the part of a residual (n,) that is white, from its third differences."""
    return _level(_third_differences(residual, 1)) if residual.size >= 8 else float(np.std(residual))


def resting(rate: FloatArray) -> BoolArray:
    """Return at which samples (n,) the tire rests; rate (n,) [m/s]."""
    return np.asarray(np.abs(rate) <= STILL * float(np.abs(rate).max()))


def levels_by_state(
    residual: FloatArray, rests: BoolArray, least: float, *, differ: bool = False
) -> tuple[float, float]:
    """Return the noise of a residual (n,) while the tire rests (n,) and while it moves, over its white part; 1 and 1
    where their white parts are alike, one is hardly seen, or one keeps growing with the lag, as what follows a motion.
    least: that counts; differ: whether they are known not to be alike
    """
    states = [state for state in (rests, ~rests) if state.sum() >= FEWEST_IN_STATE]
    levels = [[max(_level_of(residual, lag, s), least) for lag in STATE_LAGS] for s in states]
    if len(levels) < 2 or not all(map(_plateau, levels)):
        return 1.0, 1.0
    white = [own[0] for own in levels]
    if not differ and max(white) < STAYS**4 * min(white):
        return 1.0, 1.0
    at_rest, moving = (max(own) / max(white_level(residual), least) for own in levels)
    return at_rest, moving


Left = Callable[[FloatArray], FloatArray]
"""Of signals (n, k) of the motion what a model leaves (n, k), fitted to them as it was to the misfit."""


def noise_of(residual: FloatArray, driven: Driven, left: Left | None = None) -> Noise:
    """Return the noise of a residual (n,), white or with a memory.

    left: of the model that left the residual. What is slow has gone into the model, so what is left of a kink that it
    cannot follow varies within a few lags, as a noise with a memory does; then the residual must have none of it.
    """
    levels = _levels_of(residual, driven)
    plateau = _noise_at_plateau(levels, driven)
    kinks = None
    for found in [plateau] if plateau else _noises_at_whole_variation(levels, driven):
        if found.memory == 1 or left is None:
            return found
        kinks = left(driven.kinks) if kinks is None else kinks
        visits = _seen_visits(driven, found.memory, found.memory, levels.slow)
        could = any(_may_follow(kink, found.memory, levels.slow, visits) for kink in kinks.T)
        follows = could and _follows(residual, left(driven.shapes(found.memory)), found.memory)
        # Beside a level that stays over long lags, a line is a part of the misfit that they do not see.
        if not follows and (plateau or not _rings(residual, found.memory)):
            return found
    return levels.white(driven)


@dataclass(frozen=True)
class _Levels:
    """Levels of a residual over doubled lags, `values`, at the samples where the motion is slow enough for all lags."""

    residual: FloatArray
    lags: tuple[int, ...]
    slow: BoolArray
    values: tuple[float, ...]

    def white(self, driven: Driven) -> Noise:
        """Return the white noise: where the motion is quick, a misfit that follows it varies as quickly as noise."""
        moving, level = self.slow & ~resting(driven.rate), white_level(self.residual)
        if moving.sum() >= FEWEST_IN_STATE and (less := _level_of(self.residual, 1, moving)) * STAYS < level:
            level = less
        return Noise(level, 1)

    def beneath(self, noise: Noise) -> Noise:
        """Return a noise, or what is beneath it where it oscillates: its differences are larger than over longer lags,
        or than the whole variation, or fall with the lag by more than they are known to (TRIMMED) and than counts as
        constant. Third differences of a sine are up to 1.8 times its level at one lag, and next to none at others.
        """
        most = min(noise.level, _local_rms(self.residual, noise.memory, self.slow))
        # Over lags that are powers of two a period of twelve has one level.
        lags = np.array(sorted({*self.lags, *(3 * lag // 2 for lag in self.lags[1:-1])}))
        levels = np.array([_level_of(self.residual, lag, self.slow) for lag in lags.tolist()])
        known = 1.0 - TRIMMED / np.sqrt(2.0 * np.maximum(self.slow.sum() / lags, 1.0))
        falls = np.any(levels < np.minimum(known, 1.0 / STAYS) * np.maximum.accumulate(levels))
        if not falls and _level_of(self.residual, noise.memory, self.slow) <= STAYS**2 * most:
            return noise
        least, white = float(np.min((levels / known)[lags >= noise.memory])), min(self.values)
        return Noise(least, noise.memory) if least > STAYS * white else Noise(white, 1)


def _levels_of(residual: FloatArray, driven: Driven) -> _Levels:
    """Return the levels of a residual."""
    change, bend = driven.rate * driven.interval, driven.acceleration * driven.interval**2
    span = float(np.ptp(driven.deflection))
    lags, slow = [1], np.ones(residual.size, dtype=bool)
    while residual.size >= FEWEST_LAGS * 2 * lags[-1]:
        slower = _where_slow(change, bend, span, 2 * lags[-1])
        if slower.sum() < FEWEST_LAGS * 2 * lags[-1]:
            break
        lags.append(2 * lags[-1])
        slow = slower
    return _Levels(residual, tuple(lags), slow, tuple(_level_of(residual, lag, slow) for lag in lags))


def _noise_at_plateau(levels: _Levels, driven: Driven) -> Noise | None:
    """Return the noise whose level stays constant over growing lags, without what repeats; None where none does."""
    last = _plateau(levels.values)
    if last == 0:
        return None
    found = _noise_of_level(levels.values, last)
    if found.memory == 1:
        return levels.white(driven)
    found = levels.beneath(found)
    if found.memory == 1:
        return found
    visits = _seen_visits(driven, found.memory, levels.lags[-1], levels.slow)
    between = [[_level_between(levels.residual, lag, *v) for lag in levels.lags] for v in visits]
    if not all(map(_plateau, between)):
        return None
    noises = (found, *(_noise_of_level(own, _plateau(own)) for own in between))
    return min(noises, key=lambda noise: noise.level)


def _noises_at_whole_variation(levels: _Levels, driven: Driven) -> Iterator[Noise]:
    """Return the noises whose level reaches the whole variation of the residual within a few lags, the longest first.

    Where no place is visited again, or where a signal of the motion would reach its variation too, one more lag has to
    show that the level stays; of such signals the residual must have nothing.
    """
    residual, slow = levels.residual, levels.slow
    rises = _rises(levels.values)
    for last in reversed(range(1, len(levels.lags))):
        found, lag = _noise_of_level(levels.values, last), levels.lags[last]
        most, visits = _local_rms(residual, lag, slow), _seen_visits(driven, found.memory, lag, slow)
        if found.memory == 1 or any(rises[last:]) or levels.values[last] * STAYS < most:
            continue
        if levels.beneath(found) is not found:
            continue
        least = min([levels.values[last], *(_level_between(residual, lag, *v) for v in visits)])
        could = any(_may_follow(s, lag, slow, visits) for s in driven.signals.T)
        if least * STAYS < most or ((could or not visits) and rises[min(last, len(rises) - 1)]):
            continue
        shapes = [driven.signals, driven.shapes(found.memory)]
        if not (could and _follows(residual, np.column_stack(shapes), found.memory)):
            yield Noise(least, found.memory)


def _seen_visits(driven: Driven, memory: int, lag: int, seen: BoolArray) -> list[Visits]:
    """Return the pairs of each kind of visit (`Driven.visits`) with both samples `seen`.

    No kind with too few of them, or so near the ends that no difference over the lag is known.
    """
    inner = np.zeros_like(seen)
    _inner(inner, lag)[:] = True
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
    levels = [_level_of(signal, lag, seen), *(_level_between(signal, lag, *v) for v in visits)]
    return bool(min(levels) ** 2 >= (STAYS**2 - 1.0) * _local_rms(signal, lag, seen) ** 2)


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


def _rings(residual: FloatArray, memory: int) -> bool:
    """Return whether a residual (n,) has a spectral line that a noise with a memory has by a chance of NEGLIGIBLE at
    most: R. A. Fisher, Proc. R. Soc. A 125 (1929) 54-59. A memory is known to a factor of two.
    """
    power = np.abs(np.fft.rfft(residual - residual.mean())) ** 2
    independent = residual.size / (4.0 * memory)
    return bool(independent * (1.0 - power.max() / power.sum()) ** (independent - 1.0) < NEGLIGIBLE)


def _local_rms(values: FloatArray, lag: int, seen: BoolArray) -> float:
    """Return the root mean square of values about their mean over four lags, where they are `seen`."""
    varied = values - uniform_filter1d(values, 4 * lag + 1, mode="nearest")
    return float(np.sqrt(np.mean(varied[seen] ** 2)))


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


def _plateau(levels: Sequence[float]) -> int:
    """Return the index of the last level from which on the levels over doubled lags stay constant; 0 where none is."""
    # One doubling without a rise may be chance between two rises: the level has to hold over a factor of four.
    pairs = enumerate(itertools.pairwise(_rises(levels)))
    return max((i + 1 for i, pair in pairs if not any(pair)), default=0)


def _noise_of_level(levels: Sequence[float], last: int) -> Noise:
    """Return the noise with the level `last`; its memory is that of the last rise before it, else 1."""
    risen = [i for i, rise in enumerate(_rises(levels)[:last]) if rise]
    return Noise(levels[last], 2 ** (risen[-1] + 1)) if risen else Noise(levels[0], 1)


def _rises(levels: Sequence[float]) -> list[bool]:
    """Return whether each level but the first is a rise over those before it."""
    # The differences of a noise with a memory never fall with the lag: what rises after a fall is chance.
    highest = itertools.accumulate(levels, max)
    return [after >= STAYS * before for before, after in zip(highest, levels[1:], strict=False)]


def _level_between(residual: FloatArray, lag: int, one: IntArray, other: IntArray, sign: FloatArray) -> float:
    """Return the level as of `white_level`, of what differs between visits."""
    differences = np.full(residual.size, np.nan)
    _inner(differences, lag)[:] = _third_differences(residual, lag)
    between = differences[one] - sign * differences[other]
    return _level(between[np.isfinite(between)]) / float(np.sqrt(2.0))


def _level_of(values: FloatArray, lag: int, seen: BoolArray) -> float:
    """Return the level as of `white_level`, over a lag, where the values are `seen`."""
    return _level(_third_differences(values, lag)[_inner(seen, lag)])


def _level(third_differences: FloatArray) -> float:
    return trimmed_sigma(third_differences) / OF_THIRD


def _inner(values: NDArray[Scalar], lag: int) -> NDArray[Scalar]:
    """Return the view of those values in whose middle a third difference over a lag is taken."""
    return values[(3 * lag) // 2 :][: values.size - 3 * lag]


def _third_differences(values: FloatArray, lag: int) -> FloatArray:
    """Return v(i + 3 lag) - 3 v(i + 2 lag) + 3 v(i + lag) - v(i)."""
    ends = values[3 * lag :] - values[: -3 * lag]
    return ends - 3.0 * (values[2 * lag : -lag] - values[lag : -2 * lag])


def noise_floor(
    level: float, stiffness: FloatArray, gauge_noise: float, step: float, force_step: float
) -> NoiseFloor:
    """Return the floor of a recording.

    level [N]: noise of the force less what a smooth model makes of it; stiffness [N/m] sample by sample
    gauge_noise [m]: of the deflection's reading; step [m], force_step [N]: in which the two are read, 0 for none
    """
    mean_square = float(np.sqrt(np.mean(stiffness**2)))
    through_gauge = 0.0 if step > 0.0 else gauge_noise * mean_square
    through_steps = step * SHARE_OF_STEP * mean_square
    whole = max(level, force_step * SHARE_OF_STEP)
    amplifier = float(np.sqrt(max(whole**2 - through_gauge**2, NEGLIGIBLE * whole**2)))
    return NoiseFloor(amplifier, through_gauge, through_steps, step)
