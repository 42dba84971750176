"""What happens between two samples: where two runs stand one below the other in a table, where a part breaks, and where
a gauge lost a reading or read falsely.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from ..names import plain

FAR = 10.0
"""A jump is this many times as far as the motion between any two other samples; a corner of a motion is none."""

BOTH = 0.5
"""Part of the jump that the motion covers before and after it at least: a step between two holds is driven."""

FEWEST = 20
"""Samples of a run at least."""


def jump_doubt(deflection: NDArray[np.float64]) -> tuple[tuple[int, str], ...]:
    """Return the sample after a jump between two runs and a sentence, none without one; deflection (n,) [m]."""
    moved = np.abs(np.diff(deflection))
    if moved.size < 2 * FEWEST:
        return ()
    at = int(np.argmax(moved))
    jump, other = float(moved[at]), float(np.max(np.delete(moved, at)))
    before, after = deflection[: at + 1], deflection[at + 1 :]
    covered = min(float(np.ptp(before)), float(np.ptp(after)))
    if min(before.size, after.size) < FEWEST or not 0.0 < FAR * other < jump or covered < BOTH * jump:
        return ()
    said = (
        f"the deflection jumps by {plain(1e3 * jump, 3)} mm from the sample before, {jump / other:.0f} times as far "
        "as between any two others: if these are two runs in one table, give the rows of one of them, as in FILE@1:2000"
    )
    return ((at + 1, said),)


HELD, GONE = 0.5, 0.1
"""A part that breaks carried more than the first part of the largest force before, and carries less than the second one
after it; the deflection goes back by less than the second part of its span meanwhile."""

FALL = 5
"""Samples within which a part breaks; a release takes longer."""


TORN, OTHERS = 0.25, 0.01
"""A part tears where the force falls by more than the first part of its largest, and FAR times as much as elsewhere but
for the second part of the recording: a jolt as its grips close."""


def sudden_doubts(
    deflection: NDArray[np.float64], force: NDArray[np.float64]
) -> tuple[tuple[str, int, str], ...]:
    """Return for each sudden event the channel, the sample and a sentence; arrays (n,) [m], [N]."""
    jumps = (("deflection", at, said) for at, said in jump_doubt(deflection))
    breaks = (("force", at, said) for at, said in break_doubt(deflection, force))
    marks = [("force", at, said) for at, said in mark_doubt(deflection, force)]
    marks = marks or [("force", at, said) for at, said in false_force_doubt(deflection, force)]
    return (*jumps, *breaks, *marks)


def mark_doubt(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> tuple[tuple[int, str], ...]:
    """Return the first sample at which a logger may have written a mark for no reading, such as -999, and a sentence;
    none without one. Arrays (n,) [m], [N].

    The force goes there for a few samples and comes back, always to one number exactly, beyond all others, while the
    deflection goes on.
    """
    with np.errstate(all="ignore"):
        along = _alone(deflection)
        alone = np.setdiff1d(_alone(force), along)
    if alone.size < 2 or np.ptp(force[alone]) > 0.0:
        alone = np.setdiff1d(_far_and_equal(force), along)
    if alone.size < 2:
        return ()
    others = np.delete(force, alone)
    mark = float(force[alone[0]])
    if others.min() <= mark <= others.max():
        return ()
    said = (
        f"the force is {plain(mark, 6)} N at {alone.size} samples, beyond all others, and comes back each time: if "
        "that is a mark for no reading, write nothing there, and the rows are skipped"
    )
    return ((int(alone[0]), said),)


MOST_MARKED = 0.1
"""Part of the samples that may have a mark for no reading: with more blanks a recording is refused."""


def _far_and_equal(force: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the samples (k,) of one number exactly that is as far from all others as these reach, for a few samples at
    a time; none where there is no such number.
    """
    for mark in (float(force.max()), float(force.min())):
        at = np.flatnonzero(force == mark)
        others = np.delete(force, at)
        if not 2 <= at.size <= MOST_MARKED * force.size:
            continue
        beyond = min(abs(mark - float(others.max())), abs(mark - float(others.min())))
        runs = np.split(at, np.flatnonzero(np.diff(at) > 1) + 1)
        if beyond > float(np.ptp(others)) > 0.0 and len(runs) > 1 and max(map(len, runs)) <= AROUND:
            return at
    return np.empty(0, dtype=np.intp)


STEP = 4.0
"""A deflection that moves so many times as far as it usually does takes a step, and the force of a damper with it."""


def false_force_doubt(
    deflection: NDArray[np.float64], force: NDArray[np.float64]
) -> tuple[tuple[int, str], ...]:
    """Return the first sample at which the force goes far and comes back while the deflection goes on, and a sentence;
    none without one. Arrays (n,) [m], [N].

    So does a cell that was overloaded, and a line that was cut within its number: 6 for 614.35.
    """
    with np.errstate(all="ignore"):
        alone, along = _alone(force), _alone(deflection)
    alone = np.setdiff1d(alone, (along[:, None] + np.arange(1 - AROUND, AROUND)).ravel())
    moved = np.abs(np.diff(deflection, prepend=deflection[0], append=deflection[-1]))
    near = np.clip(alone[:, None] + np.arange(-1, 3), 0, moved.size - 1)
    alone = alone[np.max(moved[near], axis=1, initial=0.0) <= STEP * np.median(moved)]
    if not alone.size:
        return ()
    at = int(alone[0])
    good = np.setdiff1d(np.arange(max(at - AROUND, 0), min(at + AROUND + 1, force.size)), alone)
    more = f" (and so at {alone.size - 1} more)" if alone.size > 1 else ""
    said = (
        f"the force is {plain(force[at], 6)} N and {plain(force[good[np.argmin(np.abs(good - at))]], 6)} N at the next "
        f"sample, farther than any others are apart{more}: if it was read falsely, or its line was cut, delete the row"
    )
    return ((at, said),)


def break_doubt(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> tuple[tuple[int, str], ...]:
    """Return the sample from which on a broken part carries nothing and a sentence, none where it did not break; arrays
    (n,) [m], [N].

    The force falls within FALL samples and does not come back, where the part carried it at every such deflection; or
    it falls by TORN of its largest, far more than anywhere else, while the deflection goes on.
    """
    return _broken(deflection, force) or _torn(deflection, force)


def _torn(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> tuple[tuple[int, str], ...]:
    """The same of a part that carries some of its force on; where a motion turns back, friction falls as suddenly."""
    if force.size < FEWEST * FALL:
        return ()
    carried = np.abs(force)
    ends = np.minimum(np.arange(force.size) + FALL, force.size - 1)
    falls = carried - carried[ends]
    usual = float(np.sort(falls)[-(2 * FALL + int(OTHERS * falls.size))])
    sudden = np.flatnonzero(falls > max(TORN * float(carried.max()), FAR * usual))
    if not sudden.size or sudden[-1] < 2 * FALL:
        return ()
    last = int(max(sudden[sudden > sudden[-1] - FALL], key=falls.__getitem__))
    fall, end = float(falls[last]), int(ends[last])
    way = np.sign(force[last]) * deflection
    goes_on = way[end] - way[last] > HELD * (end - last) / FALL * (way[last] - way[last - FALL]) > 0.0
    if not goes_on or float(carried[end:].max()) > carried[last] - HELD * fall:
        return ()
    at = last + int(np.argmin(np.diff(carried[last : end + 1])))
    if at + 2 >= force.size:
        return ()  # the last sample alone may be read falsely
    part = 100.0 * fall / carried[last]
    said = (
        f"the force falls within {end - last} samples by {part:.0f} % and does not come back, while the deflection "
        f"goes on: if the part tore or slipped, give the range before it, as in FILE@1:{at + 1}"
    )
    return ((at + 1, said),)


def _broken(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> tuple[tuple[int, str], ...]:
    """Return where nothing is carried any more."""
    most = float(np.max(np.abs(force)))
    carries = np.flatnonzero(np.abs(force) > HELD * most)
    if not carries.size:
        return ()
    last = int(carries[-1])
    nothing = last + np.flatnonzero(np.abs(force[last:]) < GONE * most)
    if nothing.size < 2 or nothing[0] - last > FALL:
        return ()
    at, way = int(nothing[0]), np.sign(deflection[last]) * deflection
    least = way[last] - GONE * np.ptp(way)
    there = np.abs(force[: last + 1][way[: last + 1] >= least])
    if way[at] < least or there.size < FEWEST or np.min(there) < GONE * most:
        return ()
    said = (
        f"the force falls within {FALL} samples to less than a tenth of the largest one, and does not come back: "
        f"if the part broke or slipped off, give the range before it, as in FILE@1:{last + 1}"
    )
    return ((at, said),)


LOST = 2.0
"""A lost reading is this many times as far from the median of those around as any other two neighbours are apart."""

RARE = 0.02
"""Most of the readings that may be lost; more are how the gauge reads."""


def lost_readings(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the samples at which a gauge lost its reading, which is there again soon after; arrays (n,).

    No motion goes so far and comes back within AROUND samples, unless the force follows it.
    """
    with np.errstate(all="ignore"):  # a damaged number may be any
        found = _alone(deflection)
        along = _alone(force) if found.size else found
    return np.setdiff1d(found, (along[:, None] + np.arange(1 - AROUND, AROUND)).ravel())


BY_CHANCE = 0.01
"""Probability that noise makes one of all readings look false."""

ON_GRID = 0.9
"""Part of the changes between readings that are whole steps, within a quarter, of a gauge that reads in steps; of one
that does not, half of them are."""

AROUND = 4
"""Readings before one, and as many after it, by which it is judged."""

UNEVEN = 0.1
"""Part of the usual step of the clock by which another one makes rows uneven: a motion is read as much further."""


def false_readings(
    deflection: NDArray[np.float64],
    force: NDArray[np.float64],
    uneven: NDArray[np.bool_] | None = None,
) -> NDArray[np.intp]:
    """Return the samples at which a gauge read falsely: off the motion by more than its noise can be; arrays (n,).

    Neither the line through the readings before a false one leads to it, nor that through those after it, nor the
    middle between its neighbours, all to the same side. A corner of the motion lies on one of the two lines, and the
    bend of a motion is on other sides of line and middle. The readings before and after it lie on one curve but for
    their noise, and it is more than a step of the gauge. The force does not go along. Bright spots do so to a laser,
    and dirt to a potentiometer. Where rows are not known to be evenly apart in time (`uneven`), a reading between both
    its neighbours may be one of the motion, a little sooner or later.
    """
    with np.errstate(all="ignore"):
        found = _off_the_motion(deflection)
        if uneven is not None:
            before, own, after = (deflection[found + by] for by in (-1, 0, 1))
            beyond = (own < np.minimum(before, after)) | (own > np.maximum(before, after))
            found = found[beyond | ~uneven[found]]
        if found.size > RARE * deflection.size:
            return np.empty(0, dtype=np.intp)
        along = _off_the_motion(force) if found.size else found
    return np.setdiff1d(found, (along[:, None] + np.arange(-1, 2)).ravel())


def unevenly_read(time: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return at which samples (n,) those around, by which a reading is judged, are not evenly apart in time [s]."""
    if time.size < 2:
        return np.zeros(time.size, dtype=bool)
    with np.errstate(all="ignore"):
        steps = np.diff(time)
        usual = float(np.median(steps))
        odd = ~(np.abs(steps - usual) <= UNEVEN * usual)
    seen = np.convolve(odd, np.ones(2 * AROUND), mode="full")[AROUND - 1 : AROUND - 1 + time.size]
    return np.asarray(seen > 0.5)


def _off_the_motion(values: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the samples (k,) that are off those before and after them, in rising order."""
    n = values.size - 2 * AROUND
    if n < FEWEST or not np.ptp(values) > 0.0:
        return np.empty(0, dtype=np.intp)
    beside = {k: values[AROUND + k : AROUND + k + n] for k in range(-AROUND, AROUND + 1)}
    at = np.arange(1.0, AROUND + 1.0)
    line = np.linalg.pinv(np.vander(at, 2, increasing=True))[0]
    before, after = (sum(line[i] * beside[side * (i + 1)] for i in range(AROUND)) for side in (-1, 1))
    middle = 0.5 * (beside[-1] + beside[1])
    own = beside[0] - middle
    # A gauge that stands still repeats its reading: how well it reads shows where it moves.
    moved = np.abs(own[beside[-1] != beside[1]])
    unit = 1.0 / (float(ndtri(0.75)) * np.sqrt(1.5))  # from a median of `own` to the deviation of a reading
    noise = unit * float(np.median(moved if moved.size else np.abs(own)))
    far, near = (-float(ndtri(BY_CHANCE / (2.0 * count))) for count in (n, 2 * AROUND))
    most, usual = far * noise, near * noise
    off = [own / np.sqrt(1.5), *((beside[0] - p) / np.sqrt(1.0 + line @ line) for p in (before, after))]
    seen = np.abs(own)[np.abs(own) > usual]
    apart = (np.min(off, axis=0) > most) | (np.max(off, axis=0) < -most)
    likely = np.flatnonzero(apart & (np.abs(own) > _of_steps(values, seen)))
    # Nor is every gauge as quiet everywhere: the probe that touches nothing yet is not.
    there = np.clip(likely[:, None] + np.arange(-FEWEST, FEWEST + 1), 0, n - 1)
    own_noise = unit * np.median(np.abs(own[there]), axis=1)
    likely = likely[np.min(np.abs(off), axis=0)[likely] > far * own_noise]
    places = np.concatenate([-at[::-1], at])
    around = values[AROUND + likely[:, None] + places.astype(int)]
    curve = np.vander(places, 3, increasing=True)
    left = around - around @ (curve @ np.linalg.pinv(curve)).T
    return np.asarray(AROUND + likely[np.max(np.abs(left), axis=1, initial=0.0) < usual])


def _of_steps(values: NDArray[np.float64], off: NDArray[np.float64]) -> float:
    """Return how far off its neighbours a reading is at most by a step of the gauge; 0 of one that reads in no steps.

    off (k,): from the middle of both neighbours, more than by noise: by one step at one reading, by half at the others
    """
    if off.size < FEWEST:
        return 0.0
    step = 2.0 * float(np.quantile(off, 0.25))
    changes = np.diff(values) / step
    on_grid = np.mean(np.abs(changes - np.rint(changes)) < 0.25)
    return 1.5 * step if on_grid > ON_GRID else 0.0


def _alone(values: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the samples (k,) that stand alone, or AROUND of them at most, in rising order; none where more than RARE
    would.
    """
    nothing = np.empty(0, dtype=np.intp)
    steps = np.diff(values)
    if steps.size < FEWEST:
        return nothing
    sizes, most = np.abs(steps), int(RARE * values.size)
    usual = float(np.partition(sizes, -1 - 2 * most)[-1 - 2 * most])
    edges = np.flatnonzero(sizes > LOST * usual)
    near = np.unique(np.clip(edges[:, None] + np.arange(1 - AROUND, AROUND + 1), 0, values.size - 1))
    # Where several are lost one after the other, or a good one stands between them, the median is of those around.
    # At an end those on its one side count twice, the two next to it: more of them would be far off on a ramp.
    last, beside = values.size - 1, np.arange(-AROUND, AROUND + 1)
    around = values[last - np.abs(last - np.abs(near[:, None] + beside))]
    wide = np.clip(np.minimum(near, last - near), AROUND // 2, AROUND)
    around = np.where(np.abs(beside) <= wide[:, None], around, np.nan)
    far = np.abs(values[near] - np.nanmedian(around, axis=1))
    likely, far = near[far > LOST * usual], far[far > LOST * usual]
    order = np.argsort(-far, kind="stable")[:most]
    # Each step goes with the first sample beside it that is left out; what stays then are the steps of higher rank.
    rank = np.full(sizes.size, order.size)
    for side in (likely[order] - 1, likely[order]):
        np.minimum.at(rank, np.clip(side, 0, sizes.size - 1), np.arange(order.size))
    largest = np.zeros(order.size + 1)
    np.maximum.at(largest, rank, sizes)
    stays = np.maximum.accumulate(largest[::-1])[::-1][1:]
    alone = np.flatnonzero((far[order] > LOST * stays) & (stays > 0.0))
    return (
        _come_back(values, np.sort(likely[order[: alone[-1] + 1]]), LOST * usual) if alone.size else nothing
    )


def _come_back(values: NDArray[np.float64], alone: NDArray[np.intp], most: float) -> NDArray[np.intp]:
    """Return those of the samples (k,) to which the readings jump, and from which they jump back to where they were; at
    an end one of the two is enough.

    most: of the way in the time between two samples. Before a pause of the recording the readings do not jump, and
    after it the motion is elsewhere.
    """
    runs = np.split(alone, np.flatnonzero(np.diff(alone) > 1) + 1)
    steps = np.abs(np.diff(values, prepend=np.inf, append=np.inf))
    good = []
    for run in runs:
        first, last = int(run[0]), int(run[-1])
        inside = first > 0 and last < values.size - 1
        away = abs(values[min(last + 1, values.size - 1)] - values[max(first - 1, 0)]) if inside else 0.0
        if min(steps[first], steps[last + 1]) > most and away <= most * (run.size + 1):
            good.append(run)
    return np.concatenate(good) if good else np.empty(0, dtype=np.intp)
