"""The noise floor of a recording."""

import numpy as np
import pytest
from tirelab.regressors.noise_floor import noise_floor, white_level

TIME = np.linspace(0.0, 10.0, 4001)
RAMP = 2e-3 * TIME
STEP = 5e-5
STEPPED = STEP * np.round(RAMP / STEP)


def test_floor_counts_the_steps_through_the_stiffness() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.5, TIME.size)
    floor = noise_floor(noise, np.full(TIME.size, 15e3), 0.0, STEP, 0.0)
    uniform = 15e3 * (STEPPED - RAMP)
    assert floor.steps == pytest.approx(float(np.std(uniform)), rel=0.02)
    assert floor.amplifier == pytest.approx(0.5, rel=0.05)
    assert floor.level == pytest.approx(np.hypot(floor.amplifier, floor.steps))


def test_white_level_does_not_see_a_slow_motion() -> None:
    noise = np.random.default_rng(2).normal(0.0, 2.0, TIME.size)
    assert white_level(noise + 500.0 * np.sin(TIME)) == pytest.approx(2.0, rel=0.06)


@pytest.mark.parametrize("step", [0.0, 1.0, 3.0])
def test_white_level_holds_for_forces_read_in_steps(step: float) -> None:
    noise = np.random.default_rng(3).normal(0.0, 1.0, 4000)
    ramp = 0.37 * np.arange(noise.size)
    read = ramp + noise if step == 0.0 else step * np.round((ramp + noise) / step)
    # The error of a rounded reading is uniform, beside the noise (B. Widrow); a twentieth is 2 standard errors.
    assert white_level(read - ramp) == pytest.approx(np.hypot(1.0, step / np.sqrt(12.0)), rel=0.05)


def test_a_reading_in_steps_has_their_error_however_slowly_it_moves() -> None:
    force = 2.0 * np.round(np.linspace(0.0, 100.0, 4001) / 2.0)
    slow = force - np.linspace(0.0, 100.0, 4001)
    floor = noise_floor(slow, np.full(force.size, 15e3), 0.0, 0.0, 2.0)
    assert floor.level == pytest.approx(float(np.std(slow)), rel=0.02)
