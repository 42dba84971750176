"""Lag and delay of the force channel: phase, gain, steps."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, harmonic, loop_area, only, sine

FREQUENCY = 4.0
OMEGA = 2.0 * math.pi * FREQUENCY
A = STIFFNESS * 0.005


def read(samples: int = 500, **changed: float) -> complex:
    time, x = sine(FREQUENCY, 0.005, 0.012, 6.0, samples)
    return harmonic(time, drive(only("force_lag", law=LINEAR, **changed), time, x), FREQUENCY)


@pytest.mark.parametrize("tau", [0.001, 0.02, 0.2])
def test_a_lag_has_the_gain_and_phase_of_first_order(tau: float) -> None:
    # straight lines between 500 moments of a cycle: (2 pi / 500)^2 / 12 = 1.3e-5; what is left of the start after
    # 5 cycles is exp(-1.25 / 0.2)
    assert abs(read(lag=tau) - A / (1.0 + 1j * OMEGA * tau)) < A * (2e-5 + math.exp(-1.25 / tau))


@pytest.mark.parametrize("delay", [0.0012, 0.012, 0.05])
def test_a_delay_has_its_phase_and_no_loss(delay: float) -> None:
    # moments kept at most delta/14 + 1/500 of a cycle apart: gain within (w h)^2 / 8 of 1
    h = delay / 14.0 + 1.0 / FREQUENCY / 500.0
    got = read(delay=delay)
    assert abs(got) == pytest.approx(A, rel=(OMEGA * h) ** 2 / 8.0)
    assert cmath.phase(got / cmath.exp(-1j * OMEGA * delay)) == pytest.approx(0.0, abs=(OMEGA * h) ** 2 / 8.0)


def test_delay_and_lag_multiply() -> None:
    expected = A * cmath.exp(-1j * OMEGA * 0.01) / (1.0 + 1j * OMEGA * 0.02)
    assert abs(read(lag=0.02, delay=0.01) - expected) < 1e-3 * A


def test_a_ramp_is_read_late_by_lag_and_delay() -> None:
    # both are exact on a straight line, once the start has died away
    time = np.linspace(0.0, 1.0, 1001)
    force = drive(only("force_lag", law=LINEAR, lag=0.02, delay=0.0137), time, 0.02 * time + 0.001)
    assert force[-1] == pytest.approx(STIFFNESS * (0.02 * (time[-1] - 0.0337) + 0.001), rel=1e-10)


def test_a_delay_is_exact_at_uneven_moments_on_a_straight_line() -> None:
    time = np.cumsum(np.random.default_rng(2).uniform(1e-4, 0.01, 400))
    force = drive(only("force_lag", law=LINEAR, delay=0.03), time, 0.01 * time + 0.001)
    late = time > time[0] + 0.03
    assert force[late] == pytest.approx(STIFFNESS * (0.01 * (time[late] - 0.03) + 0.001), rel=1e-12)
    assert np.all(force[~late] == force[0])


def test_after_a_step_the_reading_closes_in_exponentially() -> None:
    time = np.concatenate([[0.0, 1e-9], np.linspace(0.01, 0.1, 10)])
    x = np.concatenate([[0.01], np.full(11, 0.02)])
    force = drive(only("force_lag", law=LINEAR, lag=0.03), time, x)
    expected = STIFFNESS * (0.02 - 0.01 * np.exp(-time / 0.03))
    assert force[1:] == pytest.approx(expected[1:], rel=1e-7)


def test_its_loop_runs_the_wrong_way_round() -> None:
    # area pi a Im(F): -2.2 % of the elastic energy is the documented size for 5 ms at 0.5 Hz, the sign is the point
    time, x = sine(0.5, 0.01, 0.012, 3.0, 2000)
    last = slice(-2001, None)
    force = drive(only("force_lag", law=LINEAR, lag=0.005), time, x)
    w_tau = 2.0 * math.pi * 0.5 * 0.005
    expected = -math.pi * 0.01 * STIFFNESS * 0.01 * w_tau / (1.0 + w_tau**2)
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=1e-3)


def test_a_force_that_stands_still_is_read_right_from_the_start() -> None:
    force = drive(only("force_lag", law=LINEAR, lag=0.5, delay=0.1), np.linspace(0.0, 0.1, 5), 0.01)
    assert force == pytest.approx(STIFFNESS * 0.01, rel=1e-14)


def test_looking_again_at_a_moment_does_not_shorten_the_memory() -> None:
    tire = only("force_lag", law=LINEAR, delay=0.05)
    once, often = tire.initial_state, tire.initial_state
    for i in range(40):
        step = (0.01 + 1e-4 * i, math.inf, 0.005 * i)
        expected, once = tire.step(*step, once)
        for _ in range(20):
            force, often = tire.step(*step, often)
        assert force == expected


@pytest.mark.parametrize(
    "quality", [0.1, 0.4999999, 0.5, 0.5000001, 1.0 / math.sqrt(3.0), 1.0 / math.sqrt(2.0), 1.0]
)
@pytest.mark.parametrize("tau", [0.002, 0.03])
def test_a_low_pass_of_second_order_has_its_gain_and_phase(tau: float, quality: float) -> None:
    # As above; from rest at the bottom of the sine little is left after 5 cycles.
    expected = A / (1.0 + 1j * OMEGA * tau + (1j * OMEGA * quality * tau) ** 2)
    assert abs(read(lag=tau, quality=quality) - expected) < 1e-4 * A


def test_without_quality_the_order_is_the_first() -> None:
    time = np.linspace(0.0, 0.5, 200)
    x = 0.01 + 0.002 * np.sin(20.0 * time)
    nearly = drive(only("force_lag", law=LINEAR, lag=0.03, quality=1e-5), time, x)
    assert nearly == pytest.approx(drive(only("force_lag", law=LINEAR, lag=0.03), time, x), rel=1e-7)


@pytest.mark.parametrize("quality", [0.3, 0.7])
def test_after_a_step_a_low_pass_of_second_order_has_its_step_response(quality: float) -> None:
    # Roots r of (Q tau)^2 r^2 + tau r + 1: the step leaves (r2 exp(r1 t) - r1 exp(r2 t)) / (r2 - r1), complex or not.
    tau = 0.03
    root = cmath.sqrt(1.0 - 4.0 * quality**2)
    first, second = ((-1.0 + sign * root) / (2.0 * quality**2 * tau) for sign in (1.0, -1.0))
    time = np.concatenate([[0.0, 1e-9], np.linspace(0.01, 0.1, 10)])
    x = np.concatenate([[0.01], np.full(11, 0.02)])
    force = drive(only("force_lag", law=LINEAR, lag=tau, quality=quality), time, x)
    left = ((second * np.exp(first * time) - first * np.exp(second * time)) / (second - first)).real
    assert force[1:] == pytest.approx(STIFFNESS * (0.02 - 0.01 * left[1:]), rel=1e-6)
