"""The motions that a rig can drive."""

import numpy as np
import pytest
from tirelab.planning.waveforms import MENU, WAVEFORMS, Limits, fast_sine, sample_times, slow_triangles

LIMITS = Limits(deepest=0.02, fastest=0.15, step=0.005, longest=40.0)


@pytest.mark.parametrize("name", sorted(MENU))
def test_every_waveform_keeps_within_the_rig(name: str) -> None:
    path = MENU[name](LIMITS)
    assert path.size == sample_times(LIMITS).size
    assert path.min() >= -1e-12
    assert path.max() <= 0.02 + 1e-12
    # A difference of samples may exceed a sine's own rate by rounding only; a corner never does.
    assert np.abs(np.diff(path)).max() / LIMITS.step <= 0.15 * 1.02


def test_the_menu_holds_all_motions_of_a_test_after_a_diagnosis() -> None:
    assert set(WAVEFORMS) < set(MENU)


def test_slow_triangles_are_whole_and_forty_times_slower() -> None:
    """40 s at 150 / 40 mm/s are 150 mm: 3.75 cycles of 40 mm, so four."""
    path = slow_triangles(LIMITS)
    tops = (path[1:-1] > path[:-2]) & (path[1:-1] >= path[2:])
    assert np.count_nonzero(tops) == 4
    assert path[0] == 0.0
    assert path[-1] < 0.02 * 8 / path.size * 1.01


def test_a_fast_sine_reaches_the_fastest_rate() -> None:
    assert np.abs(np.gradient(fast_sine(LIMITS), LIMITS.step)).max() == pytest.approx(0.15, rel=0.01)
