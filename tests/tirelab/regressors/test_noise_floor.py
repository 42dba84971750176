"""The noise of a recording and the gauge that steps."""

import numpy as np
import pytest
from tirelab.regressors.gauge import destepped
from tirelab.regressors.noise_floor import gauge_step, noise_floor, white_level

TIME = np.linspace(0.0, 10.0, 4001)
RAMP = 2e-3 * TIME
STEP = 5e-5
STEPPED = STEP * np.round(RAMP / STEP)


def test_step_of_a_gauge_that_repeats_its_reading_is_found() -> None:
    assert gauge_step(STEPPED) == pytest.approx(STEP)


def test_noisy_gauge_has_no_step() -> None:
    assert gauge_step(RAMP + 1e-6 * np.random.default_rng(0).normal(size=TIME.size)) == 0.0


def test_tire_at_rest_is_no_step() -> None:
    held = np.where(TIME < 5.0, RAMP, 0.01) * (1.0 + 0.1 * np.sin(TIME * (TIME < 5.0)))
    assert gauge_step(held) == 0.0


def test_ramps_between_holds_are_no_steps() -> None:
    level = np.clip(TIME % 4.0, 0.0, 1.0) + np.floor(TIME / 4.0)
    assert gauge_step(5e-3 * level) == 0.0


def test_motion_behind_the_steps_is_nearer_than_the_reading() -> None:
    behind = destepped(TIME, STEPPED, STEP)
    inside = slice(100, -100)
    assert np.abs(behind - RAMP)[inside].max() < 0.1 * STEP


def test_floor_counts_the_steps_through_the_stiffness() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.5, TIME.size)
    floor = noise_floor(noise, np.full(TIME.size, 15e3), 0.0, STEP)
    uniform = 15e3 * (STEPPED - RAMP)
    assert floor.steps == pytest.approx(float(np.std(uniform)), rel=0.02)
    assert floor.amplifier == pytest.approx(0.5, rel=0.05)
    assert floor.level == pytest.approx(np.hypot(floor.amplifier, floor.steps))


def test_white_level_does_not_see_a_slow_motion() -> None:
    noise = np.random.default_rng(2).normal(0.0, 2.0, TIME.size)
    assert white_level(noise + 500.0 * np.sin(TIME)) == pytest.approx(2.0, rel=0.06)
