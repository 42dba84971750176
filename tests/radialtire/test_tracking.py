"""Rate and acceleration: exact on what they should be, and against the same filter written with matrices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from radialtire import tracking


def follow(time: np.ndarray, deflection: np.ndarray, tracking_time: float) -> tuple[np.ndarray, np.ndarray]:
    track = tracking.begin(float(deflection[0]))
    found = [(tracking.rate(track), tracking.acceleration(track))]
    for d, x in zip(np.diff(time), deflection[1:], strict=True):
        track = tracking.follow(track, float(d), float(x), tracking_time)
        found.append((tracking.rate(track), tracking.acceleration(track)))
    rate, acceleration = np.array(found).T
    return rate, acceleration


def test_before_the_second_reading_nothing_moves() -> None:
    assert tracking.rate(tracking.begin(0.02)) == 0.0
    assert tracking.acceleration(tracking.begin(0.02)) == 0.0
    assert tracking.rate(tracking.UNTRACKED) == 0.0


def test_the_second_reading_gives_the_difference() -> None:
    track = tracking.follow(tracking.begin(0.01), 0.005, 0.011, 2e-3)
    assert tracking.rate(track) == pytest.approx(0.2, rel=1e-12)
    assert tracking.acceleration(track) == 0.0


@given(st.floats(0.0, 5e-3), st.lists(st.floats(1e-4, 1e-2), min_size=60, max_size=60))
def test_constant_acceleration_is_followed_exactly_at_any_spacing(
    tracking_time: float, steps: list[float]
) -> None:
    # a Kalman filter has no bias on the motion of its own model; what it starts from fades within some T
    time = np.concatenate([[0.0], np.cumsum(steps)])
    rate, acceleration = follow(time, 0.01 + 0.1 * time - 2.0 * time**2, tracking_time)
    if time[-1] > 40.0 * tracking_time:
        assert rate[-1] == pytest.approx(0.1 - 4.0 * time[-1], abs=2e-3)
        assert acceleration[-1] == pytest.approx(-4.0, abs=0.2)


def test_it_is_the_kalman_filter_of_a_random_jerk() -> None:
    # a second formulation: matrices in SI units, process noise by numerical quadrature of its defining integral
    random = np.random.default_rng(3)
    time = np.cumsum(random.uniform(1e-3, 6e-3, 80))
    deflection = 0.01 + 0.005 * np.sin(30.0 * time) + 1e-5 * random.standard_normal(80)
    T = 3e-3
    rate, acceleration = follow(time, deflection, T)

    nodes, weights = np.polynomial.legendre.leggauss(5)
    d = time[1] - time[0]
    state = np.array([deflection[1], (deflection[1] - deflection[0]) / d, 0.0])
    spread = 1e4  # of the acceleration, in units of 4 / d^4, which also makes the difference uncertain
    covariance = np.array(
        [
            [1.0, 1.0 / d, 0.0],
            [1.0 / d, (2.0 + spread) / d**2, 2.0 * spread / d**3],
            [0.0, 2.0 * spread / d**3, 4.0 * spread / d**4],
        ]
    )
    for i, d in enumerate(np.diff(time)[1:], start=2):
        move = np.array([[1.0, d, d * d / 2.0], [0.0, 1.0, d], [0.0, 0.0, 1.0]])
        jerked = np.zeros((3, 3))
        for node, weight in zip(nodes, weights, strict=True):
            left = d * (1.0 - node) / 2.0
            kick = np.array([left * left / 2.0, left, 1.0])
            jerked += weight * d / 2.0 * np.outer(kick, kick)
        state = move @ state
        covariance = move @ covariance @ move.T + jerked / T**5
        gain = covariance[:, 0] / (covariance[0, 0] + 1.0)
        state = state + gain * (deflection[i] - state[0])
        covariance = covariance - np.outer(gain, covariance[0])
        assert rate[i] == pytest.approx(state[1], rel=1e-7, abs=1e-7)
        assert acceleration[i] == pytest.approx(state[2], rel=1e-7, abs=1e-5)


def test_without_noise_the_error_of_the_rate_falls_with_the_square_of_the_interval() -> None:
    def errors(count: int) -> tuple[float, float]:
        time = np.linspace(0.0, 1.0, count + 1)
        rate, acceleration = follow(time, 0.01 * np.sin(20.0 * time), 0.0)
        half = slice(count // 2, None)
        off = np.abs(rate - 0.2 * np.cos(20.0 * time))[half].max()
        off2 = np.abs(acceleration + 4.0 * np.sin(20.0 * time))[half].max()
        return float(off), float(off2)

    coarse, fine = errors(500), errors(1000)
    assert math.log2(coarse[0] / fine[0]) == pytest.approx(2.0, abs=0.1)
    assert math.log2(coarse[1] / fine[1]) == pytest.approx(1.0, abs=0.1)


def test_on_a_noisy_ride_it_beats_plain_differences() -> None:
    # 30 sines of random phase to 8 Hz, 5 mm in all, read at 400 Hz with 8e-6 m of noise: the documented figures
    random = np.random.default_rng(1)
    time = np.arange(0.0, 20.0, 2.5e-3)
    w = 2.0 * math.pi * np.linspace(0.3, 8.0, 30)[:, None]
    phase = random.uniform(0.0, 2.0 * math.pi, (30, 1))
    size = 5e-3 * math.sqrt(2.0 / 30.0)
    clean = size * np.sum(np.sin(w * time + phase), axis=0)
    true_rate = size * np.sum(w * np.cos(w * time + phase), axis=0)
    true_acceleration = -size * np.sum(w * w * np.sin(w * time + phase), axis=0)
    read = clean + 8e-6 * random.standard_normal(time.size)
    settled = slice(20, None)

    def rms(off: np.ndarray) -> float:
        return float(np.sqrt(np.mean(off[settled] ** 2)))

    rate, acceleration = follow(time, read, 2.3e-3)
    difference = np.diff(read, prepend=read[0]) / 2.5e-3
    second = np.diff(difference, prepend=0.0) / 2.5e-3
    assert rms(rate - true_rate) == pytest.approx(4e-3, rel=0.1)
    assert rms(acceleration - true_acceleration) == pytest.approx(1.3, rel=0.1)
    assert rms(difference - true_rate) == pytest.approx(9e-3, rel=0.1)
    assert rms(second - true_acceleration) == pytest.approx(3.2, rel=0.1)
