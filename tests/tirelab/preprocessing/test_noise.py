"""The noise of a misfit, white or filtered."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import butter, lfilter
from tirelab.preprocessing.driven import Driven
from tirelab.preprocessing.levels import levels_by_state
from tirelab.preprocessing.noise import (
    Noise,
    noise_of,
    resting,
    white_noise_of,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

DEPTH = 25e-3
TIME = np.linspace(0.0, 10.0, 4001)
STEP = 5e-5


WHITE = np.random.default_rng(5).normal(0.0, 1.0, 8000)
SLOW = 40.0 * np.sin(2.0 * np.pi * np.arange(8000) / 900.0)
MOTION = 0.02 * np.sin(2.0 * np.pi * np.arange(8000) / 900.0 + 0.3)


def noise_beside(residual: FloatArray, motion: FloatArray, surface: IntArray | None = None) -> Noise:
    """Return the noise of a residual beside an exact motion of one sample a second, on one surface if None is given."""
    rate = np.gradient(motion)
    one = np.zeros(motion.size, dtype=np.intp)
    return noise_of(
        residual, Driven(1.0, motion, rate, np.gradient(rate), one if surface is None else surface)
    )


def test_a_place_that_comes_again_at_the_very_end_says_nothing_of_long_lags() -> None:
    """Differences over a lag are known up to one and a half lags before the end."""
    rise, again = 1e-6 * np.arange(1300), 2e-4 + 1e-6 * np.arange(90)
    motion = np.concatenate([rise, np.linspace(rise[-1], again[0], 20, endpoint=False), again])
    filtered = (WHITE[1:] + WHITE[:-1])[: motion.size] / 2.0
    noise = noise_beside(filtered, motion)
    assert noise.level == pytest.approx(np.sqrt(0.5), rel=0.1)
    assert noise.memory == 2


def test_a_machine_may_be_louder_while_it_moves() -> None:
    """The white part of both together lies between the two; where they are alike, or one is hardly seen, both are 1."""
    rests = np.arange(8000) % 1000 < 900
    at_rest, moving = levels_by_state(np.where(rests, 1.0, 7.0) * WHITE + SLOW, rests, 1e-3)
    assert moving / at_rest == pytest.approx(7.0, rel=0.15)
    assert at_rest < 1.1 < moving
    assert levels_by_state(WHITE + SLOW, rests, 1e-3) == (1.0, 1.0)
    assert levels_by_state(np.where(rests, 1.0, 7.0) * WHITE, np.arange(8000) > 50, 1e-3) == (1.0, 1.0)


@pytest.mark.parametrize("period", [3.0, 4.0, 6.25, 12.0, 31.0])
def test_a_force_that_swings_while_the_tire_moves_is_no_louder_machine(period: float) -> None:
    rests = np.arange(8000) % 1000 < 900
    swings = np.where(rests, 0.0, 9.0) * np.sin(2.0 * np.pi * np.arange(8000) / period)
    assert levels_by_state(WHITE + swings, rests, 1e-3) == (1.0, 1.0)


@pytest.mark.parametrize("period", [2.2, 3.0, 4.0, 6.25])
def test_white_noise_is_at_most_what_differences_over_any_lag_show(period: float) -> None:
    """Each of them has all of it. Over some lag, of the powers of two and those between, an oscillation has next to
    nothing; the level is known to a twentieth at each of about ten lags.
    """
    swings = 9.0 * np.sin(2.0 * np.pi * np.arange(8000) / period)
    rate = np.gradient(MOTION)
    driven = Driven(1.0, MOTION, rate, np.gradient(rate), np.zeros(8000, dtype=np.intp))
    assert white_noise_of(WHITE, driven).level == pytest.approx(1.0, rel=0.05)
    assert white_noise_of(WHITE + swings, driven).level < 1.3


def test_a_force_that_rests_on_a_step_has_the_least_noise_there() -> None:
    rests = np.arange(8000) % 1000 < 900
    at_rest, moving = levels_by_state(np.where(rests, 0.0, WHITE), rests, 0.01)
    assert at_rest == 1.0
    assert moving == pytest.approx(100.0, rel=0.15)


def test_a_tire_rests_where_its_speed_is_next_to_nothing() -> None:
    assert resting(np.array([0.0, 1e-3, -0.1, 0.019, 1.0])).tolist() == [True, True, False, True, False]


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


@pytest.mark.parametrize("order", [1, 2])
def test_a_few_hundred_memories_tell_a_filtered_noise_from_what_follows_a_sweep(order: int) -> None:
    """30 s at 200 Hz from 0.1 to 12 Hz, where noise behind a filter at 12 Hz has some 400 independent values."""
    time = np.arange(6000) / 200.0
    motion = 4e-3 * np.sin(2.0 * np.pi * (0.1 * time + 0.5 * 11.9 / 30.0 * time**2))
    rate = np.gradient(motion, time)
    driven = Driven(1.0 / 200.0, motion, rate, np.gradient(rate, time), np.zeros(6000, dtype=np.intp))
    for seed in range(12):
        random = np.random.default_rng(seed)
        filtered = lfilter(*butter(order, 0.116), random.standard_normal(6100))[100:]
        found = noise_of(filtered / np.std(filtered) + random.normal(0.0, 0.1, 6000), driven)
        assert found.level == pytest.approx(1.0, rel=0.25)


def test_a_misfit_that_rises_with_the_lag_to_the_motions_own_length_is_no_noise() -> None:
    found = noise_beside(0.01 * WHITE + SLOW, MOTION)
    assert found.level == pytest.approx(0.01, rel=0.2)
    assert found.memory == 1


def test_a_ripple_that_comes_again_at_the_same_deflection_is_no_noise() -> None:
    ripple = np.sin(2.0 * np.pi * MOTION / 1e-3)
    found = noise_beside(0.1 * WHITE + ripple, MOTION)
    assert found.level < 0.2


@pytest.mark.parametrize("period", [11.85, 12.0, 12.2])
def test_an_oscillation_that_swells_is_no_noise(period: float) -> None:
    """Its differences fall again over some longer lag, as those of a noise with a memory never do."""
    time = np.arange(15_000)
    swelling = (1.0 + 0.5 * np.sin(time / 700.0)) * 50.0 * np.sin(2.0 * np.pi * time / period + 5.0)
    white = np.random.default_rng(1).normal(size=time.size)
    assert noise_beside(swelling + white, 0.02 * np.sin(2.0 * np.pi * time / 150.0)).level < 5.0


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("period", [3.4, 8.33, 16.7])
def test_a_hum_beside_noise_of_an_amplifier_with_a_filter_leaves_its_level(period: float, seed: int) -> None:
    """8 N of noise whose memory is some eight samples, and 3 N of the mains: not the tenth of it that is white."""
    time = np.arange(12_000)
    white = np.random.default_rng(seed).normal(size=time.size)
    filtered = lfilter(*butter(2, 0.13), white)
    filtered *= 8.0 / np.std(filtered)
    hum = 3.0 * np.sqrt(2.0) * np.sin(2.0 * np.pi * time / period + seed)
    found = noise_beside(filtered + hum, 0.02 * np.sin(2.0 * np.pi * time / 1500.0))
    # Between 8 N and what both have together, sqrt(8^2 + 3^2) = 8.5 N, where the level of 12 000 / 8 is known to 4 %.
    assert 0.9 * 8.0 < found.level < 1.1 * 8.5


def test_what_comes_again_with_the_other_sign_on_the_way_back_is_no_noise() -> None:
    ripple = np.sin(2.0 * np.pi * MOTION / 1e-3) * np.sign(np.gradient(MOTION))
    found = noise_beside(0.1 * WHITE + ripple, MOTION)
    assert found.level < 0.2


TRIANGLE = 0.02 * np.concatenate([np.linspace(0.0, 1.0, 80), np.linspace(1.0, 0.0, 80)])
BENT = np.interp(TRIANGLE, np.linspace(0.0, 0.02, 9), [0.0, 1.0, -0.8, 0.6, 1.2, -1.0, 0.2, -0.6, 0.9])
"""What a law of another shape leaves: bent at every eighth of the deflection."""


def test_a_shape_of_the_law_that_comes_again_on_the_way_back_alone_is_no_noise() -> None:
    """Of what depends on the deflection, third differences change their sign with the direction."""
    found = noise_beside(0.05 * WHITE[:160] + BENT, TRIANGLE)
    assert found.level == pytest.approx(0.05, rel=0.2)


def test_a_shape_of_the_law_that_is_another_one_on_each_surface_is_no_noise() -> None:
    motion, surface = np.tile(TRIANGLE, 3), np.repeat([0, 1, 2], 160)
    bent = np.concatenate([BENT, -1.5 * BENT, 0.5 * BENT])
    found = noise_beside(0.05 * WHITE[:480] + bent, motion, surface)
    assert found.level == pytest.approx(0.05, rel=0.2)


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


@pytest.mark.slow
@pytest.mark.parametrize("motion", [MOTION, ride(4.0)], ids=["cycles", "ride"])
def test_filtered_noise_does_not_come_again(motion: FloatArray) -> None:
    """Of 100 drawn noises at most five are taken for a ripple."""
    taken = 0
    for seed in range(100):
        noise = lfilter(*butter(2, 0.2), np.random.default_rng([7, seed]).normal(0.0, 1.0, motion.size))
        taken += noise_beside(noise / np.std(noise), motion).level < 0.5
    assert taken <= 5


@pytest.mark.parametrize(("louder", "memory"), [(1.0, (8, 16)), (3.0, (1,))])
def test_what_is_louder_in_one_part_of_the_recording_is_no_noise(
    louder: float, memory: tuple[int, ...]
) -> None:
    """One eighth of a filtered noise beside a twentieth of white noise: what a filter does not know is left to physics.

    Third differences of the filtered noise add to those of the white one.
    """
    filtered = lfilter(*butter(2, 0.1), WHITE)
    filtered /= np.std(filtered)
    filtered[3000:4000] *= louder
    found = noise_beside(filtered + np.random.default_rng(6).normal(0.0, 0.05, WHITE.size), MOTION)
    assert found.memory in memory
    assert 0.05 < found.level < 0.1 if memory == (1,) else found.level == pytest.approx(1.0, rel=0.25)


def test_a_memory_that_visits_do_not_show_is_seen_by_the_whole_variation() -> None:
    """A slow and a quick sine come by each place at many rates: the levels between visits stay constant by chance."""
    time = np.arange(6000)
    motion = 0.01 * (1.0 - np.cos(2.0 * np.pi * time / 1000.0)) + 0.003 * np.sin(2.0 * np.pi * time / 87.0)
    for seed in range(20):
        white = np.random.default_rng(seed).standard_normal(12_000)
        noise = lfilter(*butter(2, 0.121), white)[6000:]
        assert noise_beside(noise / np.std(noise), motion).level == pytest.approx(1.0, rel=0.2)


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


@pytest.mark.parametrize(("period", "count"), [(50, 300), (100, 400), (100, 600)])
def test_the_third_harmonic_of_growing_cycles_is_no_noise(period: int, count: int) -> None:
    """A damping that grows with the square of the deflection, in cycles that never come back to one place."""
    number = np.arange(count)
    motion = 0.01 * (0.3 + 0.7 * number / count) * np.sin(2.0 * np.pi * number / period)
    misfit = motion**2 * np.gradient(motion)
    found = noise_beside(50.0 * misfit / np.std(misfit) + WHITE[:count], motion)
    assert found.memory == 1
    assert found.level == pytest.approx(1.0, rel=0.15)  # the level of 300 white samples is known to 0.05


@pytest.mark.parametrize("period", [4.6, 5.3, 9.7])
def test_an_oscillation_of_its_own_frequency_is_no_noise(period: float) -> None:
    """A shaker next door: over some lags its differences are larger than all that varies, over others smaller."""
    number = np.arange(WHITE.size)
    shaker = np.sqrt(2.0) * np.sin(2.0 * np.pi * number / period) * np.sin(2.0 * np.pi * number / 3000.0) ** 2
    found = noise_beside(2.3 * shaker + WHITE, MOTION)
    assert found.memory == 1


PLACE = np.linspace(0.0, 1.0, 900)
PRESS = 0.02 * (PLACE + 0.002 * np.sin(5.0 * PLACE))
"""One press, whose speed changes by a hundredth."""


def left_by_hats(values: FloatArray, count: int) -> FloatArray:
    """Return what a model of hat functions over the press leaves of values (n,) or (n, k)."""
    hats = np.column_stack([np.interp(PLACE, np.linspace(0.0, 1.0, count), row) for row in np.eye(count)])
    return np.asarray(values - hats @ np.linalg.lstsq(hats, values, rcond=None)[0])


def noise_left_by_hats(force: FloatArray, count: int) -> Noise:
    rate = np.gradient(PRESS)
    driven = Driven(1.0, PRESS, rate, np.gradient(rate), np.zeros(PRESS.size, dtype=np.intp))
    return noise_of(left_by_hats(force, count), driven, lambda signals: left_by_hats(signals, count))


@pytest.mark.parametrize("seed", [18, 20, 23, 24])
def test_what_a_model_leaves_where_no_place_comes_again_is_no_noise(seed: int) -> None:
    """Bumps that thirty hat functions cannot follow leave 0.1 to 0.3 N that vary within a few lags, beside 0.01 N."""
    drawn = np.random.default_rng(seed)
    bumps = np.exp(-0.5 * (15.0 * (PRESS[:, None] / 0.02 - drawn.uniform(0.0, 1.0, 40))) ** 2)
    force = bumps @ drawn.normal(0.0, 10.0, 40) + 0.01 * drawn.normal(size=PRESS.size)
    assert float(np.std(left_by_hats(force, 30))) > 0.1
    found = noise_left_by_hats(force, 30)
    assert found.level == pytest.approx(0.01, rel=0.2)
    assert found.memory == 1


@pytest.mark.parametrize("length", [2, 4])
def test_filtered_noise_is_seen_beside_a_model_in_one_press(length: int) -> None:
    white = np.random.default_rng(4).normal(size=PRESS.size + length - 1)
    found = noise_left_by_hats(np.convolve(white, np.ones(length) / length, mode="valid"), 11)
    assert found.level == pytest.approx(1.0 / np.sqrt(length), rel=0.2)
    assert found.memory == length


@pytest.mark.parametrize("seed", range(3))
def test_what_varies_until_the_longest_lag_where_no_place_comes_again_is_no_noise(seed: int) -> None:
    """A bar is pulled one way beside noise of 1 N: what its law misses goes up and down by 33 N within 85 samples."""
    drawn, at = np.random.default_rng(seed), np.arange(1200)
    quicker = 1.0 + 0.3 * np.sin(2.0 * np.pi * at / 400.0) + 0.1 * drawn.normal(size=at.size)
    waves = 2.0 * np.abs(np.cumsum(2.0 / 85.0 * quicker) % 2.0 - 1.0) - 1.0
    missed = waves * np.interp(at, np.linspace(0.0, 1199.0, 60), drawn.uniform(0.3, 1.5, 60))
    rate = 1.7e-5 * (1.0 + 0.05 * np.sin(at / 80.0))
    driven = Driven(1.0, np.cumsum(rate), rate, np.gradient(rate), np.zeros(at.size, dtype=np.intp))
    found = noise_of(33.0 / missed.std() * missed + drawn.normal(size=at.size), driven)
    assert found.level == pytest.approx(1.0, rel=0.15)
