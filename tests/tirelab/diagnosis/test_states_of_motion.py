"""States of motion: what is driven alike has one state, and what lies beyond the others' reach has none of theirs."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.diagnosis.states_of_motion import driven_alike, in_states, places_of, states_of, ways_of
from tirelab.preprocessing.motion import Motion, motion_of
from tirelab.recordings.recording import Recording


def cycles(name: str, depth: float, period: float, radius: float = np.inf) -> Recording:
    """Two triangles from 0 to a depth [m] and back."""
    time = np.linspace(0.0, 2.0 * period, 801)
    x = depth * (1.0 - np.abs((2.0 * time / period) % 2.0 - 1.0))
    return Recording(name, time, x, np.full(time.size, radius), 2e4 * x)


def motions_of(*recordings: Recording) -> list[Motion]:
    return [motion_of(r.time, r.deflection) for r in recordings]


def alike_to(one: Recording, other: Recording) -> tuple[float, float]:
    """Return which part of a recording another one drives alike, and which otherwise."""
    both = [one, other]
    motions = motions_of(*both)
    places = places_of(both, motions)
    found = driven_alike(states_of(both, motions), places, ways_of(places, motions), 0)
    return float(found[0].mean()), float(found[1].mean())


@pytest.mark.parametrize(
    ("other", "alike", "otherwise"),
    [
        (cycles("the same", 0.01, 10.0), 1.0, 0.0),
        (cycles("quicker", 0.01, 5.0), 0.0, 1.0),
        (cycles("on a kerb", 0.01, 10.0, 0.05), 0.0, 1.0),
        # Half as deep at the same speed: it reaches half of the deflections, and says nothing of the rest.
        (cycles("half as deep", 0.005, 5.0), 0.5, 0.0),
    ],
    ids=lambda value: value.name if isinstance(value, Recording) else "",
)
def test_what_another_recording_drives_alike(other: Recording, alike: float, otherwise: float) -> None:
    # A twentieth: the samples of the turns, whose rates are those of neither branch.
    assert alike_to(cycles("one", 0.01, 10.0), other) == pytest.approx((alike, otherwise), abs=0.05)


def test_the_way_back_has_states_of_its_own() -> None:
    recording = cycles("one", 0.01, 10.0)
    (motion,) = motions_of(recording)
    (states,) = states_of([recording], [motion])
    middle = np.flatnonzero(np.abs(recording.deflection - 0.005) < 1e-5)
    assert len(middle) == 4
    first_in, first_back, second_in, second_back = states[middle]
    assert (first_in, first_back) == (second_in, second_back)
    assert first_in != first_back


def test_sums_in_states() -> None:
    states = [np.array([7, 7, 3]), np.array([3, 9])]
    counts, sums = in_states(states, [np.array([1.0, 2.0, 4.0]), np.array([8.0, 16.0])])
    np.testing.assert_array_equal(counts, [[1, 2, 0], [1, 0, 1]])
    np.testing.assert_array_equal(sums, [[4.0, 3.0, 0.0], [8.0, 0.0, 16.0]])
