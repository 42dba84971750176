"""A gauge that steps, and the motion behind it: straight lines between the middles of its stays."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.regressors.gauge import destepped, staircase_step

TIME = np.linspace(0.0, 10.0, 4001)
RAMP = 2e-3 * TIME
STEP = 5e-5
STEPPED = STEP * np.round(RAMP / STEP)


def test_step_of_a_gauge_that_repeats_its_reading_is_found() -> None:
    assert staircase_step(STEPPED) == pytest.approx(STEP)


@pytest.mark.parametrize("parts", [(0.25, 0.6), (0.6, 0.25), (0.1, 0.9)])
def test_first_and_last_change_may_be_parts_of_a_step(parts: tuple[float, float]) -> None:
    """A rig that starts and ends between two levels: its own zero is no level."""
    read = STEPPED.copy()
    read[:3], read[-3:] = STEP * (1.0 - parts[0]), read[-4] + STEP * parts[1]
    assert staircase_step(read) == pytest.approx(STEP)


def test_noisy_gauge_has_no_step() -> None:
    assert staircase_step(RAMP + 1e-6 * np.random.default_rng(0).normal(size=TIME.size)) == 0.0


def test_tire_at_rest_is_no_step() -> None:
    held = np.where(TIME < 5.0, RAMP, 0.01) * (1.0 + 0.1 * np.sin(TIME * (TIME < 5.0)))
    assert staircase_step(held) == 0.0


def test_ramps_between_holds_are_no_steps() -> None:
    level = np.clip(TIME % 4.0, 0.0, 1.0) + np.floor(TIME / 4.0)
    assert staircase_step(5e-3 * level) == 0.0


def test_motion_behind_the_steps_is_nearer_than_the_reading() -> None:
    behind = destepped(TIME, STEPPED, STEP)
    inside = slice(100, -100)
    assert np.abs(behind - RAMP)[inside].max() < 0.1 * STEP


def test_a_ramp_read_in_steps_is_a_ramp_again() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    ramp, step = 1e-3 * time, 1e-4
    read = step * np.round(ramp / step)
    inside = slice(60, -60)  # the first and the last stay have no middle of their own
    found = destepped(time, read, step)
    assert np.abs(found - ramp)[inside].max() < 0.06 * step
    assert np.abs(read - ramp)[inside].max() > 0.45 * step


def test_no_reading_is_moved_by_more_than_half_a_step() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    read = 1e-4 * np.round(10.0 * np.sin(time))
    assert np.abs(destepped(time, read, 1e-4) - read).max() <= 0.5e-4 + 1e-15


def test_a_rest_on_one_level_stays_there() -> None:
    time = np.linspace(0.0, 10.0, 100)
    np.testing.assert_array_equal(destepped(time, np.full(100, 3e-3), 1e-4), np.full(100, 3e-3))
