"""The noise of a deflection reading: random, rounded to a gauge's steps, both, or none.

A gauge that steps, and the motion behind it: straight lines between the middles of its stays.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.signal import butter, sosfilt
from tirelab.preprocessing.gauge import (
    LEAST_NOISE,
    deflection_noise,
    destepped,
    gauge_step,
    read_again,
    staircase_step,
)

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


@pytest.mark.parametrize("period", [5.3, 6.4, 8.7, 16.3, 40.0])
def test_a_sine_of_few_samples_a_cycle_is_no_noise(period: float) -> None:
    """Its fifth differences are (2 sin(pi / n))^5 of it, 2 % of the stroke in the shortest."""
    k, sigma = np.arange(3000), 2e-7
    readings = 8e-3 * np.sin(2.0 * np.pi * k / period) + np.random.default_rng(4).normal(0.0, sigma, k.size)
    assert deflection_noise(readings) == pytest.approx(sigma, rel=0.1)


@pytest.mark.parametrize(("order", "cutoff"), [(1, 0.05), (1, 0.3), (2, 0.05), (2, 0.3)])
def test_noise_behind_a_filter_keeps_that_of_its_fifth_differences(order: int, cutoff: float) -> None:
    white = np.random.default_rng(5).normal(0.0, 1e-5, 6000)
    readings = sosfilt(butter(order, 2.0 * cutoff, output="sos"), white)
    fifth = np.std(np.diff(readings, 5)) / np.sqrt(252.0)
    assert deflection_noise(5e-3 * np.sin(0.01 * np.arange(6000)) + readings) == pytest.approx(fifth, rel=0.1)


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


@pytest.mark.parametrize("samples", [2, 3, 5])
def test_short_ramps_between_holds_are_no_steps(samples: int) -> None:
    """A step and hold test whose steps take a few samples: what a ramp moves per sample is no step of the gauge."""
    ramp = np.append(np.arange(1, samples + 1) / samples, np.ones(100))
    level = np.concatenate([k + ramp for k in range(8)])
    assert staircase_step(5e-3 * level) == 0.0
    assert staircase_step(5e-3 * np.append(level, level[::-1])) == 0.0


def test_a_gauge_whose_motion_is_driven_in_steps_keeps_its_step() -> None:
    """Ramps of uneven height between holds, read in steps of which each ramp passes several per sample."""
    heights = 1e-3 * np.cumsum(np.random.default_rng(4).uniform(0.6, 3.0, 12))
    ramps = [np.append(np.linspace(a, b, 6), np.full(60, b)) for a, b in pairwise(np.append(0.0, heights))]
    read = 1e-4 * np.round(np.concatenate(ramps) / 1e-4)
    assert staircase_step(read) == pytest.approx(1e-4)


def test_a_gauge_may_have_other_levels_on_the_way_back() -> None:
    """The backlash of an encoder: in from a part of a step, back from another part."""
    into = STEP * np.append(0.0, 0.4 + np.arange(40.0))
    back = into[-1] - STEP * (0.7 + np.arange(40.0))
    assert staircase_step(np.repeat(np.append(into, back), 5)) == pytest.approx(STEP)


def test_a_reading_that_is_renewed_every_third_sample_is_no_step() -> None:
    """Its changes are nearly alike, but what they add up to lies on no grid."""
    speed = 2e-3 * (1.0 + 0.1 * np.random.default_rng(5).standard_normal(TIME.size))
    moved = np.cumsum(speed) * (TIME[1] - TIME[0])
    assert staircase_step(np.repeat(moved[::3], 3)) == 0.0


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


def test_readings_that_are_not_even_in_time_have_the_noise_that_turns_them_to_and_fro() -> None:
    """Cycles of a coupon in steps between a third and three times the usual one: without a time they have no noise."""
    rng = np.random.default_rng(4)
    way = np.cumsum(1e-3 * 3.0 ** rng.uniform(-1.0, 1.0, 2000))
    driven = 0.02 * np.abs(2.0 * (way / 0.04 % 1.0) - 1.0)
    assert deflection_noise(driven, timed=False) == LEAST_NOISE
    assert deflection_noise(driven) > 1e-4
    slow = 1e-6 * way / way[-1] + 1e-5 * rng.standard_normal(way.size)
    assert deflection_noise(slow, timed=False) == deflection_noise(slow) == pytest.approx(1e-5, rel=0.1)


def test_another_reading_has_the_noise_of_the_first_and_steps_between_its_own() -> None:
    time = np.linspace(0.0, DURATION, 6000)
    motion, step = sine(time, 0.0413), 1.9e-5
    plain = read_again(motion, motion, 4e-6, 0.0, np.random.default_rng(1))
    assert np.std(plain - motion) == pytest.approx(4e-6, rel=0.05)
    read = rounded(motion, step)
    other = read_again(motion, read, step / np.sqrt(12.0), step, np.random.default_rng(1))
    np.testing.assert_allclose((other - read) / step % 1.0, 0.5, atol=1e-6)
    assert np.abs(other - motion).max() <= 0.5 * step * (1.0 + 1e-9)


def test_steps_that_are_held_for_minutes_are_the_rigs() -> None:
    """Three samples of a rise and 3000 of a hold, as in a relaxation test: no gauge is seen in so few changes."""
    rise = np.array([0.0, 0.0, 0.0, 9.3865e-3, 9.8332e-3])
    assert staircase_step(np.concatenate([rise, np.full(3000, 10e-3)])) == 0.0


def test_a_tire_at_rest_between_two_levels_does_not_move() -> None:
    """Noise turns the reading from one level to the next and back: it says where the tire is, and no way that it goes.

    On both sides the motion goes on in steps, and comes to the level between the two.
    """
    moving = STEP * np.floor(np.linspace(0.0, 9.4, 95))
    trembling = STEP * (9.0 + (np.random.default_rng(2).random(200) < 0.5))
    read = np.concatenate([moving, trembling, moving[::-1] + STEP])
    found = destepped(np.arange(read.size, dtype=float), read, STEP)
    rests = found[97 : 95 + 198]
    assert np.ptp(rests) < 1e-12
    assert rests[0] == pytest.approx(9.5 * STEP)
    assert np.ptp(found[:95]) > 8.0 * STEP


def test_one_reversal_between_two_levels_is_a_motion() -> None:
    read = STEP * np.repeat([0.0, 1.0, 2.0, 1.0, 0.0], 21)
    found = destepped(np.arange(105.0), read, STEP)
    assert found[52] == pytest.approx(2.0 * STEP)
