"""The tracking time that a recorded deflection tells."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from tirelab.simulate import simulate, track
from tirelab.tracking_time import RIDE_JERK, SETTLING, likeliest_tracking, of_a_ride, serving_tracking


def recording(time: np.ndarray, deflection: np.ndarray) -> SimpleNamespace:
    return SimpleNamespace(time=time, deflection=deflection, surface_radius=np.full_like(time, np.inf))


def ride(seed: int, noise: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, deflection read and true rate of a ride: 30 sines of random phase to 8 Hz, 5 mm in all, at 400 Hz."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 20.0, 2.5e-3)
    w = 2.0 * math.pi * np.linspace(0.3, 8.0, 30)[:, None]
    phase = random.uniform(0.0, 2.0 * math.pi, (30, 1))
    size = 5e-3 * math.sqrt(2.0 / 30.0)
    x = 0.012 + size * np.sum(np.sin(w * time + phase), axis=0)
    return (
        time,
        x + noise * random.standard_normal(time.size),
        size * np.sum(w * np.cos(w * time + phase), axis=0),
    )


@pytest.mark.parametrize("noise", [2e-6, 8e-6, 5e-5])
def test_a_ride_tells_its_noise_and_nearly_the_best_tracking_time(noise: float) -> None:
    time, x, true_rate = ride(1, noise)
    found = likeliest_tracking([recording(time, x)])

    def error(tracking_time: float) -> float:
        return float(np.sqrt(np.mean((track(time, x, tracking_time)[0] - true_rate)[20:] ** 2)))

    least = min(error(T) for T in np.geomspace(3e-4, 2e-2, 60))
    assert found.noise[0] == pytest.approx(noise, rel=0.1)
    assert error(found.tracking_time) < 1.15 * least


def test_a_random_jerk_tells_its_intensity() -> None:
    # the model itself: jerk as kicks of the acceleration, of intensity s^2 / T^5 with T = 5 ms
    random = np.random.default_rng(4)
    T, s, d = 5e-3, 1e-4, 1e-3
    kicks = random.standard_normal(20_000) * math.sqrt(s * s / T**5 * d)
    rate = np.cumsum(np.cumsum(kicks) * d)
    x = np.cumsum(rate) * d
    found = likeliest_tracking([recording(np.arange(x.size) * d, x + s * random.standard_normal(x.size))])
    # the estimate of T from n readings spreads by a percent or two; sums in place of integrals cost a few more
    assert found.tracking_time == pytest.approx(T, rel=0.05)
    assert found.noise[0] == pytest.approx(s, rel=0.03)


def test_a_slow_recording_does_not_ask_for_more_than_a_ride_allows() -> None:
    random = np.random.default_rng(2)
    time = np.arange(0.0, 60.0, 0.02)
    x = 0.01 + 0.008 * np.sin(0.4 * time) + 8e-6 * random.standard_normal(time.size)
    found = likeliest_tracking([recording(time, x)])
    assert found.tracking_time == pytest.approx((found.noise[0] ** 2 / RIDE_JERK) ** 0.2)
    assert found.tracking_time < 3e-3


def test_recordings_too_short_to_tell_are_taken_as_exact() -> None:
    time = np.arange(float(SETTLING))
    assert likeliest_tracking([recording(time, 0.01 + 0.001 * time)]) == (0.0, (0.0,))


def test_a_short_recording_beside_a_long_one_says_nothing() -> None:
    time, x, _ = ride(3, 8e-6)
    alone = likeliest_tracking([recording(time, x)])
    both = likeliest_tracking([recording(time, x), recording(time[:5], x[:5])])
    assert both.tracking_time == alone.tracking_time
    assert both.noise == (*alone.noise, 0.0)


def test_the_tracking_time_that_serves_is_the_longest_that_does_as_well() -> None:
    # Read every 20 ms, T of a ride (1 ms or so) changes nothing: only what is far beyond the interval would.
    time = np.arange(0.0, 20.0, 0.02)
    x = 0.01 + 0.004 * np.sin(2.0 * math.pi * time)
    tire = TireModel(effects=((CATALOGUE["inertia"], (5.0,)),))
    read = recording(time, x + 2e-6 * np.random.default_rng(6).standard_normal(time.size))
    read.force = simulate(replace(tire, tracking_time=1e-5), recording(time, x))
    read.name = "sine"
    assert serving_tracking(tire, [read], [np.ones(time.size, dtype=bool)], 2e-6) == of_a_ride(2e-6)


def test_a_tire_that_looks_at_no_rate_keeps_its_tracking_time() -> None:
    assert serving_tracking(TireModel(tracking_time=0.004), [], [], 1e-5) == 0.004
