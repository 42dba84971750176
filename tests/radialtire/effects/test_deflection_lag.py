"""A deflection channel that reads late: readings made late by theory are put right."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, harmonic, loop_area, only, sine

FREQUENCY = 4.0
OMEGA = 2.0 * math.pi * FREQUENCY


def test_a_first_order_lag_is_undone() -> None:
    # a channel of time constant tau reads 1 / (1 + i w tau) of the amplitude; the tire has all of it
    tau = 0.01
    time = np.arange(0.0, 1.1, 1e-4)
    true = 0.015 + 0.005 * np.sin(OMEGA * time)
    gain = 1.0 / (1.0 + 1j * OMEGA * tau)
    read = 0.015 + 0.005 * abs(gain) * np.sin(OMEGA * time + cmath.phase(gain))
    force = drive(only("deflection_lag", law=LINEAR, lag=tau), time, read)
    settled = time > 0.5
    # the rate is followed to second order in the interval of 1e-4 s: (w d)^2 is 6e-6 of the amplitude of 500 N
    assert np.max(np.abs(force - STIFFNESS * true)[settled]) < 0.02


@pytest.mark.parametrize("delay", [0.002, 0.008])
def test_a_delay_is_undone_to_the_second_order(delay: float) -> None:
    # what is left is the rest of the series of exp(i w delta), (w delta)^3 / 6 of the amplitude and smaller terms
    time = np.arange(0.0, 1.1, 1e-4)
    read = 0.015 + 0.005 * np.sin(OMEGA * (time - delay))
    force = drive(only("deflection_lag", law=LINEAR, delay=delay), time, read)
    true = STIFFNESS * (0.015 + 0.005 * np.sin(OMEGA * time))
    left = np.max(np.abs(force - true)[time > 0.5]) / 500.0
    assert left == pytest.approx((OMEGA * delay) ** 3 / 6.0, rel=0.1, abs=2e-4)


def test_it_makes_a_positive_loop_in_proportion_to_the_stiffness() -> None:
    # x + tau v on a spring K: a dashpot of K tau, so the area is pi K tau w a^2
    time, x = sine(0.5, 0.008, 0.012, 3.0, 4000)
    last = slice(-4001, None)
    force = drive(only("deflection_lag", law=LINEAR, lag=0.005), time, x)
    expected = math.pi * STIFFNESS * 0.005 * (2.0 * math.pi * 0.5) * 0.008**2
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=1e-3)


def test_it_leads_the_reading() -> None:
    time, x = sine(FREQUENCY, 0.005, 0.012, 8.0, 1000)
    force = harmonic(time, drive(only("deflection_lag", law=LINEAR, lag=0.004), time, x), FREQUENCY)
    assert cmath.phase(force) == pytest.approx(math.atan(OMEGA * 0.004), abs=1e-3)
