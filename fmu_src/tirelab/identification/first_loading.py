"""Recordings of a part whose first loading lies far above all later ones: a law that is fitted amid them is neither.

Rubber and foam soften up to the largest deflection they have seen (L. Mullins, Rubber Chem. Technol. 42, 339 (1969)).
What does not come back to its length begins later from then on. The law of either is that of the first loading.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.samples import Recorded, is_timed
from ..recordings.recording import Recording
from .branches import turning_points
from .part_tire import AT_REST

Array = NDArray[np.float64]

PLACES = 20
"""Deflections at which ways are compared: they lie within the first loading and not at its ends."""

MOST_OF_STROKE = 0.5
"""Part of the stroke that a first loading covers at least: the law of a shorter one says nothing of the rest."""


@dataclass(frozen=True)
class FirstLoading:
    """begins, ends [s]: its time; above [N]: root mean square by which it lies above the later loadings at the same
    deflections; loop [N]: by which these lie above the unloading that follows them.
    """

    begins: float
    ends: float
    above: float
    loop: float


def first_loading(recording: Recorded, residual: Array | None = None) -> FirstLoading | None:
    """Return the first loading of a recording to its largest deflections if it lies further from the later loadings
    than those from their unloading; None where it does not, or where times or later cycles are missing.

    residual (n,) [N]: what is looked at in place of the force: what a model leaves of it
    """
    if not is_timed([recording]):
        return None
    x, force = recording.deflection, recording.force if residual is None else residual
    legs = list(pairwise(turning_points(x)))
    loading = [leg for leg in legs if x[leg[1]] > x[leg[0]]]
    if not loading:
        return None
    first = max(loading, key=lambda leg: float(x[leg[1]] - x[: leg[0] + 1].max()))
    seen = float(x[: first[0] + 1].max())
    if x[first[1]] - seen < MOST_OF_STROKE * np.ptp(x):
        return None
    places = np.linspace(seen, float(x[first[1]]), PLACES + 2)[1:-1]
    later = [leg for leg in loading if leg[0] > first[0]]
    back = [leg for leg in legs if x[leg[1]] < x[leg[0]] and later and leg[0] > later[0][0]]
    new = _mean_force(x, force, [first], places)
    again, out = (_mean_force(x, force, own, places) for own in (later, back))
    known = np.isfinite(new) & np.isfinite(again) & np.isfinite(out)
    if known.sum() < MOST_OF_STROKE * PLACES:
        return None
    above, loop = (float(np.sqrt(np.mean(v[known] ** 2))) for v in (new - again, again - out))
    if np.mean((new - again)[known]) <= 0.0 or above <= loop:
        return None
    ends = _reached(recording, first)
    return FirstLoading(float(recording.time[first[0]]), float(recording.time[ends]), above, loop)


def recording_of(first: FirstLoading, recording: Recording) -> Recording:
    """Return the first loading as a recording of its own."""
    own = (recording.time >= first.begins) & (recording.time <= first.ends)
    r = recording
    return Recording(r.name, r.time[own], r.deflection[own], r.surface_radius[own], r.force[own])


def _reached(recording: Recorded, way: Sequence[int]) -> int:
    """Return the sample with which a way (first and last sample) ends, or that from which it is a hold, if it is one
    for longer than it was under way: its largest reading may be one of noise, late in the hold.
    """
    begin, end = way
    x, time = recording.deflection[begin : end + 1], recording.time
    there = begin + int(np.argmax(x >= x[-1] - AT_REST * (x[-1] - x[0])))
    return there if time[end] - time[there] > time[there] - time[begin] else end


def _mean_force(x: Array, force: Array, legs: Iterable[Sequence[int]], places: Array) -> Array:
    """Return the mean force [N] of ways (first and last sample) at places [m]; NaN where none of them passes."""
    found = []
    for a, b in legs:
        way = np.argsort(x[a : b + 1], kind="stable")
        found.append(np.interp(places, x[a : b + 1][way], force[a : b + 1][way], left=np.nan, right=np.nan))
    table = np.array(found).reshape(-1, places.size)
    counts = np.isfinite(table).sum(axis=0)
    return np.where(counts > 0, np.nansum(table, axis=0) / np.maximum(counts, 1), np.nan)
