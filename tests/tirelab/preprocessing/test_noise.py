"""The standard deviation of noise from its bulk.

The noise of a deflection reading: random, rounded to a gauge's steps, both, or none.

A gauge that steps, and the motion behind it: straight lines between the middles of its stays.

The noise floor of a recording.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import butter, lfilter
from scipy.stats import norm
from tirelab.preprocessing.noise import (
    LEAST_NOISE,
    MEDIAN_TO_SIGMA,
    Noise,
    deflection_noise,
    destepped,
    gauge_step,
    noise_floor,
    noise_of,
    robust_sigma,
    staircase_step,
    trimmed_sigma,
    white_level,
)

FloatArray = NDArray[np.float64]


def test_the_factor_is_that_of_the_normal_law() -> None:
    assert pytest.approx(1.0 / norm.ppf(0.75), abs=1e-4) == MEDIAN_TO_SIGMA


def test_outliers_do_not_move_it() -> None:
    values = 3.0 * np.random.default_rng(1).standard_normal(20_000)
    values[::100] = 1e6
    # Its standard error is 1.17 sigma / sqrt(n) = 0.8 %; a hundredth of outliers adds 1.6 %.
    assert robust_sigma(values) == pytest.approx(3.0, rel=0.04)


def test_what_is_trimmed_of_a_normal_law_is_made_up_for() -> None:
    # Its standard error is 0.76 sigma / sqrt(n) = 0.2 %.
    assert trimmed_sigma(3.0 * np.random.default_rng(1).standard_normal(100_000)) == pytest.approx(
        3.0, rel=0.01
    )


def test_far_values_are_trimmed() -> None:
    values = 3.0 * np.random.default_rng(1).standard_normal(20_000)
    values[::50] = 1e6
    assert trimmed_sigma(values) == pytest.approx(3.0, rel=0.03)


def test_values_of_which_most_are_zero_have_no_median_but_a_scale() -> None:
    values = np.zeros(10_000)
    values[::4] = 1.0
    assert robust_sigma(values) == 0.0
    assert trimmed_sigma(values) == pytest.approx(0.5, rel=0.02)


def test_nothing_but_outliers_is_no_noise() -> None:
    values = np.zeros(100)
    values[::10] = 1.0
    assert trimmed_sigma(values) == 0.0


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


TIME = np.linspace(0.0, 10.0, 4001)
RAMP = 2e-3 * TIME
STEP = 5e-5
STEPPED = STEP * np.round(RAMP / STEP)


def test_step_of_a_gauge_that_repeats_its_reading_is_found() -> None:
    assert staircase_step(STEPPED) == pytest.approx(STEP)


@pytest.mark.parametrize("parts", [(0.25, 0.6), (0.6, 0.25), (0.1, 0.9)])
def test_first_and_last_change_may_be_parts_of_a_step(parts: tuple[float, float]) -> None:
    """A rig that starts and ends between two levels: its own zero is no level."""
    read = STEPPED.copy()
    read[:3], read[-3:] = STEP * (1.0 - parts[0]), read[-4] + STEP * parts[1]
    assert staircase_step(read) == pytest.approx(STEP)


def test_noisy_gauge_has_no_step() -> None:
    assert staircase_step(RAMP + 1e-6 * np.random.default_rng(0).normal(size=TIME.size)) == 0.0


def test_tire_at_rest_is_no_step() -> None:
    held = np.where(TIME < 5.0, RAMP, 0.01) * (1.0 + 0.1 * np.sin(TIME * (TIME < 5.0)))
    assert staircase_step(held) == 0.0


def test_ramps_between_holds_are_no_steps() -> None:
    level = np.clip(TIME % 4.0, 0.0, 1.0) + np.floor(TIME / 4.0)
    assert staircase_step(5e-3 * level) == 0.0


def test_motion_behind_the_steps_is_nearer_than_the_reading() -> None:
    behind = destepped(TIME, STEPPED, STEP)
    inside = slice(100, -100)
    assert np.abs(behind - RAMP)[inside].max() < 0.1 * STEP


def test_a_ramp_read_in_steps_is_a_ramp_again() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    ramp, step = 1e-3 * time, 1e-4
    read = step * np.round(ramp / step)
    inside = slice(60, -60)  # the first and the last stay have no middle of their own
    found = destepped(time, read, step)
    assert np.abs(found - ramp)[inside].max() < 0.06 * step
    assert np.abs(read - ramp)[inside].max() > 0.45 * step


def test_no_reading_is_moved_by_more_than_half_a_step() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    read = 1e-4 * np.round(10.0 * np.sin(time))
    assert np.abs(destepped(time, read, 1e-4) - read).max() <= 0.5e-4 + 1e-15


def test_a_rest_on_one_level_stays_there() -> None:
    time = np.linspace(0.0, 10.0, 100)
    np.testing.assert_array_equal(destepped(time, np.full(100, 3e-3), 1e-4), np.full(100, 3e-3))


def test_floor_counts_the_steps_through_the_stiffness() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.5, TIME.size)
    floor = noise_floor(white_level(noise), np.full(TIME.size, 15e3), 0.0, STEP, 0.0)
    uniform = 15e3 * (STEPPED - RAMP)
    assert floor.steps == pytest.approx(float(np.std(uniform)), rel=0.02)
    assert floor.amplifier == pytest.approx(0.5, rel=0.05)
    assert floor.level == pytest.approx(np.hypot(floor.amplifier, floor.steps))


def test_white_level_does_not_see_a_slow_motion() -> None:
    noise = np.random.default_rng(2).normal(0.0, 2.0, TIME.size)
    assert white_level(noise + 500.0 * np.sin(TIME)) == pytest.approx(2.0, rel=0.06)


@pytest.mark.parametrize("step", [0.0, 1.0, 3.0])
def test_white_level_holds_for_forces_read_in_steps(step: float) -> None:
    noise = np.random.default_rng(3).normal(0.0, 1.0, 4000)
    ramp = 0.37 * np.arange(noise.size)
    read = ramp + noise if step == 0.0 else step * np.round((ramp + noise) / step)
    # The error of a rounded reading is uniform, beside the noise (B. Widrow); a twentieth is 2 standard errors.
    assert white_level(read - ramp) == pytest.approx(np.hypot(1.0, step / np.sqrt(12.0)), rel=0.05)


def test_a_reading_in_steps_has_their_error_however_slowly_it_moves() -> None:
    force = 2.0 * np.round(np.linspace(0.0, 100.0, 4001) / 2.0)
    slow = force - np.linspace(0.0, 100.0, 4001)
    floor = noise_floor(white_level(slow), np.full(force.size, 15e3), 0.0, 0.0, 2.0)
    assert floor.level == pytest.approx(float(np.std(slow)), rel=0.02)


WHITE = np.random.default_rng(5).normal(0.0, 1.0, 8000)
SLOW = 40.0 * np.sin(2.0 * np.pi * np.arange(8000) / 900.0)
MOTION = 0.02 * np.sin(2.0 * np.pi * np.arange(8000) / 900.0 + 0.3)


def noise_beside(residual: FloatArray, motion: FloatArray) -> Noise:
    """Return the noise of a residual beside an exact motion of one sample a second."""
    rate = np.gradient(motion)
    return noise_of(residual, 1.0, motion, rate, np.gradient(rate))


def test_white_noise_has_no_memory() -> None:
    found = noise_beside(WHITE + SLOW, MOTION)
    assert found.level == pytest.approx(1.0, rel=0.05)
    assert found.memory == 1


@pytest.mark.parametrize("cut_off", [0.5, 0.2, 0.1])
def test_filtered_noise_is_seen_beside_a_slower_misfit(cut_off: float) -> None:
    """Long averages see the spectrum at the frequency zero: of a filter of the second order 1 / (1.11 cut-off)."""
    filtered = lfilter(*butter(2, cut_off), WHITE)
    filtered /= np.std(filtered)
    found = noise_beside(filtered + SLOW, MOTION)
    assert found.level == pytest.approx(1.0, rel=0.25)
    # A memory is known as a power of two, so the variance of an average to a factor of two either way.
    assert 0.5 < found.memory * 1.11 * cut_off < 2.0


def test_a_white_part_does_not_hide_the_filtered_one() -> None:
    filtered = lfilter(*butter(2, 0.1), WHITE)
    beside = np.random.default_rng(6).normal(0.0, 0.1, WHITE.size)
    found = noise_beside(filtered / np.std(filtered) + beside, MOTION)
    assert found.level == pytest.approx(1.0, rel=0.25)


def test_a_misfit_that_rises_with_the_lag_to_the_motions_own_length_is_no_noise() -> None:
    found = noise_beside(0.01 * WHITE + SLOW, MOTION)
    assert found.level == pytest.approx(0.01, rel=0.2)
    assert found.memory == 1


def test_a_ripple_that_comes_again_at_the_same_deflection_is_no_noise() -> None:
    ripple = np.sin(2.0 * np.pi * MOTION / 1e-3)
    found = noise_beside(0.1 * WHITE + ripple, MOTION)
    assert found.level < 0.2


def test_what_comes_again_with_the_other_sign_on_the_way_back_is_no_noise() -> None:
    ripple = np.sin(2.0 * np.pi * MOTION / 1e-3) * np.sign(np.gradient(MOTION))
    found = noise_beside(0.1 * WHITE + ripple, MOTION)
    assert found.level < 0.2


def ride(stretched: float) -> FloatArray:
    """Return a motion that never turns twice at the same deflection."""
    periods = stretched * np.array([40.0, 61.0, 97.0, 210.0, 890.0])
    return np.asarray(4e-3 * sum(np.sin(2.0 * np.pi * np.arange(8000) / p + 0.7 * p) for p in periods))


ROUGH = ride(1.0)


def test_the_knee_of_a_loop_that_comes_again_after_each_turn_is_no_noise() -> None:
    """What a model of another knee leaves of it: it rises and falls within 0.1 mm from each turn."""
    inwards = np.gradient(ROUGH) > 0.0
    turns = np.append(0, np.flatnonzero(np.diff(inwards)) + 1)
    last = ROUGH[turns[np.searchsorted(turns, np.arange(8000), side="right") - 1]]
    gone = np.abs(ROUGH - last) / 1e-4
    knee = np.where(inwards, 1.0, -1.0) * (1.0 - 2.0 * gone) * gone * np.exp(1.0 - gone)
    found = noise_beside(knee + 0.3 * WHITE, ROUGH)
    assert found.memory == 1
    assert found.level < 0.4


def test_a_ripple_beside_filtered_noise_is_taken_off_and_the_noise_stays() -> None:
    """Something comes again, with a third of the noise's power; what does not is the noise."""
    noise = lfilter(*butter(2, 0.2), WHITE)
    ripple = np.sqrt(2.0 / 3.0) * np.sin(2.0 * np.pi * MOTION / 1e-3)
    found = noise_beside(noise / np.std(noise) + ripple, MOTION)
    assert found.level == pytest.approx(1.0, rel=0.1)
    assert found.memory > 1


@pytest.mark.parametrize("motion", [MOTION, ride(4.0)], ids=["cycles", "ride"])
def test_filtered_noise_does_not_come_again(motion: FloatArray) -> None:
    """Of 100 drawn noises at most five are taken for a ripple."""
    taken = 0
    for seed in range(100):
        noise = lfilter(*butter(2, 0.2), np.random.default_rng([7, seed]).normal(0.0, 1.0, motion.size))
        taken += noise_beside(noise / np.std(noise), motion).level < 0.5
    assert taken <= 5


def test_a_quick_part_does_not_hide_the_memory_that_a_slow_part_shows() -> None:
    """Of the last quarter a cycle has 24 samples; a memory of nine shows over lags of 32 and more."""
    noise = lfilter(*butter(2, 0.1), WHITE)
    quick = 0.02 * np.sin(2.0 * np.pi * np.arange(2000) / 24.0)
    found = noise_beside(noise / np.std(noise), np.concatenate([MOTION[:6000], quick]))
    assert found.level == pytest.approx(1.0, rel=0.25)
    assert found.memory in (8, 16)


def test_a_misfit_of_the_quick_part_is_no_noise() -> None:
    """It is as large as filtered noise and rests over the same lags, but there the motion is quick."""
    quick = 0.02 * np.sin(2.0 * np.pi * np.arange(2000) / 24.0)
    motion = np.concatenate([MOTION[:6000], quick])
    found = noise_beside(0.1 * WHITE + 100.0 * np.gradient(motion), motion)
    assert found.level < 0.2
    assert found.memory == 1


def test_differences_that_fall_and_rise_again_have_no_memory() -> None:
    """A limit cycle of two samples beside white noise: over even lags it is gone, over odd ones it is all there."""
    cycle = np.where(np.arange(WHITE.size) % 2 == 0, 0.6, -0.6)
    slower = 0.8 * np.sin(2.0 * np.pi * np.arange(WHITE.size) / 12.0)
    assert noise_beside(WHITE + cycle + slower, MOTION).memory == 1


def test_a_memory_is_seen_in_holds() -> None:
    """At rest the rate is the rest of the gauge's noise, and its changes are as quick as the samples."""
    noise = lfilter(*butter(2, 0.1), WHITE[:4000])
    ramp = np.concatenate([np.linspace(0.0, 0.02, 60), np.full(3940, 0.02)])
    motion = ramp + 1e-7 * np.random.default_rng(8).normal(0.0, 1.0, 4000)
    found = noise_beside(noise / np.std(noise), motion)
    assert found.level == pytest.approx(1.0, rel=0.25)
    assert found.memory in (8, 16)


def test_a_memory_is_seen_where_the_motion_is_hardly_slower() -> None:
    """At lags beyond the motion's own a misfit rises and a noise does not: one of them confirms the level."""
    noise = lfilter(*butter(2, 0.13), WHITE[:1800])
    noise /= np.std(noise)
    cycle = 2.0 * np.pi * np.arange(1800) / 110.0
    assert noise_beside(noise, 0.02 * np.sin(cycle)).memory > 1
    loop = np.sign(np.cos(cycle)) * (1.0 - np.exp(-40.0 * np.abs(np.sin(cycle))))
    assert noise_beside(10.0 * loop + 0.1 * WHITE[:1800], 0.02 * np.sin(cycle)).memory == 1


QUICK = 0.5 * DEPTH * (1.0 - np.cos(2.0 * np.pi * np.arange(600) / 80.0))
"""A short recording: its motion is slow over four or eight samples only."""


@pytest.mark.parametrize("cut_off", [0.15, 0.4])
def test_filtered_noise_of_a_short_recording_is_seen(cut_off: float) -> None:
    """No lag shows that its level stays, but it has reached all that varies: of 100 drawn noises ten are missed."""
    seen = 0
    for seed in range(100):
        noise = lfilter(*butter(2, cut_off), np.random.default_rng([9, seed]).normal(0.0, 1.0, 700))[100:]
        seen += noise_beside(noise / np.std(noise), QUICK).level > 0.7
    assert seen >= 90


@pytest.mark.parametrize("size", [0.5, 1.0, 2.0, 20.0])
@pytest.mark.parametrize("motion", [QUICK, ROUGH[:1200]], ids=["cycles", "ride"])
@pytest.mark.parametrize("order", [1, 2], ids=["rate", "acceleration"])
def test_a_misfit_of_rate_or_acceleration_is_no_noise(order: int, motion: FloatArray, size: float) -> None:
    """However few samples a cycle has; the level of 600 white samples is known to a tenth (three standard errors)."""
    misfit = motion
    for _ in range(order):
        misfit = np.gradient(misfit)
    found = noise_beside(size * misfit / np.std(misfit) + WHITE[: motion.size], motion)
    assert found.memory == 1
    assert found.level == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize("period", [4.6, 5.3, 9.7])
def test_an_oscillation_of_its_own_frequency_is_no_noise(period: float) -> None:
    """A shaker next door: over some lags its differences are larger than all that varies, over others smaller."""
    number = np.arange(WHITE.size)
    shaker = np.sqrt(2.0) * np.sin(2.0 * np.pi * number / period) * np.sin(2.0 * np.pi * number / 3000.0) ** 2
    found = noise_beside(2.3 * shaker + WHITE, MOTION)
    assert found.memory == 1
