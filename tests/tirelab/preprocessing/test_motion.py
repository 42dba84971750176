"""The motion of a recording: branches, cycles, distance since reversal, rates, corners; against the motion driven.

Deflection, rate and acceleration from a noisy reading.

Turns of the motion within a sample.
"""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.preprocessing.motion import (
    LONG,
    followed_turns,
    motion_of,
    smoothed,
    through_turns,
)

INTERVAL = 0.01
RATE = 2e-3
DEPTH = 20e-3
SIDE = 1000  # samples of a loading or an unloading


def triangles(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return time [s] and deflection [m] of so many loadings and unloadings at RATE."""
    samples = np.arange(2 * SIDE * count + 1)
    return samples * INTERVAL, RATE * INTERVAL * (SIDE - np.abs(samples % (2 * SIDE) - SIDE))


def noisy(values: np.ndarray, sigma: float, seed: int = 1) -> np.ndarray:
    return values + sigma * np.random.default_rng(seed).standard_normal(values.size)


def test_branches_and_cycles_of_triangles() -> None:
    time, deflection = triangles(3)
    motion = motion_of(time, deflection)
    middle = np.arange(SIDE // 2, time.size, SIDE)  # of each branch
    np.testing.assert_array_equal(motion.direction[middle], [1, -1, 1, -1, 1, -1])
    np.testing.assert_array_equal(motion.cycle[middle], [0, 0, 1, 1, 2, 2])


def test_the_largest_deflection_so_far() -> None:
    time = np.arange(3000) * INTERVAL
    deflection = 1e-3 * time * (1.0 + 0.9 * np.sin(time))
    motion = motion_of(time, deflection)
    np.testing.assert_allclose(motion.deepest, np.maximum.accumulate(deflection), atol=2e-6)
    assert np.all(np.diff(motion.deepest) >= 0.0)


@pytest.mark.parametrize("sigma", [0.0, 8e-6, 5e-5])
def test_the_noise_of_the_reading_is_measured(sigma: float) -> None:
    time, deflection = triangles(2)
    motion = motion_of(time, noisy(deflection, sigma))
    assert motion.noise == pytest.approx(max(sigma, 1e-9), rel=0.06)


def test_a_hold_makes_one_reversal_within_it() -> None:
    up = np.linspace(0.0, DEPTH, 1000)
    deflection = np.concatenate([up, np.full(800, DEPTH), up[::-1]])
    motion = motion_of(np.arange(deflection.size) * INTERVAL, noisy(deflection, 5e-6))
    (reversal,) = np.flatnonzero(np.diff(motion.direction))
    assert 1000 - 10 <= reversal <= 1800 + 10
    assert np.all(motion.cycle == 0.0)


def test_noise_in_a_hold_makes_no_reversal() -> None:
    time, deflection = triangles(1)
    motion = motion_of(time, noisy(deflection, 1e-4))
    assert np.count_nonzero(np.diff(motion.direction)) == 1


def test_rates_of_a_sine() -> None:
    time = np.arange(4000) * INTERVAL
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


@pytest.mark.parametrize(("period", "most"), [(8, 0.01), (6, 0.03), (5, 0.06)])
def test_a_sine_of_few_samples_a_cycle_has_no_corners(period: int, most: float) -> None:
    """Of what has the period of n samples, a spline of the highest cut-off, 2 pi, passes 1 / (1 + n^-6): a part of
    1e-4; the reflected ends and a cut-off that is chosen from few samples cost more.
    """
    angle = 2.0 * np.pi * np.arange(2000) / period
    motion = motion_of(np.arange(2000) * INTERVAL, noisy(10e-3 * (1.0 - np.cos(angle)), 1e-6))
    assert motion.resolved.all()
    rate = 10e-3 * 2.0 * np.pi / (period * INTERVAL) * np.sin(angle)
    assert np.std((motion.rate - rate)[20:-20]) < most * np.std(rate)


def test_a_corner_within_a_sample_is_not_resolved_and_keeps_its_reading() -> None:
    time, deflection = triangles(1)
    reading = noisy(deflection, 1e-7)
    motion = motion_of(time, reading)
    assert not motion.resolved[SIDE]
    assert motion.deflection[SIDE] == reading[SIDE]
    assert np.mean(motion.resolved) > 0.98


def test_uneven_samples_have_the_motion_of_even_ones() -> None:
    rng = np.random.default_rng(3)
    time = np.cumsum(INTERVAL * (1.0 + 0.3 * rng.uniform(-1.0, 1.0, 4000)))
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


def short_triangles(count: int, side: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, deflection and rate of samples on branches of `side` samples at RATE, corners between samples."""
    place = np.arange(count) + 0.3
    way = place % (2.0 * side)
    rate = np.where(way < side, RATE, -RATE)
    return np.arange(count) * INTERVAL, RATE * INTERVAL * (side - np.abs(way - side)), rate


@pytest.mark.parametrize("side", [10.0, 12.35, 15.15])
def test_branches_of_few_samples_each_have_their_rate(side: float) -> None:
    """Two corners show in three samples each of the piece between them; what is left knows its rate."""
    time, deflection, rate = short_triangles(1500, side)
    motion = motion_of(time, noisy(deflection, 1e-8))
    wrong = motion.resolved & (np.abs(motion.rate / rate - 1.0) > 0.1)
    # A corner on a sample shows in three of them, beside which a spline is bent: at most one in a turn.
    assert np.count_nonzero(wrong) < 0.2 * time.size / side
    assert np.count_nonzero(motion.resolved) > 0.5 * time.size


@pytest.mark.parametrize("left", range(1, 14))
def test_a_corner_near_an_end_bends_no_rate_there(left: int) -> None:
    """A spline across the last corner had a rate of the wrong sign in the samples beside it."""
    time, deflection, rate = short_triangles(20 * 20 + left, 20.0)
    motion = motion_of(time, noisy(deflection, 1e-8))
    back = motion_of(time, noisy(deflection[::-1], 1e-8))
    for found, driven in ((motion, rate), (back, -rate[::-1])):
        wrong = found.resolved & (np.abs(found.rate / driven - 1.0) > 0.1)
        # In the last two samples no corner can be seen.
        assert np.count_nonzero(wrong[2:-2]) == 0


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
    # The penalty is on the third derivative: inside nothing is lost, and at the ends next to nothing.
    x = 1e-3 + 2e-3 * TIME + 3e-4 * TIME**2
    level, rate, bend = smoothed(x, STEP, NOISE)
    inside = slice(500, -500)
    assert level[inside] == pytest.approx(x[inside], abs=0.01 * NOISE)
    assert rate[inside] == pytest.approx((2e-3 + 6e-4 * TIME)[inside], abs=1e-6)
    assert bend[inside] == pytest.approx(6e-4, rel=0.01)
    assert level == pytest.approx(x, abs=0.1 * NOISE)


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.5, 0.8])
def test_a_motion_that_begins_and_ends_under_way_has_its_acceleration_there(phase: float) -> None:
    """In the first and the last tenth of a cycle; reflected ends without curvature would miss up to 0.7 of it."""
    angle = 2.0 * np.pi * (2.0 * TIME + phase)
    truth = -((4.0 * np.pi) ** 2) * 1e-3 * np.cos(angle)
    tenth = round(0.05 / STEP)
    missed = []
    for seed in range(3):
        noise = 0.1 * NOISE * np.random.default_rng(seed).standard_normal(TIME.size)
        bend = smoothed(1e-3 * np.cos(angle) + noise, STEP, 0.1 * NOISE)[2]
        missed += [*(bend - truth)[:tenth], *(bend - truth)[-tenth:]]
    assert np.sqrt(np.mean(np.square(missed))) < 0.3 * np.std(truth)


def test_a_straight_motion_has_no_curvature_at_its_ends() -> None:
    """What noise may have made is none."""
    for seed in range(20):
        x = 1e-3 * TIME + NOISE * np.random.default_rng(seed).standard_normal(TIME.size)
        bend = smoothed(x, STEP, NOISE)[2]
        assert np.abs(bend[[0, -1]]).max() < 3.0 * np.abs(bend[200:-200]).max()


def test_of_the_noise_less_than_half_stays() -> None:
    # A spline that passes a sine of 3 Hz read at 200 Hz averages ten samples or so: a third of the noise.
    for seed in range(3):
        level, rate, bend = read(seed)
        assert np.std(level - sines(TIME, 0)) < 0.5 * NOISE
        assert np.std(rate - sines(TIME, 1)) < 0.03 * np.std(sines(TIME, 1))
        assert np.std(bend - sines(TIME, 2)) < 0.15 * np.std(sines(TIME, 2))


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
    _, rate, _ = smoothed(x + NOISE * np.random.default_rng(5).standard_normal(x.size), STEP, NOISE)
    place = np.arange(4000) % (period / 2)
    far = (place > 40) & (place < period / 2 - 40)
    expected = np.where(np.arange(4000) % period < period / 2, -0.02, 0.02)
    assert np.sqrt(np.mean((rate - expected)[far] ** 2)) < 0.02 * 0.02


def test_without_noise_next_to_nothing_is_smoothed() -> None:
    level, rate, bend = smoothed(sines(TIME, 0), STEP, 1e-9)
    inside = slice(50, -50)
    assert level[inside] == pytest.approx(sines(TIME, 0)[inside], abs=1e-8)
    assert rate[inside] == pytest.approx(sines(TIME, 1)[inside], abs=1e-5)
    assert bend[inside] == pytest.approx(sines(TIME, 2)[inside], abs=0.01 * np.std(sines(TIME, 2)))


FORCE_NOISE = 1.0


def corners() -> tuple[np.ndarray, np.ndarray]:
    """Which of 40 samples are resolved, with turns at 10 to 11 and at 30, and a misfit without anything in it."""
    resolved = np.ones(40, dtype=bool)
    resolved[[10, 11, 30]] = False
    return resolved, np.zeros(40)


def test_what_acts_within_the_turn_alone_counts() -> None:
    resolved, misfit = corners()
    misfit[[10, 11, 30]] = -25.0
    assert followed_turns(misfit, resolved, FORCE_NOISE).tolist() == (~resolved).tolist()


def test_what_depends_on_the_direction_does_not() -> None:
    """Friction and viscous damping change their sign with that of the rate."""
    resolved, misfit = corners()
    misfit[:10], misfit[12:30], misfit[31:] = 25.0, -25.0, 25.0
    assert not followed_turns(misfit, resolved, FORCE_NOISE).any()


def test_each_turn_is_judged_by_itself() -> None:
    resolved, misfit = corners()
    misfit[:10] = 25.0
    assert np.flatnonzero(followed_turns(misfit, resolved, FORCE_NOISE)).tolist() == [30]


def test_a_misfit_that_rises_with_the_deflection_counts() -> None:
    """The samples before and after are not read at the same deflection: they differ by less than a sample's rise."""
    resolved, misfit = corners()
    misfit[:10] = 20.0 * np.arange(10.0)
    misfit[12:22] = 190.0 - 20.0 * np.arange(10.0)
    misfit[10:12] = 199.0
    assert followed_turns(misfit, resolved, FORCE_NOISE)[10:12].all()


def test_a_turn_at_the_end_of_a_recording_does_not_count() -> None:
    resolved = np.ones(12, dtype=bool)
    resolved[[1, 10, 11]] = False
    assert not followed_turns(np.zeros(12), resolved, FORCE_NOISE).any()


def test_through_a_turn_the_rate_changes_evenly() -> None:
    """A triangle of 2 m/s: from 2 to -2 m/s within three steps of 0.1 s is -40/3 m/s^2."""
    time = 0.1 * np.arange(10)
    rate = np.where(np.arange(10) < 5, 2.0, -2.0)
    turns = np.zeros(10, dtype=bool)
    turns[[4, 5]] = True
    through, acceleration = through_turns(time, rate, np.zeros(10), turns)
    np.testing.assert_allclose(through[3:7], [2.0, 2.0 / 3.0, -2.0 / 3.0, -2.0], rtol=1e-12)
    np.testing.assert_allclose(acceleration[4:6], -40.0 / 3.0, rtol=1e-12)
    assert acceleration[[3, 6]].tolist() == [0.0, 0.0]
    assert rate[4] == 2.0


def test_a_motion_is_kept_by_what_was_read_and_of_long_ones_the_last_two() -> None:
    time = np.linspace(0.0, 3.0, 400)
    first, again, other = (motion_of(time, depth * np.sin(time)) for depth in (0.02, 0.02, 0.03))
    assert again is first
    assert float(other.deflection.max()) == pytest.approx(0.03, rel=1e-3)
    assert float(first.deflection.max()) == pytest.approx(0.02, rel=1e-3)
    long = np.linspace(0.0, 3.0, LONG + 1)
    first, again, *_ = (motion_of(long, slope * long) for slope in (0.02, 0.02, 0.03, 0.04))
    assert again is first
    assert motion_of(long, 0.02 * long) is not first
