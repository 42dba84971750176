"""The noise floor of a recording, source by source.

    amplifier: noise of the force's reading; one that steps by q errs by q / sqrt(12) at least, as a gauge does
    gauge:     noise of the deflection's reading times the stiffness
    steps:     a gauge that steps by q leaves stiffness x q / sqrt(12) (B. Widrow, Stat. theory of quantization, 1996)

What is left by the best tire cannot be less than all of them together, counted on the recorded samples.

A filter before the converter smooths the noise of a force: neighbours err alike. How many do so shows in differences
over growing lags, which rise until the lag is the noise's memory and then stay, where a smooth misfit rises on
(variogram: G. Matheron, Economic Geology 58 (1963) 1246-1266; third differences in place of first ones). A misfit is
smooth where the motion is slow, so each lag is looked at there: a quick part of a recording does not hide the memory
that a slow part shows. What comes again at the same deflection is no noise, however quick it is: a ripple of the tread.
Nor is what comes again on the same way from a turn: the knee of a loop, which a linear model follows in part. So the
lags are looked at once more in what differs between visits of one place (pure error of replicates: N. R. Draper, H.
Smith, Applied Regression Analysis, 1998, 2.1), and the least of these levels is the noise's.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from ..preprocessing.kinematics import STILL
from ..preprocessing.robust_scale import trimmed_sigma

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]
Scalar = TypeVar("Scalar", bound=np.generic)

SHARE_OF_STEP = 1.0 / float(np.sqrt(12.0))
"""Root mean square error of a reading that is rounded to steps, in steps."""

STAYS = float(np.sqrt(2.0) ** 0.5)
"""Growth of the differences for a doubled lag below which they stay: half the exponent of a random walk, the roughest
noise that has a memory."""

FEWEST_LAGS = 20
"""Lags that a recording holds at least: noise that is independent a lag apart has its scale known to a sixth then."""

LONGEST_PHASE = float(2.0 * np.pi / 3.0)
"""Phase p [rad] of the motion over the longest lag: third differences of a sine, (2 sin(p / 2))^3 of it, are five times
those over half the lag there. A level that does not rise so far is a noise's."""

OF_THIRD = float(np.sqrt(20.0))
"""Standard deviation of third differences of white noise of one: 1 + 9 + 9 + 1 squared weights."""


@dataclass(frozen=True)
class NoiseFloor:
    """amplifier, gauge, steps [N]: root mean squares at the recorded samples; step [m] of the gauge, 0: none seen."""

    amplifier: float
    gauge: float
    steps: float
    step: float

    @property
    def level(self) -> float:
        """All of it [N]."""
        return float(np.sqrt(self.amplifier**2 + self.gauge**2 + self.steps**2))


@dataclass(frozen=True)
class Noise:
    """level: standard deviation of a sample; memory: samples from one to the next that errs independently."""

    level: float
    memory: int


def white_level(residual: FloatArray) -> float:
    """Return the standard deviation of what differs from sample to sample, from third differences."""
    if residual.size < 8:
        return float(np.std(residual))
    return _level(_third_differences(residual, 1))


def noise_of(
    residual: FloatArray, interval: float, deflection: FloatArray, rate: FloatArray, acceleration: FloatArray
) -> Noise:
    """Return the noise of a residual, white or with a memory.

    interval [s] from sample to sample; deflection [m], rate [m/s] and acceleration [m/s^2]: the motion beside them
    """
    span = float(np.ptp(deflection))
    lags, slow = [1], np.ones(residual.size, dtype=bool)
    while residual.size >= FEWEST_LAGS * 2 * lags[-1]:
        slower = _slow(rate * interval, acceleration * interval**2, span, 2 * lags[-1])
        if slower.sum() < FEWEST_LAGS * 2 * lags[-1]:
            break
        lags.append(2 * lags[-1])
        slow = slower
    found = _resting([_level(_third_differences(residual, lag)[_inner(slow, lag)]) for lag in lags])
    if found.memory == 1:
        return Noise(white_level(residual), 1)
    for one, other in _visits(deflection, found.memory):
        seen = slow[one] & slow[other]
        visits = one[seen], other[seen]
        if visits[0].size >= FEWEST_LAGS * found.memory:
            own = _resting([_level_between(residual, lag, *visits) for lag in lags])
            found = min(found, own, key=lambda noise: noise.level)
    return found


def _slow(change: FloatArray, bend: FloatArray, span: float, lag: int) -> BoolArray:
    """Return around which samples the motion is slow enough for the differences over a lag.

    change [m], bend [m]: of the deflection, first and second, from sample to sample; span [m]: all of it. The
    frequency of a sine is that of its bend over its change, that of a triangle follows from change and span.
    """
    local = (uniform_filter1d(v**2, 3 * lag + 1, mode="nearest") for v in (change, bend))
    change_there, bend_there = (np.sqrt(np.maximum(mean, 0.0)) for mean in local)
    rests = change_there < STILL * float(np.sqrt(np.mean(change**2)))
    follows = bend_there * lag <= LONGEST_PHASE * change_there
    return np.asarray((rests | follows) & (np.pi * change_there * lag <= LONGEST_PHASE * span))


def _resting(levels: list[float]) -> Noise:
    """Return the noise that levels over doubled lags show: where they rise and then stay, else that of the first."""
    # The differences of a noise with a memory never fall with the lag: what rises after a fall is chance.
    highest = list(itertools.accumulate(levels, max))
    rises = [after >= STAYS * before for before, after in zip(highest, levels[1:], strict=False)]
    # One doubling without a rise may be chance between two rises: a level holds over a factor of four.
    last = max((i + 1 for i, pair in enumerate(itertools.pairwise(rises)) if not any(pair)), default=0)
    risen = [i for i in range(last) if rises[i]]
    return Noise(levels[last], 2 ** (risen[-1] + 1)) if risen else Noise(levels[0], 1)


def _visits(deflection: FloatArray, memory: int) -> Iterator[tuple[IntArray, IntArray]]:
    """Return pairs of samples of two visits: at one deflection, at one on the same way, as far on it from its turn.

    Two are of different visits if they are four memories apart, and at one place within half a memory's way.
    """
    near = 0.5 * float(np.median(np.abs(deflection[memory:] - deflection[:-memory])))
    inwards = np.gradient(uniform_filter1d(deflection, 2 * memory + 1, mode="nearest")) > 0.0
    begin = np.append(0, np.flatnonzero(np.diff(inwards)) + 1)
    turn = begin[np.searchsorted(begin, np.arange(deflection.size), side="right") - 1]
    way = 2.0 * float(np.ptp(deflection)) * inwards
    for place in (deflection, deflection + way, np.abs(deflection - deflection[turn]) + way):
        order = np.argsort(place, kind="stable")
        one, other = order[:-1], order[1:]
        pairs = (np.abs(one - other) > 4 * memory) & (place[other] - place[one] <= near)
        yield one[pairs], other[pairs]


def _level_between(residual: FloatArray, lag: int, one: IntArray, other: IntArray) -> float:
    """Return the level as of `white_level`, of what differs between visits."""
    differences = np.full(residual.size, np.nan)
    _inner(differences, lag)[:] = _third_differences(residual, lag)
    between = differences[one] - differences[other]
    return _level(between[np.isfinite(between)]) / float(np.sqrt(2.0))


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
    gauge_noise [m]: of the deflection's reading; step [m], force_step [N]: in which the two are
    read, 0 where none is seen
    """
    mean_square = float(np.sqrt(np.mean(stiffness**2)))
    through_gauge = 0.0 if step > 0.0 else gauge_noise * mean_square
    through_steps = step * SHARE_OF_STEP * mean_square
    whole = max(level, force_step * SHARE_OF_STEP)
    amplifier = float(np.sqrt(max(whole**2 - through_gauge**2, 0.05 * whole**2)))
    return NoiseFloor(amplifier, through_gauge, through_steps, step)
