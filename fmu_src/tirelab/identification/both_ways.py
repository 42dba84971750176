"""What the force of a part has of its deflection alone, in and out alike, beside the law of its spring.

Detents, magnets and a snap-through rise and fall with the deflection. Friction, damping and relaxation differ in and
out, so the error of the law is averaged over the deflection for either way, and what both averages have in common is
looked at. A straight line over the deflection is left out: a spring or a moved mass has it.

A loop has two forces at one deflection but for its turns, where the two ways meet: `loop_state` goes from one to the
other as dry friction does.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..preprocessing.turns import branches as cycles
from ..recordings.recording import Recording
from .branches import LOADING, UNLOADING, branches
from .surfaces import CM_PER_M

Array = NDArray[np.float64]

PLACES, PLACES_LEAST = 50, 10
"""Places into which the range of the deflection is divided, and how many of them must be passed in and out."""

COMMON = 0.5
"""Part of the squares of either way's curve that must be common to both: more than is its own."""


def common_curve(recordings: Sequence[Recording], tire: TireModel) -> tuple[float, float]:
    """Return what recordings of a part have in common in and out beside its spring, and what the spring changes: both
    [N], root mean square. The first is 0 where the curve of one way is not that of the other.

    tire: a part with a power law and a preload
    """
    x = np.concatenate([r.deflection for r in recordings])
    way = np.concatenate([branches(r.time, r.deflection) for r in recordings])
    coefficient, exponent = tire.law.coefficients(float(recordings[0].surface_radius[0]))
    spring = coefficient * np.sign(x) * np.abs(CM_PER_M * x) ** exponent
    error = np.concatenate([r.force for r in recordings]) - spring
    place = _places(x)
    ways = [way == side for side in (LOADING, UNLOADING)]
    both = np.minimum(*(np.bincount(place[w], minlength=PLACES) for w in ways))
    passed = np.flatnonzero(both)
    if passed.size < PLACES_LEAST or not _in_every_cycle(recordings, error, place):
        return 0.0, float(np.std(spring))
    weight = both[passed] / both.sum()
    into, out = (
        _beside_line(_means(error[w], place[w])[passed], _means(x[w], place[w])[passed], weight) for w in ways
    )
    common = float(np.sum(weight * into * out))
    own = float(np.sqrt(np.sum(weight * into**2) * np.sum(weight * out**2)))
    return (float(np.sqrt(common)) if common > COMMON * own else 0.0), float(np.std(spring))


def passed_both_ways(recordings: Sequence[Recording]) -> bool:
    """Return whether most places of the deflection are passed in and out."""
    x = np.concatenate([r.deflection for r in recordings])
    way = np.concatenate([branches(r.time, r.deflection) for r in recordings])
    place = _places(x)
    seen = [np.bincount(place[way == side], minlength=PLACES) > 0 for side in (LOADING, UNLOADING)]
    return bool(2 * np.count_nonzero(seen[0] & seen[1]) > np.count_nonzero(seen[0] | seen[1]))


def _in_every_cycle(recordings: Sequence[Recording], error: Array, place: NDArray[np.intp]) -> bool:
    """Return whether every other cycle has the errors (n,) at the places (n,) that the others have; True where these
    are not passed again.

    A part that creeps passes other places in each cycle: what its cycles have apart would pass for a curve of them.
    """
    odd = np.concatenate([cycles(r.deflection, 0.0)[1] % 2 == 1 for r in recordings])
    count = np.minimum(*(np.bincount(place[own], minlength=PLACES) for own in (odd, ~odd)))
    passed = np.flatnonzero(count)
    if passed.size < PLACES_LEAST:
        return True
    weight = count[passed] / count.sum()
    means = (_means(error[own], place[own])[passed] for own in (odd, ~odd))
    one, other = (mean - weight @ mean for mean in means)
    own = float(np.sqrt(np.sum(weight * one**2) * np.sum(weight * other**2)))
    return float(np.sum(weight * one * other)) > COMMON * own


def loop_state(deflection: Array, reach: float) -> Array:
    """Return the state u of a loop along a deflection (n,), from -1 on the way out to 1 on the way in.

    du = dx / reach within these limits: dry friction behind a spring (Jenkin's element; W. D. Iwan, J. Appl. Mech.
    33 (1966) 893-900). It begins at 0; reach: in the unit of the deflection
    """
    found, state = [], 0.0
    for step in np.diff(deflection, prepend=deflection[0]).tolist():
        state = min(1.0, max(-1.0, state + step / reach))
        found.append(state)
    return np.array(found)


def _places(x: Array) -> NDArray[np.intp]:
    """Return the number of the place of every deflection (n,)."""
    return np.asarray(
        np.minimum((PLACES * (x - x.min()) / max(float(np.ptp(x)), 1e-300)).astype(int), PLACES - 1)
    )


def _means(values: Array, place: NDArray[np.intp]) -> Array:
    """Return the mean of the values at every place, 0 where there are none."""
    counts = np.bincount(place, minlength=PLACES)
    return np.asarray(np.bincount(place, values, minlength=PLACES) / np.maximum(counts, 1))


def _beside_line(values: Array, deflection: Array, weight: Array) -> Array:
    """Return the values less their straight line over the deflection."""
    columns = np.column_stack([np.ones(deflection.size), deflection / np.abs(deflection).max()])
    root = np.sqrt(weight)
    line = np.linalg.lstsq(columns * root[:, None], values * root, rcond=None)[0]
    return np.asarray(values - columns @ line)
