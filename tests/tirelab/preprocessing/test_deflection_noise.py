"""The noise of a deflection reading: random, rounded to a gauge's steps, both, or none."""

import numpy as np
import pytest
from tirelab.preprocessing.deflection_noise import LEAST_NOISE, deflection_noise, gauge_step

DEPTH = 25e-3
DURATION = 60.0


def triangle(time: np.ndarray, rate: float) -> np.ndarray:
    """Return loading and unloading to DEPTH at a constant rate [m/s]."""
    return DEPTH * (1.0 - np.abs(2.0 * (time * rate / (2.0 * DEPTH) % 1.0) - 1.0))


def sine(time: np.ndarray, frequency: float) -> np.ndarray:
    return 0.5 * DEPTH * (1.0 - np.cos(2.0 * np.pi * frequency * time))


def trapezoid(time: np.ndarray) -> np.ndarray:
    """Return loading at 1.31 mm/s, a hold of 5 s, unloading, a hold of 5 s, again and again."""
    side, hold = DEPTH / 1.31e-3, 5.0
    at = time % (2.0 * (side + hold))
    return np.clip(1.31e-3 * np.minimum(at, 2.0 * side + hold - at), 0.0, DEPTH)


MOTIONS = {
    "triangle": lambda t: triangle(t, np.sqrt(2.0) * 1e-3),
    "sine": lambda t: sine(t, 0.0413),
    "trapezoid": trapezoid,
}


def rounded(values: np.ndarray, step: float) -> np.ndarray:
    return np.round(values / step) * step


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("rate", [50.0, 200.0, 1000.0])
@pytest.mark.parametrize("step", [2e-6, 10e-6, 50e-6])
def test_a_gauge_in_steps_has_the_noise_of_its_rounding(motion: str, rate: float, step: float) -> None:
    # It was 1e-9 m: most fifth differences of a slow, rounded motion are zero.
    time = np.arange(0.0, DURATION, 1.0 / rate)
    reading = rounded(MOTIONS[motion](time), step)
    assert gauge_step(reading) == pytest.approx(step, rel=1e-6)
    assert deflection_noise(reading) == pytest.approx(step / np.sqrt(12.0), rel=1e-6)


def test_a_gauge_of_50_um_of_which_84_percent_of_the_samples_repeat_the_last() -> None:
    time = np.arange(0.0, DURATION, 0.01)
    reading = rounded(triangle(time, 0.16 * 50e-6 / 0.01 * 1.003), 50e-6)
    assert np.mean(np.diff(reading) == 0.0) == pytest.approx(0.84, abs=0.01)
    assert deflection_noise(reading) == pytest.approx(50e-6 / np.sqrt(12.0), rel=1e-6)


def test_the_rounding_error_of_a_gauge_is_what_is_said_of_it() -> None:
    time = np.arange(0.0, DURATION, 0.01)
    motion = sine(time, 0.0413)
    reading = rounded(motion, 10e-6)
    assert deflection_noise(reading) == pytest.approx(np.std(reading - motion), rel=0.03)


@pytest.mark.parametrize("digits", [6, 7])
def test_a_step_that_the_file_has_rounded_again(digits: int) -> None:
    # A converter of 12 bits over 25 mm: 6.1035 um, written in um or in tenths of one.
    step = DEPTH / 4096
    time = np.arange(0.0, DURATION, 0.01)
    reading = np.round(rounded(sine(time, 0.0413), step), digits)
    assert deflection_noise(reading) == pytest.approx(step / np.sqrt(12.0), rel=1e-3)


@pytest.mark.parametrize("part", [0.5, 1.0, 3.0])
def test_noise_beside_rounding_adds_its_variance(part: float) -> None:
    # A median of whole steps is known to one part in seven at half a step of noise.
    step = 10e-6
    time = np.arange(0.0, DURATION, 0.005)
    noise = part * step * np.random.default_rng(1).standard_normal(time.size)
    reading = rounded(sine(time, 0.0413) + noise, step)
    assert deflection_noise(reading) == pytest.approx(step * np.sqrt(part**2 + 1.0 / 12.0), rel=0.15)


def test_a_reading_that_flickers_by_one_step_while_the_motion_is_on_the_grid() -> None:
    # 0.5 mm/s at 10 Hz are five steps of 10 um per sample exactly: only the noise leaves the grid.
    time = np.arange(0.0, DURATION, 0.1)
    noise = 3e-6 * np.random.default_rng(2).standard_normal(time.size)
    reading = rounded(triangle(time, 0.5e-3) + noise, 10e-6)
    assert deflection_noise(reading) >= 10e-6 / np.sqrt(12.0) * (1.0 - 1e-9)


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("rate", [50.0, 1000.0])
def test_exact_numbers_have_next_to_no_noise(motion: str, rate: float) -> None:
    reading = MOTIONS[motion](np.arange(0.0, DURATION, 1.0 / rate))
    assert gauge_step(reading) == 0.0
    assert deflection_noise(reading) == LEAST_NOISE


@pytest.mark.parametrize("speed", [0.5e-3, 1e-3, 20e-3])
def test_exact_numbers_at_constant_speed_lie_on_a_grid_that_is_no_gauges(speed: float) -> None:
    reading = triangle(np.arange(0.0, DURATION, 0.01), speed)
    assert deflection_noise(reading) == LEAST_NOISE


def test_a_staircase_of_the_rig_is_no_gauge() -> None:
    reading = np.floor(np.arange(0.0, DURATION, 0.1) / 2.0) * 1e-3
    assert gauge_step(reading) == 0.0


def test_the_digits_of_a_file_are_no_gauge() -> None:
    reading = np.round(sine(np.arange(0.0, DURATION, 0.01), 0.0413), 7)
    assert gauge_step(reading) == 0.0


def test_a_hold_has_no_step() -> None:
    assert deflection_noise(np.full(100, 5e-3)) == LEAST_NOISE


@pytest.mark.parametrize("sigma", [1e-6, 8e-6, 1e-4])
def test_random_noise_is_measured(sigma: float) -> None:
    time = np.arange(0.0, DURATION, 0.01)
    noise = sigma * np.random.default_rng(3).standard_normal(time.size)
    assert deflection_noise(sine(time, 0.0413) + noise) == pytest.approx(sigma, rel=0.05)


@pytest.mark.parametrize("scale", [1e-4, 1e-3, 1.0])
def test_a_gauge_of_a_small_specimen_has_its_own_noise_and_step(scale: float) -> None:
    """The same motion in micrometres: noise and steps are as much smaller."""
    time = np.arange(0.0, DURATION, 0.01)
    noisy = sine(time, 0.0413) + 8e-6 * np.random.default_rng(7).normal(size=time.size)
    assert deflection_noise(scale * noisy) == pytest.approx(scale * 8e-6, rel=0.05)
    reading = scale * rounded(sine(time, 0.0413), 50e-6)
    assert gauge_step(reading) == pytest.approx(scale * 50e-6, rel=1e-6)


def test_the_floors_of_a_tires_recording_do_not_depend_on_its_span() -> None:
    time = np.arange(0.0, DURATION, 0.01)
    for depth in (0.1, 1.0, 4.0):  # 2.5 mm to 100 mm
        assert deflection_noise(depth * sine(time, 0.0413)) == LEAST_NOISE
