"""Whether recordings show that what presses a part lifts off it: then the part is pressed, and cannot pull.

Food, foam and gels do not come back as fast or as far as the press does. The force then rests at its least over much of
the way back, where it was loaded before.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.samples import Recorded
from .branches import turning_points

Array = NDArray[np.float64]

PLACES = 20
"""Deflections at which ways are compared, evenly over the stroke."""

WITHOUT_FORCE = 5
"""Places in a row without force on a way back: a quarter of the stroke, more than where a loop crosses its zero."""

LEAST, LOADED = 0.03, 0.1
"""Parts of the span of the force: what rests is within LEAST of the free force, what was loaded LOADED above it."""

FREE = 0.1
"""Part of the places at which the force is below the free one at most: what sticks pulls before it lifts off."""


def lifts_off(recordings: Iterable[Recorded]) -> bool:
    """Return whether a recording shows a way back on which the force rests at its least, where the part was loaded."""
    return any(_lifts_off(r.deflection, r.force) for r in recordings)


def _lifts_off(deflection: Array, force: Array) -> bool:
    legs = list(pairwise(turning_points(deflection)))
    edges = np.linspace(float(deflection.min()), float(deflection.max()), PLACES + 1)
    means = [_means(deflection[a : b + 1], force[a : b + 1], edges) for a, b in legs]
    if not means or not np.isfinite(np.concatenate(means)).any():
        return False
    free, span = float(np.nanquantile(means, FREE)), float(np.nanmax(means) - np.nanmin(means))
    if abs(free) > LOADED * span:
        return False  # friction alone is as even on the way back, and as far below zero as above it
    for i, (a, b) in enumerate(legs):
        if i and deflection[b] < deflection[a]:
            rests = (np.abs(means[i] - free) < LEAST * span) & (means[i - 1] - free > LOADED * span)
            if _longest(rests) >= WITHOUT_FORCE:
                return True
    return False


def _means(deflection: Array, force: Array, edges: Array) -> Array:
    """Return the mean force [N] between edges [m], NaN where a way has no sample."""
    place = np.clip(np.searchsorted(edges, deflection, "right") - 1, 0, PLACES - 1)
    count = np.bincount(place, minlength=PLACES)
    total = np.bincount(place, force, minlength=PLACES)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _longest(flags: NDArray[np.bool_]) -> int:
    """Return the length of the longest run of flags."""
    ends = np.flatnonzero(np.diff([0, *flags.astype(int), 0]))
    return int(np.max(ends[1::2] - ends[::2], initial=0))
