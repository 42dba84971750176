"""Deflection, rate and acceleration from a noisy reading."""

import numpy as np
import pytest
from tirelab.preprocessing.smoothing import smoothed

STEP = 0.005
TIME = np.arange(4000) * STEP
NOISE = 1e-5


def sines(time: np.ndarray, turns: int) -> np.ndarray:
    """Return one of three sines of 0.3 to 3 Hz, 4 mm in all, differentiated so many times."""
    parts = [(3e-3, 0.3, 0.1), (8e-4, 1.1, 0.8), (2e-4, 3.0, 2.0)]
    angles = [2.0 * np.pi * f for _, f, _ in parts]
    return np.sum(
        [
            a * w**turns * np.sin(w * time + p + 0.5 * np.pi * turns)
            for (a, _, p), w in zip(parts, angles, strict=True)
        ],
        axis=0,
    )


def read(seed: int) -> tuple[np.ndarray, ...]:
    return smoothed(
        sines(TIME, 0) + NOISE * np.random.default_rng(seed).standard_normal(TIME.size), STEP, NOISE
    )


def test_a_parabola_stays_what_it_is() -> None:
    # The penalty is on the third derivative, and at the ends value and slope go on: inside nothing is lost.
    x = 1e-3 + 2e-3 * TIME + 3e-4 * TIME**2
    level, rate, bend, _ = smoothed(x, STEP, NOISE)
    inside = slice(500, -500)
    assert level[inside] == pytest.approx(x[inside], abs=1e-8)
    assert rate[inside] == pytest.approx((2e-3 + 6e-4 * TIME)[inside], abs=1e-7)
    assert bend[inside] == pytest.approx(6e-4, rel=0.01)


def test_of_the_noise_less_than_half_stays() -> None:
    # A spline that passes a sine of 3 Hz read at 200 Hz averages ten samples or so: a third of the noise.
    for seed in range(3):
        level, rate, bend, leverage = read(seed)
        assert np.std(level - sines(TIME, 0)) < 0.5 * NOISE
        assert np.std(rate - sines(TIME, 1)) < 0.03 * np.std(sines(TIME, 1))
        assert np.std(bend - sines(TIME, 2)) < 0.15 * np.std(sines(TIME, 2))
        # What it says of its own error is right to a third.
        assert np.sqrt(np.mean(leverage)) * NOISE == pytest.approx(np.std(level - sines(TIME, 0)), rel=0.33)


def test_what_is_fitted_to_the_acceleration_is_not_drawn_to_zero() -> None:
    # A mean given the data has an error that it does not itself contain: the slope of the truth over it is 1.
    truth = sines(TIME, 2)
    for seed in range(3):
        bend = read(seed)[2]
        assert truth @ bend / (bend @ bend) == pytest.approx(1.0, abs=0.02)


def test_corners_stay_corners() -> None:
    # A triangle of 20 mm/s: 40 samples from its corners, three deviations of the stretch, two parts in a hundred.
    period = 400
    way = np.abs((np.arange(4000) % period) - period / 2)
    x = 0.02 * STEP * way
    _, rate, _, _ = smoothed(x + NOISE * np.random.default_rng(5).standard_normal(x.size), STEP, NOISE)
    place = np.arange(4000) % (period / 2)
    far = (place > 40) & (place < period / 2 - 40)
    expected = np.where(np.arange(4000) % period < period / 2, -0.02, 0.02)
    assert np.sqrt(np.mean((rate - expected)[far] ** 2)) < 0.02 * 0.02


def test_without_noise_next_to_nothing_is_smoothed() -> None:
    level, rate, bend, _ = smoothed(sines(TIME, 0), STEP, 1e-9)
    inside = slice(50, -50)
    assert level[inside] == pytest.approx(sines(TIME, 0)[inside], abs=1e-8)
    assert rate[inside] == pytest.approx(sines(TIME, 1)[inside], abs=1e-5)
    assert bend[inside] == pytest.approx(sines(TIME, 2)[inside], abs=0.01 * np.std(sines(TIME, 2)))
