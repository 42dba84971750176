"""Jumps of the deflection between two samples: where two runs stand one below the other in a table, and where a gauge
lost a reading.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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
        f"the deflection jumps by {1e3 * jump:.3g} mm from the sample before, {jump / other:.0f} times as far as "
        "between any two others: if these are two runs in one table, give the rows of one of them, as in FILE@1:2000"
    )
    return ((at + 1, said),)


LOST = 2.0
"""A lost reading is this many times as far from both its neighbours as any other two neighbours are apart."""

RARE = 0.02
"""Most of the readings that may be lost; more are how the gauge reads."""


def lost_readings(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the samples at which a gauge lost its reading, which is there again in the next one; arrays (n,).

    No motion goes so far and comes back within one sample, unless the force follows it.
    """
    with np.errstate(all="ignore"):  # a damaged number may be any
        found = _alone(deflection)
        return np.setdiff1d(found, _alone(force)) if found.size else found


def _alone(values: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the samples (k,) that stand alone, in rising order; none where more than RARE would."""
    nothing = np.empty(0, dtype=np.intp)
    steps = np.diff(values)
    if steps.size < FEWEST:
        return nothing
    sizes, most = np.abs(steps), int(RARE * values.size)
    back = np.where(steps[:-1] * steps[1:] < 0.0, np.minimum(sizes[:-1], sizes[1:]), 0.0)
    usual = float(np.partition(sizes, -1 - 2 * most)[-1 - 2 * most])
    likely = 1 + np.flatnonzero(back > LOST * usual)
    # Between two lost readings a good one stands as far from both: the median of five tells them apart.
    around = values[np.clip(likely[:, None] + np.arange(-2, 3), 0, values.size - 1)]
    far = np.minimum(np.abs(values[likely] - np.median(around, axis=1)), back[likely - 1])
    order = np.argsort(-far, kind="stable")[:most]
    # Each step goes with the first sample beside it that is left out; what stays then are the steps of higher rank.
    rank = np.full(sizes.size, order.size)
    for side in (likely[order] - 1, likely[order]):
        np.minimum.at(rank, side, np.arange(order.size))
    largest = np.zeros(order.size + 1)
    np.maximum.at(largest, rank, sizes)
    stays = np.maximum.accumulate(largest[::-1])[::-1][1:]
    alone = np.flatnonzero((far[order] > LOST * stays) & (stays > 0.0))
    return np.sort(likely[order[: alone[-1] + 1]]) if alone.size else nothing
