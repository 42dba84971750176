"""The readings of a gauge: their noise, and the steps in which they are read.

A gauge that reads in steps of q errs by up to q / 2 either way, with the standard deviation q / sqrt(12) (B. Widrow,
I. Kollar, "Quantization Noise", Cambridge 2008, chapter 5). Random noise of variance s^2 gives fifth differences of
variance 252 s^2, to which a smooth motion adds next to nothing, and one of few samples a cycle nothing above five
samples a cycle (`HIGH_PASS`). They do not show the steps where the motion is slow, because most readings repeat the
last one, or where it is nearly even, because most steps are alike. Of readings that are not even in time they show how
uneven these are. Noise then counts where it turns the motion to and fro.

`gauge_step` finds a step by its rounding, beside which most readings may differ. `staircase_step` finds one so coarse
that readings repeat: its stays and jumps are removed from the deflection (`destepped`) before a rate is taken.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .driven import FEWEST_EVENTS
from .noise import NEGLIGIBLE
from .spread import robust_sigma

FloatArray = NDArray[np.float64]

LEAST_NOISE, FINEST_STEP = 1e-9, 5e-7
"""Smallest noise [m] that is returned, and smallest step [m] of a gauge: no gauge reads a tire's deflection to a
nanometre, and finer steps are the digits of a file, whose rounding is less than every other noise."""

SMALL = 1e-3
"""Span [m] of the readings below which both limits shrink in proportion to it: small specimens have finer gauges."""

LEAST_LEVELS = 100
"""Steps from the smallest to the largest reading; fewer are a staircase that the rig was driven through."""

GRID_TOLERANCE = 0.25
"""Largest distance of a reading from the grid of steps, as a part of a step: a file rounds what a gauge has read."""


HALF, HIGHEST, STOPPED = 15, 0.3, 7.9
"""Samples on either side, frequency [1/sample] and Kaiser's beta of a window that halves what has this frequency, and
stops all but 1e-4 of what has five samples a cycle or more (J. F. Kaiser, Proc. IEEE ISCAS (1974) 20)."""


def _high_pass() -> FloatArray:
    """Return the weights of fifth differences of what has less than five samples a cycle, of a sum of squares of 1."""
    place = np.arange(HALF + 1 + HALF) - HALF
    passed = 2.0 * HIGHEST * np.sinc(2.0 * HIGHEST * place) * np.kaiser(place.size, STOPPED)
    weights = np.diff(np.pad((place == 0) - passed / passed.sum(), 5), 5)
    return np.asarray(weights / np.linalg.norm(weights))


HIGH_PASS = _high_pass()
"""Weights of what is left of readings for their noise where a cycle of the motion has few samples."""


def deflection_noise(deflection: FloatArray, *, timed: bool = True) -> float:
    """Return the standard deviation [m] of the noise of readings (n,) [m], n >= 6; at least 1e-9 m, or a millionth of
    their span where that is less.

    timed: whether they are known to be even in time
    Readings rounded to steps q without other noise have q / sqrt(12), those with other noise at least that.
    """
    least = LEAST_NOISE * _shrunk(deflection)
    random = _random_noise(deflection) if timed or _trembles(deflection) else 0.0
    step = gauge_step(deflection)
    rounding = step / np.sqrt(12.0)
    # A smooth motion that is only rounded has second differences of -q, 0 and q.
    if step > 0.0 and np.mean(np.abs(np.diff(deflection, 2)) > 1.5 * step) < NEGLIGIBLE:
        return float(max(rounding, least))
    return float(max(random, rounding, least))


def _random_noise(deflection: FloatArray) -> float:
    """Return the standard deviation [m] of what is random in readings that are even in time."""
    random = float(robust_sigma(np.diff(deflection, 5)) / np.sqrt(252.0))
    if deflection.size < 2 * HIGH_PASS.size:
        return random
    above = float(robust_sigma(np.convolve(deflection - deflection.mean(), HIGH_PASS, mode="valid")))
    # Other noise than white has less there too; most of the differences has to be the motion's.
    return above if above < 0.5 * random else random


def read_again(
    deflection: FloatArray, read: FloatArray, noise: float, step: float, random: np.random.Generator
) -> FloatArray:
    """Return other readings [m] of a motion (n,) [m] that a gauge with this noise [m] has `read` (n,) [m].

    step [m]: in which it reads, 0 for none; the steps are part of the noise, and now lie between those of `read`
    """
    beside_steps = float(np.sqrt(max(noise**2 - step**2 / 12.0, 0.0)))
    anew = deflection + random.normal(0.0, beside_steps, deflection.size)
    if step == 0.0:
        return np.asarray(anew)
    between = float(read[0]) + 0.5 * step
    return np.asarray(between + step * np.rint((anew - between) / step))


def _trembles(deflection: FloatArray) -> bool:
    """Return whether readings turn twice within three steps more than now and then, as a motion does not.

    White noise that is larger than the steps of the motion does so at 5 of 12 samples.
    """
    turns = np.diff(deflection[1:]) * np.diff(deflection[:-1]) < 0.0
    return bool(np.mean(turns[1:] & turns[:-1]) > NEGLIGIBLE)


def gauge_step(deflection: FloatArray) -> float:
    """Return the step [m] in which a gauge reads, from its readings (n,) [m]; 0 where there is none.

    There is a step q where the distinct readings lie on a grid and rounding shows: the motion per sample changes by q
    or 2 q and the next sample undoes it. A motion driven at constant speed, given in exact numbers, lies on a grid too,
    but its motion per sample changes only at corners and stays changed.
    """
    gaps, shrunk = np.diff(np.unique(deflection)), _shrunk(deflection)
    step = _common_step(gaps[gaps > LEAST_NOISE * shrunk], FINEST_STEP * shrunk)
    if step == 0.0 or np.ptp(deflection) < LEAST_LEVELS * step:
        return 0.0
    changes = np.diff(np.rint(np.diff(deflection) / step))
    small = (changes != 0.0) & (np.abs(changes) <= 2.0)
    undone = small[:-1] & small[1:] & (changes[:-1] * changes[1:] < 0.0)
    return step if np.count_nonzero(undone) >= FEWEST_EVENTS else 0.0


def _shrunk(deflection: FloatArray) -> float:
    """Return the readings' span over SMALL, at most 1; 1 where nothing moves."""
    span = float(np.ptp(deflection))
    return min(span / SMALL, 1.0) if span > 0.0 else 1.0


def _common_step(gaps: FloatArray, finest: float) -> float:
    """Return the largest step of which all `gaps` are multiples, by Euclid's algorithm; 0 if below `finest`."""
    step = float(gaps.min(initial=np.inf))
    while finest <= step < np.inf:
        multiples = np.rint(gaps / step)
        remainder = np.abs(gaps - multiples * step)
        if remainder.max() <= GRID_TOLERANCE * step:
            return float(gaps.sum() / multiples.sum())
        step = float(remainder[remainder > GRID_TOLERANCE * step].min())
    return 0.0


STEPPING, LEVELS = 0.3, 5
"""What a gauge that reads in steps shows at least: STEPPING is the part of neighbouring readings that are equal, the
part of the changes with no change before or after, and the part of them that stand in no ramp; LEVELS is the number of
different jumps that may replace the latter two."""

ON_GRID = 0.9
"""Part of the changes of a gauge in steps, of ten between two turns, that are whole steps: the last may be a part."""

CANDIDATES = (0.02, 0.1, 0.25, 0.5)
"""Quantiles of the changes of the reading that are tried as its step: the smallest ones are often parts of it."""


def staircase_step(deflection: FloatArray) -> float:
    """Return the step [m] of a gauge whose readings repeat, or 0."""
    changes = np.abs(np.diff(deflection))
    moved = changes[changes > 1e-12]
    # A reading that changes now and then only is that of a motion which is driven in steps and held.
    if moved.size < FEWEST_EVENTS or moved.size > (1.0 - STEPPING) * changes.size:
        return 0.0
    changing = changes > 1e-12
    rests = float(np.mean(~(changing[:-1] & changing[1:])[changing[:-1] | changing[1:]]))
    between_holds = _in_ramps(changing) > 1.0 - STEPPING
    # A tire that rests repeats its reading too, but only a converter's levels lie on a grid.
    for step in sorted(np.quantile(moved, CANDIDATES, method="lower"), reverse=True):
        multiples = np.round(moved / step)
        if float(np.quantile(np.abs(moved / step - multiples), ON_GRID)) < GRID_TOLERANCE:
            # Ramps between holds change by one length too, sample after sample, where a staircase rests in between.
            stays = rests >= STEPPING and not between_holds
            kept = (stays or np.unique(multiples).size >= LEVELS) and _on_grid(deflection, step)
            return float(step) if kept else 0.0
    return 0.0


def _in_ramps(changing: NDArray[np.bool_]) -> float:
    """Return the part of the changes of a reading that stand in ramps: several in a row, and longer stays around them.

    changing (n - 1,): whether the reading changes from each sample to the next
    """
    edges = np.flatnonzero(np.diff(changing)) + 1
    lengths = np.diff(np.concatenate([[0], edges, [changing.size]]))
    moves = np.arange(lengths.size) % 2 == (0 if changing[0] else 1)
    around = np.minimum(np.append(np.inf, lengths[:-1]), np.append(lengths[1:], np.inf))
    ramps = moves & (lengths > 1) & (around > lengths)
    return float(lengths[ramps].sum() / max(lengths[moves].sum(), 1))


def _on_grid(deflection: FloatArray, step: float) -> bool:
    """Return whether readings lie on levels that are a step [m] apart, all the way from one turn to the next.

    Each change may be near a step where a motion is told every third sample; their sum is not. The levels on the way
    back may be others, and the first and the last change a part of a step.
    """
    stays = deflection[np.append(True, np.abs(np.diff(deflection)) > 1e-12)]
    changes = np.diff(stays)
    level = np.append(0.0, np.cumsum(np.round(changes / step)))
    level -= level.mean()
    spacing = float(level @ stays) / max(float(level @ level), 1e-300)
    if spacing <= 0.0:
        return False
    apart = stays / spacing - level
    begins = np.append(0, np.flatnonzero(np.diff(np.sign(changes))) + 1)
    middles = (begins + np.append(begins[1:], stays.size - 1)) // 2
    own = np.searchsorted(begins, np.arange(stays.size), side="right") - 1
    return float(np.quantile(np.abs(apart - apart[middles[own]]), ON_GRID)) < GRID_TOLERANCE


def destepped(time: FloatArray, deflection: FloatArray, step: float) -> FloatArray:
    """Return the deflection [m] with straight lines between the middles of the stays on each level.

    A line is followed for half a step at most: a tire at rest between two levels does not move slowly from one to the
    other. Where the reading goes to and fro between two levels more than once, the tire rests between them.
    """
    edges = np.flatnonzero(np.abs(np.diff(deflection)) > GRID_TOLERANCE * step) + 1
    begin, end = np.append(0, edges), np.append(edges, deflection.size)
    middle, level = 0.5 * (time[begin] + time[end - 1]), deflection[begin].copy()
    back = np.zeros(level.size, dtype=bool)
    back[1:-1] = np.abs(level[2:] - level[:-2]) < 0.5 * step
    to_and_fro = back & (np.append(back[1:], False) | np.append(False, back[:-1]))
    level[1:][to_and_fro[1:]] = 0.5 * (level[:-1] + level[1:])[to_and_fro[1:]]
    line = np.interp(time, middle, level)
    return np.asarray(np.clip(line, deflection - 0.5 * step, deflection + 0.5 * step))
