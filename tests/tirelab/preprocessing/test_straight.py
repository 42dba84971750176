"""A triangle has no acceleration between its turns, whatever rounding and smoothing leave; a sine has one."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.preprocessing.motion import motion_of
from tirelab.preprocessing.straight import at_one_rate, is_straight


def straight(time: np.ndarray, deflection: np.ndarray) -> bool:
    return at_one_rate(time, motion_of(time, deflection))


@pytest.mark.parametrize("noise", [0.0, 3e-6, 2e-5])
@pytest.mark.parametrize("period", [20.0, 7.3, 2.0])
def test_a_triangle_goes_at_one_rate_and_a_sine_does_not(period: float, noise: float) -> None:
    """Five decimals of a millimetre, as a logger writes them."""
    time = 0.01 * np.arange(round(300.0 * period))
    phase = time / period % 1.0
    error = noise * np.random.default_rng(1).standard_normal(time.size)
    triangle = 0.02 * (1.0 - np.abs(2.0 * phase - 1.0))
    assert straight(time, np.round(triangle + error, 8))
    assert not straight(time, np.round(0.01 * (1.0 - np.cos(2.0 * np.pi * phase)) + error, 8))


def test_a_bend_counts_from_the_noise_on() -> None:
    time = np.linspace(-1.0, 1.0, 201)
    none = np.zeros(201, dtype=bool)
    # t^2 is 0.3 beside its line, root mean square: sqrt(1/5 - 1/9)
    assert is_straight(time, 0.9e-6 / 0.298 * time**2, none, 1e-6)
    assert not is_straight(time, 1.1e-6 / 0.298 * time**2, none, 1e-6)
    assert is_straight(time, time**2, ~none, 1e-6)
