"""The motion of a recording: branches, cycles, distance since reversal, rates, corners; against the motion driven."""

import numpy as np
import pytest
from tirelab.preprocessing.kinematics import motion_of

STEP = 0.01
RATE = 2e-3
DEPTH = 20e-3
SIDE = 1000  # samples of a loading or an unloading


def triangles(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return time [s] and deflection [m] of so many loadings and unloadings at RATE."""
    samples = np.arange(2 * SIDE * count + 1)
    return samples * STEP, RATE * STEP * (SIDE - np.abs(samples % (2 * SIDE) - SIDE))


def noisy(values: np.ndarray, sigma: float, seed: int = 1) -> np.ndarray:
    return values + sigma * np.random.default_rng(seed).standard_normal(values.size)


def test_branches_and_cycles_of_triangles() -> None:
    time, deflection = triangles(3)
    motion = motion_of(time, deflection)
    middle = np.arange(SIDE // 2, time.size, SIDE)  # of each branch
    np.testing.assert_array_equal(motion.direction[middle], [1, -1, 1, -1, 1, -1])
    np.testing.assert_array_equal(motion.cycle[middle], [0, 0, 1, 1, 2, 2])


@pytest.mark.parametrize("sigma", [0.0, 8e-6])
def test_the_distance_since_the_last_reversal(sigma: float) -> None:
    time, deflection = triangles(2)
    motion = motion_of(time, noisy(deflection, sigma))
    travelled = RATE * STEP * (np.arange(time.size) % SIDE)
    away = np.abs(np.arange(time.size) % SIDE - SIDE / 2) < 0.4 * SIDE
    np.testing.assert_allclose(
        motion.since_reversal[away], travelled[away], atol=max(5.0 * sigma, 3 * RATE * STEP)
    )


def test_the_largest_deflection_so_far() -> None:
    time = np.arange(3000) * STEP
    deflection = 1e-3 * time * (1.0 + 0.9 * np.sin(time))
    motion = motion_of(time, deflection)
    np.testing.assert_allclose(motion.deepest, np.maximum.accumulate(deflection), atol=2e-6)
    assert np.all(np.diff(motion.deepest) >= 0.0)


@pytest.mark.parametrize("sigma", [0.0, 8e-6, 5e-5])
def test_the_noise_of_the_reading_is_measured(sigma: float) -> None:
    time, deflection = triangles(2)
    motion = motion_of(time, noisy(deflection, sigma))
    assert motion.noise == pytest.approx(max(sigma, 1e-9), rel=0.06)
    # Smoothing leaves less noise than was read, except at corners, where the reading itself is taken.
    assert np.all(motion.smoothed_noise <= motion.noise * (1.0 + 1e-12))
    assert np.median(motion.smoothed_noise) < 0.5 * motion.noise or sigma == 0.0


def test_a_hold_makes_one_reversal_within_it() -> None:
    up = np.linspace(0.0, DEPTH, 1000)
    deflection = np.concatenate([up, np.full(800, DEPTH), up[::-1]])
    motion = motion_of(np.arange(deflection.size) * STEP, noisy(deflection, 5e-6))
    (reversal,) = np.flatnonzero(np.diff(motion.direction))
    assert 1000 - 10 <= reversal <= 1800 + 10
    assert np.all(motion.cycle == 0.0)


def test_noise_in_a_hold_makes_no_reversal() -> None:
    time, deflection = triangles(1)
    motion = motion_of(time, noisy(deflection, 1e-4))
    assert np.count_nonzero(np.diff(motion.direction)) == 1


def test_rates_of_a_sine() -> None:
    time = np.arange(4000) * STEP
    angle = 2.0 * np.pi * 0.5
    deflection = 10e-3 * (1.0 - np.cos(angle * time))
    motion = motion_of(time, noisy(deflection, 5e-6))
    inside = slice(50, -50)
    rate, acceleration = 10e-3 * angle * np.sin(angle * time), 10e-3 * angle**2 * np.cos(angle * time)
    assert np.std((motion.rate - rate)[inside]) < 0.02 * np.std(rate)
    assert np.std((motion.acceleration - acceleration)[inside]) < 0.1 * np.std(acceleration)
    assert np.std((motion.deflection - deflection)[inside]) < 0.5 * 5e-6
    # One sample in 400 of noise alone misses a cubic by that much.
    assert np.mean(motion.resolved) > 0.99


def test_a_corner_within_a_sample_is_not_resolved_and_keeps_its_reading() -> None:
    time, deflection = triangles(1)
    reading = noisy(deflection, 1e-7)
    motion = motion_of(time, reading)
    assert not motion.resolved[SIDE]
    assert motion.deflection[SIDE] == reading[SIDE]
    assert motion.smoothed_noise[SIDE] == motion.noise
    assert np.mean(motion.resolved) > 0.98


def test_uneven_samples_have_the_motion_of_even_ones() -> None:
    rng = np.random.default_rng(3)
    time = np.cumsum(STEP * (1.0 + 0.3 * rng.uniform(-1.0, 1.0, 4000)))
    angle = 2.0 * np.pi * 0.2
    deflection = 10e-3 * (1.0 - np.cos(angle * time))
    motion = motion_of(time, deflection)
    inside = slice(50, -50)
    np.testing.assert_allclose(motion.deflection, deflection, atol=5e-6)
    rate = 10e-3 * angle * np.sin(angle * time)
    assert np.max(np.abs(motion.rate - rate)[inside]) < 0.05 * np.max(rate)


def test_a_gauge_in_coarse_steps_still_has_the_motions_rate() -> None:
    # With a noise of a nanometre the splines followed every step of the gauge.
    time, deflection = triangles(1)
    step = 1e-4
    motion = motion_of(time, np.round((1.003 * deflection) / step) * step)
    away = np.abs(np.arange(time.size) % SIDE - SIDE / 2) < 0.4 * SIDE
    speed = 1.003 * RATE
    assert motion.noise == pytest.approx(step / np.sqrt(12.0))
    assert np.std(np.abs(motion.rate[away]) - speed) < 0.25 * speed


def test_no_rate_rings_beside_a_corner() -> None:
    """Pieces between corners are smoothed each by itself: a spline across a corner misses the rate by a tenth there."""
    time, deflection = triangles(2)
    motion = motion_of(time, noisy(deflection, 2e-6))
    assert not motion.resolved.all()
    rate = np.where(np.arange(time.size) // SIDE % 2 == 0, RATE, -RATE)
    corners = np.arange(SIDE, time.size - 1, SIDE)
    beside = np.zeros(time.size, dtype=bool)
    for corner in corners:
        beside[[*range(corner - 15, corner - 4), *range(corner + 5, corner + 16)]] = True
    # Noise of 2 um over half of the 25 samples that the shortest usual spline takes: 1 % of 2 mm/s and its tail.
    assert np.abs(motion.rate[beside] / rate[beside] - 1.0).max() < 0.05
