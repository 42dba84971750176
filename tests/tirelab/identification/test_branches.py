"""Loading, unloading and rest are told apart whatever the noise, the waveform and the holds."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tirelab.identification.branches import LOADING, RESTING, UNLOADING, branches, turning_points

Array = NDArray[np.float64]


def ramps(times: list[float], deflections: list[float], noise: float = 0.0) -> tuple[Array, Array]:
    time = np.arange(0.0, times[-1], 0.01)
    return time, np.interp(time, times, deflections) + noise * np.random.default_rng(0).standard_normal(
        time.size
    )


def seconds(time: Array, branch: NDArray[np.int8], which: int) -> float:
    return 0.01 * float(np.count_nonzero(branch == which))


@pytest.mark.parametrize("noise", [0.0, 1e-5, 1e-4])
def test_a_triangle_has_equal_branches(noise: float) -> None:
    time, deflection = ramps([0, 15, 30, 45, 60], [0, 0.025, 0, 0.025, 0], noise)
    assert len(turning_points(deflection)) == 5
    branch = branches(time, deflection)
    # the turning points are found to within the noise: 0.1 mm is 0.06 s of this ramp
    assert seconds(time, branch, LOADING) == pytest.approx(30.0, abs=0.3)
    assert seconds(time, branch, RESTING) == 0.0
    rising = (time % 30.0 > 0.3) & (time % 30.0 < 14.7)
    assert (branch[rising] == LOADING).all()


@pytest.mark.parametrize("noise", [0.0, 1e-5, 1e-4])
def test_a_hold_at_the_top_belongs_to_neither_branch(noise: float) -> None:
    time, deflection = ramps([0, 5, 10, 40, 45, 60], [0, 0, 0.02, 0.02, 0, 0], noise)
    branch = branches(time, deflection)
    # within 4 % of the travel of a turning point counts as resting: 0.2 s at either end of the ramps; the
    # turning point is the noise's extreme, 0.35 mm or 0.09 s away
    assert seconds(time, branch, LOADING) == pytest.approx(4.6, abs=0.2)
    assert seconds(time, branch, UNLOADING) == pytest.approx(4.6, abs=0.2)
    assert (branch[(time > 10.5) & (time < 39.5)] == RESTING).all()


def test_a_pause_on_the_way_up_belongs_to_loading() -> None:
    time, deflection = ramps([0, 5, 8, 13, 23], [0, 0.01, 0.01, 0.02, 0])
    branch = branches(time, deflection)
    assert (branch[time < 12.9] == LOADING).all()


def test_a_sine_turns_without_resting() -> None:
    time = np.arange(0.0, 60.0, 0.01)
    branch = branches(time, 0.01 * (1.0 - np.cos(time)))
    assert not (branch == RESTING).any()
    assert ((branch == LOADING) == (np.sin(time) > 0.0)).mean() > 0.99


def test_one_ramp_is_one_branch() -> None:
    time = np.arange(0.0, 5.0, 0.01)
    assert (branches(time, 0.004 * time) == LOADING).all()
    assert (branches(time, 0.02 - 0.004 * time) == UNLOADING).all()
