"""Which samples of a recording load the tire, which unload it, and which rest between the two.

A leg runs from one turning point of the deflection to the next; a turning point counts once the deflection has come
back from it by 5 % of the recording's range, so that noise makes none. Where the press rests at a turning point, or
before its first move and after its last, the samples belong to neither branch: they show how the force relaxes,
not how it depends on the deflection.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

LOADING, RESTING, UNLOADING = 1, 0, -1

TURN = 0.05
"""Fraction of the range by which the deflection must come back before a turning point counts."""

NEARNESS = 0.04
"""Fraction of a leg's travel within which a sample is at its turning point."""

DWELL = 6.0
"""How many times longer than at the legs' speed the deflection stays there if it rests (a sine: 4.4 times)."""

CHUNK_FIRST, CHUNK_LARGEST = 256, 65536
"""Samples processed together: few, as legs may be short, then more, as they may be long."""


def branches(time: NDArray[np.float64], deflection: NDArray[np.float64]) -> NDArray[np.int8]:
    """Return LOADING, RESTING or UNLOADING for every sample.

    time: [s] (n,), rising; deflection: [m] (n,)
    """
    turns = turning_points(deflection)
    branch = np.zeros(deflection.size, dtype=np.int8)
    legs = list(pairwise(turns))
    for first, last in legs:
        branch[first : last + 1] = LOADING if deflection[last] > deflection[first] else UNLOADING
    for i, turn in enumerate(turns):
        beside = legs[max(i - 1, 0) : i + 1]
        travel = max((abs(deflection[b] - deflection[a]) for a, b in beside), default=0.0)
        if travel == 0.0:
            continue
        speed = max(_speed(time[a : b + 1], deflection[a : b + 1]) for a, b in beside)
        first = turn - _stays(deflection[turn::-1], NEARNESS * travel)
        last = turn + _stays(deflection[turn:], NEARNESS * travel)
        if time[last] - time[first] > DWELL * len(beside) * NEARNESS * travel / speed:
            branch[first : last + 1] = RESTING
    return branch


def _speed(time: NDArray[np.float64], deflection: NDArray[np.float64]) -> float:
    """Return the mean speed [m/s] of a leg in the middle 80 % of its travel, where it does not rest."""
    travel = float(deflection[-1] - deflection[0])
    if travel == 0.0:
        return 0.0
    progress = (deflection - deflection[0]) / travel
    late = int(np.flatnonzero(progress > 0.9)[0])
    early = int(np.flatnonzero(progress[: late + 1] < 0.1)[-1])
    return 0.8 * abs(travel) / float(time[late] - time[early])


def turning_points(deflection: NDArray[np.float64]) -> list[int]:
    """Return the samples at which the deflection turns, with the first and the last sample."""
    threshold = TURN * float(np.ptp(deflection))
    turns = [0]
    sign = 1.0
    reversed_ = threshold > 0.0
    while reversed_:
        extreme, reversed_ = _leg(deflection, turns[-1], sign, threshold)
        if extreme > turns[-1]:
            turns.append(extreme)
        sign = -sign
    if turns[-1] != deflection.size - 1:
        turns.append(deflection.size - 1)
    return turns


def _leg(x: NDArray[np.float64], start: int, sign: float, threshold: float) -> tuple[int, bool]:
    """Return where the leg from `start`, up (`sign` 1) or down (-1), is at its end, and whether x turns there."""
    best, extreme = sign * float(x[start]), start
    first, size = start, CHUNK_FIRST
    while first < x.size:
        chunk = sign * x[first : first + size]
        highest = np.maximum(np.maximum.accumulate(chunk), best)
        back = np.flatnonzero(highest - chunk > threshold)
        ahead = chunk[: back[0]] if back.size else chunk
        if ahead.size and ahead.max() > best:
            extreme = first + int(ahead.argmax())
            best = float(ahead.max())
        if back.size:
            return extreme, True
        first, size = first + size, min(2 * size, CHUNK_LARGEST)
    return extreme, False


def _stays(x: NDArray[np.float64], nearness: float) -> int:
    """Return how many samples after its first x stays within `nearness` of it."""
    first, size = 0, CHUNK_FIRST
    while first < x.size:
        away = np.flatnonzero(np.abs(x[first : first + size] - x[0]) > nearness)
        if away.size:
            return first + int(away[0]) - 1
        first, size = first + size, min(2 * size, CHUNK_LARGEST)
    return x.size - 1
