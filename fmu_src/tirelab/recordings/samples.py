"""Checks of single samples: finite, plausible, time that increases, no radius of zero."""

import math

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from .channels import CHANNELS, UNIT_OF
from .formats import RecordingError

FloatArray = NDArray[np.float64]

GAP = 1.75
"""A step in time longer than this many sampling intervals is a gap: at least one sample is missing."""

COARSE = 0.05
"""A clock that stands still for more than this share of the steps is coarser than the samples."""

MOST_TESTS = 50
"""A clock that goes back so often at most may have begun anew with each of several tests."""

DAY, HALF_DAY, LONGEST_PAUSE = 86_400.0, 43_200.0, 3600.0
"""A clock without a date begins anew after so long [s]; what is recorded does not stop for longer than the latter."""

COUNTER_BITS = (16, 32)
"""A counter of a microcontroller begins anew after so many binary digits."""

SOON = 3.0
"""The first step after a counter began anew is at most this many usual ones."""

LARGEST_PLAUSIBLE = {channel.name: channel.largest for channel in CHANNELS if math.isfinite(channel.largest)}
"""Magnitudes [SI] that no rig and no ride reaches: the unit of a larger number is wrong."""


class SampleFault(RecordingError):
    """One sample that cannot be: its number, its channel and what is wrong with it.

    anew: whether another test may begin with it
    """

    def __init__(self, index: int, channel: str, what: str, anew: bool = False) -> None:
        super().__init__(f"sample {index + 1}, {channel}: {what}")
        self.index = index
        self.channel = channel
        self.what = what
        self.anew = anew


def find_gaps(steps: FloatArray) -> NDArray[np.intp]:
    """The steps in time longer than `GAP` of the median step."""
    # A regular recording, the usual one, needs no median.
    if steps.max() <= GAP * steps.min():
        return np.empty(0, dtype=np.intp)
    return np.flatnonzero(steps > GAP * np.median(steps))


IRREGULAR = 0.1
"""Part of the steps in time that may be gaps; with more, the recording is sampled irregularly."""


ON_ITS_WAY = 0.02
"""Part of its span by which a deflection may differ on both sides of a gap in time that breaks no loop."""


def longest_unbroken(time: FloatArray, deflection: FloatArray) -> slice:
    """Return the longest stretch of samples (n,) without a gap in time [s] in which the deflection (n,) went on; all
    where it is sampled irregularly.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.diff(time)
        gaps = find_gaps(steps) + 1 if steps.size else np.empty(0, dtype=np.intp)
        moved = np.abs(deflection[gaps] - deflection[gaps - 1])
        gaps = gaps[moved > ON_ITS_WAY * np.ptp(deflection)]
    if gaps.size > IRREGULAR * steps.size:
        return slice(0, time.size)
    ends = np.array([0, *gaps.tolist(), time.size])
    longest = int(np.argmax(np.diff(ends)))
    return slice(int(ends[longest]), int(ends[longest + 1]))


def gap_notes(time: FloatArray) -> list[str]:
    """What there is to say about gaps in time [s], which may be out of order still."""
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.diff(time)
        gaps = find_gaps(steps)
    if not len(gaps):
        return []
    if len(gaps) > IRREGULAR * len(steps):
        return [
            f"time is sampled irregularly: steps from {plain(steps.min(), 6)} to {plain(steps.max(), 6)} s"
        ]
    longest = gaps[np.argmax(steps[gaps])]
    which = (
        "1 gap in time, not filled:"
        if len(gaps) == 1
        else f"{len(gaps)} gaps in time, not filled, the longest"
    )
    return [f"{which} {plain(steps[longest], 6)} s after {plain(time[longest], 6)} s"]


def over_midnight(time: FloatArray, turn: float = DAY) -> tuple[FloatArray, int | None]:
    """Return time [s] with a day added after its one jump back of about a day, and the sample that comes next.

    turn: of the clock [s], a day or half of one
    """
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.diff(time)
    back = np.flatnonzero(steps < 0.0)
    if len(back) != 1 or not 0.0 < float(steps[back[0]]) + turn < LONGEST_PAUSE:
        return time, None
    first = int(back[0]) + 1
    return np.concatenate([time[:first], time[first:] + turn]), first


def over_the_top(time: FloatArray, one: float) -> tuple[FloatArray, int | None]:
    """Return time [s] that goes on where its counter of 16 or 32 bits began anew, and the first sample after that; None
    where it did not. one: of the counter [s]
    """
    with np.errstate(over="ignore", invalid="ignore"):
        counts = np.rint(time / one)
        steps = np.diff(counts)
        if not len(steps) or steps.min() >= 0.0 or np.max(np.abs(time / one - counts)) > 1e-3:
            return time, None
    back = steps < 0.0
    usual = float(np.median(steps))
    for bits in COUNTER_BITS:
        anew = steps[back] + 2.0**bits
        if anew.min() > 0.0 and anew.max() <= SOON * usual:
            turns = np.concatenate([[0.0], np.cumsum(back)])
            return (counts + 2.0**bits * turns) * one, int(np.argmax(back)) + 1
    return time, None


def descends(time: FloatArray) -> bool:
    """Whether time falls from each sample to the next."""
    with np.errstate(over="ignore", invalid="ignore"):
        return len(time) > 1 and bool(np.diff(time).max() < 0.0)


def check_time(time: FloatArray) -> None:
    """Refuse time [s] that repeats or goes back."""
    steps = np.diff(time)
    if steps.min() > 0.0:
        return
    late = int(np.argmax(steps <= 0.0)) + 1
    before, after = float(time[late - 1]), float(time[late])
    if before > after:
        what = (
            f"time goes back from {plain(before, 9)} s to {plain(after, 9)} s; sort the rows by time, and keep "
            "one of each, or "
        )
        what += "leave out a clock that is written wrongly"
        raise SampleFault(late, "time", what, anew=int(np.count_nonzero(steps < 0.0)) <= MOST_TESTS)
    what = f"time repeats {plain(after, 9)} s"
    still = int(np.count_nonzero(steps == 0.0))
    if steps.min() == 0.0 and still > COARSE * len(steps):
        known = still < len(steps)
        rate = _rate_of_changes(time, steps) if known else 0.0
        said = f"{rate:.6g}Hz" if known else "RATE"
        what += f", as do {still - 1} others: the clock is coarser than the samples; if these are evenly spaced, give "
        raise SampleFault(late, "time", what + f"their rate: --sampling {said}")
    raise SampleFault(late, "time", what + "; sort the rows by time, and keep one of each")


def _rate_of_changes(time: FloatArray, steps: FloatArray) -> float:
    """Return how many samples there are in a second of a clock that stands still between its changes [Hz].

    Before its first change and after its last one it may have stood for a part of its step.
    """
    changes = np.flatnonzero(steps > 0.0)
    if len(changes) < 2:
        return len(time) / float(time[-1] - time[0] + steps[changes[0]])
    length = float(time[changes[-1]] - time[changes[0]])
    rate = float(changes[-1] - changes[0]) / length
    # each of the two changes may belong to the sample before or after it
    rounded = (float(f"{rate:.{digits}g}") for digits in range(1, 7))
    return next((near for near in rounded if abs(near - rate) * length < 2.0), rate)


def check_values(name: str, values: FloatArray) -> None:
    """Refuse what is not finite or not plausible, by its least and greatest value."""
    most = LARGEST_PLAUSIBLE[name]
    least = 0.0 if UNIT_OF[name] == "K" else -most
    if least <= float(values.min()) and float(values.max()) <= most:
        return
    index = int(np.argmin((least <= values) & (values <= most)))
    value = float(values[index])
    if not np.isfinite(value):
        raise SampleFault(index, name, f"{value} is no {name}; correct the value, or delete the row")
    raise SampleFault(index, name, f"{value:.6g} {UNIT_OF[name]} cannot be; correct the value or its unit")


def checked_radius(radius: FloatArray) -> FloatArray:
    """Surface radii [m], read-only, with the flat limit from either side as inf; zero and NaN are refused."""
    low, high = float(radius.min()), float(radius.max())
    if low == -np.inf:
        radius = np.where(radius == -np.inf, np.inf, radius)
    if np.isnan(high) or (low <= 0.0 <= high and np.any(radius == 0.0)):
        index = int(np.argmax(np.isnan(radius) | (radius == 0.0)))
        value = float(radius[index])
        raise SampleFault(index, "radius", f"{value:.6g} is no radius; write inf for flat, or delete the row")
    radius.flags.writeable = False
    return radius
