"""Mass: force in proportion to the acceleration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, harmonic, only, sine


@pytest.mark.parametrize("frequency", [1.0, 2.0, 8.0])
def test_its_amplitude_is_m_omega_squared_a(frequency: float) -> None:
    # K - m w^2 of the amplitude; the acceleration is followed to first order, 1/2000 of a cycle or 0.3 % of it
    m, a = 2.5, 0.008
    time, x = sine(frequency, a, 0.012, 3.0, 2000)
    force = harmonic(time, drive(only("inertia", law=LINEAR, mass=m), time, x), frequency)
    inertial = force - STIFFNESS * a
    expected = -m * (2.0 * math.pi * frequency) ** 2 * a
    assert abs(inertial - expected) < 0.01 * abs(expected)


def test_constant_acceleration_weighs() -> None:
    time = np.linspace(0.0, 0.1, 201)
    x = 0.01 + 0.5 * time**2
    force = drive(only("inertia", law=LINEAR, mass=2.0), time, x)
    assert force[-1] == pytest.approx(STIFFNESS * x[-1] + 2.0 * 1.0, rel=1e-6)


def test_it_acts_in_the_air_too() -> None:
    time = np.linspace(0.0, 0.1, 201)
    force = drive(only("inertia", mass=2.0), time, -0.1 - 0.5 * time**2)
    assert force[-1] == pytest.approx(-2.0, rel=1e-6)
