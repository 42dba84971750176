"""Levels of a residual: how much of it varies within a lag, between visits of one place, and along a place.

Third differences over a lag have all of a white noise, and of a smooth misfit next to nothing (variogram: G. Matheron,
Economic Geology 58 (1963) 1246-1266; third differences in place of first ones). Between visits of one place all of a
noise differs, and nothing of a misfit that depends on the place, however quickly it changes there (pure error of
replicates: N. R. Draper, H. Smith, Applied Regression Analysis, 1998, 2.1; J. Rice, Annals of Statistics 12 (1984)
1215-1230).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from .driven import FEWEST_LAGS
from .spread import TRIMMED, trimmed_sigma

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]

Scalar = TypeVar("Scalar", bound=np.generic)

STAYS = float(np.sqrt(2.0) ** 0.5)
"""Factor of growth for a doubled lag below which differences count as constant: half the exponent of a random walk, the
roughest noise that has a memory."""

FEWEST = 0.5 * (2.0 * TRIMMED) ** 2
"""Number of independent values from which on a level is known to a half; fewer count as these."""

OF_THIRD = float(np.sqrt(20.0))
"""Standard deviation of third differences of white noise of standard deviation 1: the squared weights 1 + 9 + 9 + 1."""


FEWEST_READINGS = 8
"""Fewest readings of which third differences, five then, tell a level."""

FEWEST_IN_STATE = 5 * FEWEST_LAGS
STATE_LAGS = (1, 2, 4, 8, 16)
"""Fewest samples at rest, or moving, whose noise is then known to a tenth, and the lags over which it has to stay."""


def white_level(residual: FloatArray) -> float:
    """Return the standard deviation of the part of a residual (n,) that is white, from its third differences."""
    return (
        _level(_third_differences(residual, 1))
        if residual.size >= FEWEST_READINGS
        else float(np.std(residual))
    )


def local_rms(values: FloatArray, lag: int, seen: BoolArray) -> float:
    """Return the root mean square of values about their mean over four lags, where they are `seen`."""
    varied = values - uniform_filter1d(values, 4 * lag + 1, mode="nearest")
    return float(np.sqrt(np.mean(varied[seen] ** 2)))


def plateau_at(levels: Sequence[float], known: Sequence[float] = ()) -> int:
    """Return the index of the last level from which on the levels over doubled lags stay constant; 0 where none is."""
    # One doubling without a rise may be chance between two rises: the level has to hold over a factor of four.
    pairs = enumerate(itertools.pairwise(rising(levels, known)))
    return max((i + 1 for i, pair in pairs if not any(pair)), default=0)


def rising(levels: Sequence[float], known: Sequence[float] = ()) -> list[bool]:
    """Return whether each level but the first is a rise over those before it, by more than counts as constant and, with
    the `known_part` of each, than chance.
    """
    # The differences of a noise with a memory never fall with the lag: what rises after a fall is chance.
    highest, parts = itertools.accumulate(levels, max), known or [1.0] * len(levels)
    later = zip(highest, levels[1:], parts[1:], strict=False)
    return [min(part, 1.0 / STAYS) * after >= before for before, after, part in later]


def finer(lags: Sequence[int]) -> tuple[int, ...]:
    """Return doubled lags and those between them: over powers of two, a period of three samples has one level."""
    return tuple(sorted({*lags, *(3 * lag // 2 for lag in lags[1:-1])}))


def known_part(independent: FloatArray | float) -> FloatArray:
    """Return the least part of the level of a noise that so many independent values show by chance (TRIMMED)."""
    return np.asarray(1.0 - TRIMMED / np.sqrt(2.0 * np.maximum(independent, FEWEST)))


def known_levels(residual: FloatArray, lags: Sequence[int], seen: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return the levels over lags, and their `known_part` each."""
    levels = np.array([level_of(residual, lag, seen) for lag in lags])
    return levels, known_part(seen.sum() / np.array(lags))


def falls(levels: FloatArray, known: FloatArray) -> bool:
    """Return whether levels fall with the lag by more than they are known to and than counts as constant, as those of a
    noise do not. Third differences of a sine are up to 1.8 times its level at one lag, and next to none at others.
    """
    return bool(np.any(levels < np.minimum(known, 1.0 / STAYS) * np.maximum.accumulate(levels)))


@dataclass(frozen=True)
class NoiseProfile:
    """How a white noise differs between the samples of a recording: a machine that moves may be louder than one that
    rests, and a load cell or a stiff part louder under some load than under another.

    at_rest, moving: factors of the state; loads [N], by_load: factors of the load, whatever its sign; between these
    loads the variance is linear in the square of the load. The factor of all samples together is 1.
    """

    at_rest: float = 1.0
    moving: float = 1.0
    loads: tuple[float, ...] = (0.0,)
    by_load: tuple[float, ...] = (1.0,)

    def of_load(self, load: FloatArray) -> FloatArray:
        """Return the factor of the load (n,) [N] alone."""
        return np.sqrt(np.interp(load**2, np.square(self.loads), np.square(self.by_load)))

    def of_state(self, rests: BoolArray) -> FloatArray:
        """Return the factor of rest and motion alone."""
        return np.where(rests, self.at_rest, self.moving)

    def of(self, rests: BoolArray, load: FloatArray) -> FloatArray:
        """Return the factors of samples (n,)."""
        return np.asarray(self.of_state(rests) * self.of_load(load))


def levels_by_state(
    residual: FloatArray, rests: BoolArray, least: float, *, differ: bool = False
) -> tuple[float, float]:
    """Return the noise of a residual (n,) while the tire rests (n,) and while it moves, over its white part; 1 and 1
    where their white parts are alike, one is hardly seen, or one keeps growing with the lag, as what follows a motion,
    or falls, as an oscillation.
    least: that counts; differ: whether they are known not to be alike
    """
    states = [state for state in (rests, ~rests) if state.sum() >= FEWEST_IN_STATE]
    levels = [[max(level_of(residual, lag, s), least) for lag in STATE_LAGS] for s in states]
    if len(levels) < 2 or not all(map(plateau_at, levels)):
        return 1.0, 1.0
    if any(falls(*known_levels(residual, finer(STATE_LAGS), s)) for s in states):
        return 1.0, 1.0
    white = [own[0] for own in levels]
    if not differ and max(white) < STAYS**4 * min(white):
        return 1.0, 1.0
    at_rest, moving = (max(own) / max(white_level(residual), least) for own in levels)
    return at_rest, moving


LOADS = (2, 4, 8)
"""Numbers of loads for which the level of a noise is told, one after the other: as many samples have each."""


def levels_by_load(
    residual: FloatArray, load: FloatArray, least: float, before: NoiseProfile
) -> NoiseProfile:
    """Return how the noise of a residual (n,) differs with the load (n,) [N], in addition to the profile `before`;
    `before` where it does not differ, or differs between lags at one load by more than the root of what it differs by
    between the loads.

    residual: over the noise of the profile before; least: that counts
    Where a cycle passes all loads within a few lags, differences at one see the noise of others; so a few loads come
    first, and then more of what is left over the noise at these.
    """
    size, found = np.abs(load), before
    loads = np.array([np.median(size[part]) for part in _parts_of(size, LOADS[-1])])
    for count in LOADS:
        parts = _parts_of(size, count)
        numbers = np.array([part.sum() for part in parts])
        if numbers.min() < FEWEST_IN_STATE:
            break
        even = residual * before.of_load(load) / found.of_load(load)
        levels = [known_levels(even, finer(STATE_LAGS), part) for part in parts]
        white = np.array([max(float(own[0]), least) for own, _ in levels])
        at = np.array([np.sqrt(np.mean(size[part] ** 2)) for part in parts])
        factors = found.of_load(loads) * np.sqrt(np.interp(loads**2, at**2, white**2))
        # What differs as much between lags at one load is what the force does there, and may do at all of them.
        if max(map(_between_lags, levels)) > max(STAYS, float(np.sqrt(factors.max() / factors.min()))):
            return before
        if len(parts) > 1 and _differ(white, known_part(numbers)):
            shape = replace(found, loads=tuple(loads.tolist()), by_load=tuple(factors.tolist()))
            whole = float(np.sqrt(np.mean(shape.of_load(load) ** 2)))
            found = replace(shape, by_load=tuple((factors / whole).tolist()))
    return found


def _between_lags(levels: tuple[FloatArray, FloatArray]) -> float:
    """Return by which factor levels over lags, with their `known_part`, differ beyond chance."""
    own, known = levels
    return float(np.max(own * known) / max(float(np.min(own / known)), 1e-300))


def _parts_of(size: FloatArray, count: int) -> list[BoolArray]:
    """Return which of so many parts, with as many samples each, the samples of a size are in; equal ones in one."""
    edges = np.unique(np.quantile(size, np.linspace(0.0, 1.0, count + 1)[1:-1]))
    which = np.searchsorted(edges, size, side="right")
    return [which == i for i in np.unique(which)]


def _differ(levels: FloatArray, known: FloatArray) -> bool:
    """Return whether levels differ by more than those of one noise, and than chance; known: the part that is known."""
    quiet, loud = int(np.argmin(levels)), int(np.argmax(levels))
    return bool(levels[quiet] < min(1.0 / STAYS, float(known[quiet] * known[loud])) * levels[loud])


def known_over(count: int, lag: int) -> BoolArray:
    """Return in the middle of which of so many samples a third difference over a lag is taken."""
    known = np.zeros(count, dtype=bool)
    _inner(known, lag)[:] = True
    return known


def level_between(residual: FloatArray, lag: int, one: IntArray, other: IntArray, sign: FloatArray) -> float:
    """Return the level over a lag of what differs between visits, and nothing of what is slow."""
    differences = np.full(residual.size, np.nan)
    _inner(differences, lag)[:] = _third_differences(residual, lag)
    between = differences[one] - sign * differences[other]
    return _level(between[np.isfinite(between)]) / float(np.sqrt(2.0))


def most_apart(residual: FloatArray, memory: int, one: IntArray, other: IntArray) -> float:
    """Return the largest standard deviation of a noise with a memory beside which so little differs between visits.

    Of a force over the place that is nothing, at any speed, where differences over a lag see other lengths of it.
    """
    apart = trimmed_sigma(residual[one] - residual[other]) / float(np.sqrt(2.0))
    return apart / float(known_part(one.size / memory))


def most_along(residual: FloatArray, place: FloatArray) -> float:
    """Return the largest white noise beside which so little differs between neighbours along a place (n,)."""
    return white_level(residual[np.argsort(place, kind="stable")]) / float(known_part(residual.size))


def level_of(values: FloatArray, lag: int, seen: BoolArray) -> float:
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
