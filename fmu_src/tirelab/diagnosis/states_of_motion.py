"""States of motion, in which recordings are compared with each other: surface, direction, deflection and speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..preprocessing.motion import BoolArray, FloatArray, IndexArray, Motion
from ..preprocessing.noise import STILL
from ..preprocessing.samples import Placed, Recorded, is_timed, surface_numbers, within

DEPTHS = 24
"""Number of parts of the deflection's span in which samples are in one state; half of them are within a fiftieth."""

SPEEDS_PER_OCTAVE = 4
"""Number of parts of a factor of two of the speed; two speeds of one part differ by a tenth on average."""


def states_of(recordings: Sequence[Recorded], motions: Sequence[Motion]) -> list[IndexArray]:
    """Return the number of the state of motion of each sample: of surface, direction, deflection and, where the times
    are known, speed; below STILL of the largest speed the tire rests.
    """
    low = min(float(m.deflection.min()) for m in motions)
    span = max(max(float(m.deflection.max()) for m in motions) - low, 1e-300)
    fastest = max(float(np.abs(m.rate).max()) for m in motions)
    radii = np.unique(np.concatenate([np.unique(r.surface_radius) for r in recordings]))
    slowest = float(np.log2(STILL))
    classes = 2 + int(-SPEEDS_PER_OCTAVE * slowest)
    found = []
    for recording, motion in zip(recordings, motions, strict=True):
        depth = np.minimum((DEPTHS * (motion.deflection - low) / span).astype(int), DEPTHS - 1)
        state = (
            np.searchsorted(radii, recording.surface_radius) * 2 + (motion.direction > 0.0)
        ) * DEPTHS + depth
        if is_timed(recordings):
            speed = np.log2(np.maximum(np.abs(motion.rate) / max(fastest, 1e-300), 0.5 * STILL))
            state = state * classes + np.where(
                speed < slowest, 0, 1 + (SPEEDS_PER_OCTAVE * (speed - slowest)).astype(int)
            )
        found.append(state)
    return found


def in_states(states: Sequence[IndexArray], *values: Sequence[FloatArray]) -> tuple[FloatArray, ...]:
    """Return the number of samples of each recording in each state (r, s), and for each of the `values`, given at the
    samples of each recording, their sums (r, s).
    """
    numbers = np.unique(np.concatenate(states), return_inverse=True)[1]
    size = int(numbers.max()) + 1
    own = np.split(numbers, np.cumsum([s.size for s in states])[:-1])
    summed = (np.array([np.bincount(k, v, size) for k, v in zip(own, one, strict=True)]) for one in values)
    return np.array([np.bincount(k, minlength=size) for k in own], dtype=float), *summed


def places_of(recordings: Sequence[Recorded], motions: Sequence[Motion]) -> list[Placed]:
    """Return the deflection [m] and the number of the surface of each sample of each recording."""
    numbers = surface_numbers([r.surface_radius for r in recordings])
    return [(m.deflection, n) for m, n in zip(motions, numbers, strict=True)]


def ways_of(places: Sequence[Placed], motions: Sequence[Motion]) -> list[Placed]:
    """Return the same places with a number that tells the direction too."""
    return [(x, 2 * n + (m.direction > 0.0)) for (x, n), m in zip(places, motions, strict=True)]


def driven_alike(
    states: Sequence[IndexArray], places: Sequence[Placed], ways: Sequence[Placed], number: int
) -> tuple[BoolArray, BoolArray]:
    """Return which samples of a recording another one drove alike, and which otherwise, as far as the others reach.

    A state is wider than the end of what the others reached in it on the same way: what lies beyond is neither.
    """

    def reached(of: Sequence[Placed]) -> BoolArray:
        return within((p for i, p in enumerate(of) if i != number), [of[number]])[0]

    others = np.unique(np.concatenate([s for i, s in enumerate(states) if i != number]))
    alike = np.isin(states[number], others)
    return np.asarray(alike & reached(ways)), np.asarray(~alike & reached(places))
