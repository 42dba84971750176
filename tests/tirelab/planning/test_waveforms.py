"""The motions that a rig can drive."""

import numpy as np
import pytest
from tirelab.planning.waveforms import (
    CORNER,
    MENU,
    STROKE,
    WAVEFORMS,
    Limits,
    fast_sine,
    sample_times,
    slow_triangles,
)

LIMITS = Limits(deepest=0.02, fastest=0.15, step=0.005, longest=40.0)


@pytest.mark.parametrize("name", sorted(MENU))
def test_every_waveform_keeps_within_the_rig(name: str) -> None:
    path = MENU[name](LIMITS)
    assert path.size == sample_times(LIMITS).size
    assert path.min() >= -1e-12
    assert path.max() <= 0.02 + 1e-12
    # A difference of samples may exceed a sine's own rate by rounding only; a corner never does.
    assert np.abs(np.diff(path)).max() / LIMITS.step <= 0.15 * 1.02


@pytest.mark.parametrize("name", sorted(set(MENU) - {"fast sine", "sweep"}))
def test_round_corners_take_nothing_off_the_stroke(name: str) -> None:
    """The sines swing from a fifth to four fifths of it; all others press to its end, but for what a sample misses: a
    corner at 150 mm/s that is only cut off lies 0.15 x 0.005 x 8 / 5 = 1.2 mm below.
    """
    assert MENU[name](LIMITS).max() == pytest.approx(LIMITS.deepest, rel=2e-3)


def test_the_menu_holds_all_motions_of_a_test_after_a_diagnosis() -> None:
    assert set(WAVEFORMS) < set(MENU)


def test_slow_triangles_are_whole_and_forty_times_slower() -> None:
    """40 s at 150 / 40 mm/s are 150 mm: 3.75 cycles of 40 mm, so four."""
    path = slow_triangles(LIMITS)
    tops = (path[1:-1] > path[:-2]) & (path[1:-1] >= path[2:])
    assert np.count_nonzero(tops) == 4
    # A sample of a cycle is 0.02 * 8 / 8000; a corner is rounded over eight of them.
    assert path[0] < 0.02 * 8 / path.size * 8
    assert path[-1] < 0.02 * 8 / path.size * 8


def test_a_fast_sine_reaches_the_fastest_rate() -> None:
    assert np.abs(np.gradient(fast_sine(LIMITS), LIMITS.step)).max() == pytest.approx(0.15, rel=0.01)


@pytest.mark.parametrize("name", sorted(MENU))
def test_a_rig_that_is_faster_than_its_sampling_drives_what_can_be_read(name: str) -> None:
    """20 mm in 20 samples of 5 ms are 200 mm/s; a corner turns that round within eight samples, weighed most at the
    middle: twice the mean change of the rate."""
    path = MENU[name](Limits(deepest=0.02, fastest=5.0, step=0.005, longest=40.0))
    rate = np.diff(path) / 0.005
    assert np.abs(rate).max() <= 0.02 / (STROKE * 0.005) * 1.02
    change = 2.0 * 0.02 / (STROKE * 0.005)
    assert np.abs(np.diff(rate)).max() <= 2.0 * change / CORNER * 1.05
