"""A dashpot: the area of its loop, and its exponents."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, loop_area, only, sine


@pytest.mark.parametrize("frequency", [0.05, 0.5, 5.0])
def test_its_loop_has_the_area_of_a_dashpot(frequency: float) -> None:
    # pi c w a^2, growing with the frequency; the rate is followed to second order of 1/4000 of a cycle
    c, a = 300.0, 0.008
    time, x = sine(frequency, a, 0.012, 2.0, 4000)
    force = drive(only("viscous_damping", law=LINEAR, damping=c), time, x)
    last = slice(-4001, None)
    expected = math.pi * c * 2.0 * math.pi * frequency * a * a
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=1e-4)


def ramp(speed: float, depth: float, **changed: float) -> float:
    """Force beyond the elastic one at `depth` in a ramp at `speed`."""
    time = np.linspace(0.0, 0.02, 201)
    x = depth + speed * (time - time[-1])
    return float(drive(only("viscous_damping", law=LINEAR, **changed), time, x)[-1]) - STIFFNESS * depth


def test_speed_and_depth_enter_with_their_exponents() -> None:
    assert ramp(0.2, 0.02, damping=300.0) == pytest.approx(60.0, rel=1e-6)
    assert ramp(0.1, 0.01, damping=300.0, rate_exponent=0.5, deflection_exponent=2.0) == pytest.approx(
        30.0, rel=1e-6
    )
    assert ramp(0.4, 0.01, damping=300.0, rate_exponent=0.5) == pytest.approx(30.0 * 2.0, rel=1e-6)
    assert ramp(0.1, 0.02, damping=300.0, deflection_exponent=2.0) == pytest.approx(30.0 * 4.0, rel=1e-6)
    assert ramp(-0.4, 0.01, damping=300.0, rate_exponent=0.5) == pytest.approx(-60.0, rel=1e-6)


def test_the_way_back_is_damped_by_a_share_of_its_own() -> None:
    # the loop's area is the mean of both ways' dashpots: (1 + u)/2 pi c w a^2
    assert ramp(-0.2, 0.02, damping=300.0, rebound=2.5) == pytest.approx(-150.0, rel=1e-6)
    assert ramp(0.2, 0.02, damping=300.0, rebound=2.5) == pytest.approx(60.0, rel=1e-6)
    time, x = sine(0.5, 0.008, 0.012, 2.0, 4000)
    force = drive(only("viscous_damping", law=LINEAR, damping=300.0, rebound=2.5), time, x)
    last = slice(-4001, None)
    expected = 1.75 * math.pi * 300.0 * math.pi * 0.008**2
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=1e-4)


def test_a_tire_in_the_air_is_not_damped() -> None:
    time = np.linspace(0.0, 0.1, 101)
    assert np.all(drive(only("viscous_damping", damping=1e4), time, time - 0.2) == 0.0)
