"""The noise floor of a recording."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.preprocessing.levels import white_level
from tirelab.preprocessing.noise_floor import noise_floor

TIME = np.linspace(0.0, 10.0, 4001)
STEP = 5e-5


def test_floor_counts_the_steps_through_the_stiffness() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.5, TIME.size)
    floor = noise_floor(white_level(noise), np.full(TIME.size, 15e3), 0.0, STEP, 0.0)
    ramp = 2e-3 * TIME
    uniform = 15e3 * (STEP * np.round(ramp / STEP) - ramp)
    assert floor.steps == pytest.approx(float(np.std(uniform)), rel=0.02)
    assert floor.amplifier == pytest.approx(0.5, rel=0.05)
    assert floor.level == pytest.approx(np.hypot(floor.amplifier, floor.steps))


def test_a_reading_in_steps_has_their_error_however_slowly_it_moves() -> None:
    force = 2.0 * np.round(np.linspace(0.0, 100.0, 4001) / 2.0)
    slow = force - np.linspace(0.0, 100.0, 4001)
    floor = noise_floor(white_level(slow), np.full(force.size, 15e3), 0.0, 0.0, 2.0)
    assert floor.level == pytest.approx(float(np.std(slow)), rel=0.02)
