"""Levels of a residual over lags, between visits and along a place."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tirelab.preprocessing.levels import (
    NoiseProfile,
    falls,
    finer,
    known_levels,
    known_over,
    known_part,
    level_between,
    level_of,
    levels_by_load,
    local_rms,
    most_along,
    most_apart,
    plateau_at,
    rising,
    white_level,
)

FloatArray = NDArray[np.float64]

TIME = np.linspace(0.0, 10.0, 4001)
WHITE = np.random.default_rng(5).normal(0.0, 1.0, 8000)
ALL = np.ones(8000, dtype=bool)


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


def test_a_level_over_any_lag_has_all_of_white_noise_and_none_of_a_slow_misfit() -> None:
    slow = 40.0 * np.sin(2.0 * np.pi * np.arange(8000) / 4000.0)
    for lag in (1, 3, 8):
        assert level_of(WHITE + slow, lag, ALL) == pytest.approx(1.0, rel=0.06)


@pytest.mark.parametrize("period", [2.0, 3.0, 7.3])
@pytest.mark.parametrize("lag", [1, 2, 5])
def test_third_differences_of_a_sine(period: float, lag: int) -> None:
    """They are (2 sin(pi lag / period))^3 times it; those of white noise are the root of 20 times it."""
    sine = np.cos(2.0 * np.pi * np.arange(8000) / period)
    size = float(np.std(sine)) * abs(2.0 * np.sin(np.pi * lag / period)) ** 3 / np.sqrt(20.0)
    assert level_of(sine, lag, ALL) == pytest.approx(size, rel=0.05, abs=1e-9)


def test_levels_that_rise_stay_and_fall() -> None:
    assert rising([1.0, 1.1, 1.5, 1.6]) == [False, True, False]
    assert rising([1.0, 3.0, 1.0, 2.9]) == [True, False, False]
    assert plateau_at([1.0, 2.0, 4.0, 4.1, 4.0]) == 3
    assert plateau_at([1.0, 2.0, 4.0, 8.0]) == 0
    # The third level is 1.3 times the second: a rise where it is known to a tenth, chance where it is known to a half.
    assert rising([1.0, 1.1, 1.43], [0.95, 0.95, 0.9]) == [False, True]
    assert rising([1.0, 1.1, 1.43], [0.8, 0.7, 0.5]) == [False, False]
    assert plateau_at([1.0, 1.1, 1.43], [0.8, 0.7, 0.5]) == 1
    well_known = np.full(3, 0.95)
    assert falls(np.array([3.0, 3.0, 2.0]), well_known)
    assert not falls(np.array([3.0, 3.0, 2.9]), well_known)
    assert not falls(np.array([3.0, 3.0, 2.0]), np.full(3, 0.5))


def test_lags_between_doubled_ones_show_a_period_of_three_samples() -> None:
    assert finer((1, 2, 4, 8)) == (1, 2, 3, 4, 6, 8)
    period = WHITE + 9.0 * np.sin(2.0 * np.pi * np.arange(8000) / 3.0)
    assert not falls(*known_levels(period, (1, 2, 4, 8), ALL))
    assert falls(*known_levels(period, finer((1, 2, 4, 8)), ALL))


def test_few_values_are_known_badly() -> None:
    """A standard deviation of m independent values is known to 1 / sqrt(2 m), here three times that."""
    assert known_part(np.array([800.0, 50.0])) == pytest.approx([1.0 - 3.0 / 40.0, 0.7])
    assert known_part(2.0) == pytest.approx(0.5)
    _, known = known_levels(WHITE, (1, 16), ALL)
    assert known == pytest.approx(known_part(np.array([8000.0, 500.0])))


def test_differences_are_known_one_and_a_half_lags_from_the_ends() -> None:
    assert known_over(10, 2).tolist() == [False] * 3 + [True] * 4 + [False] * 3


def test_the_local_size_has_nothing_of_what_is_slow() -> None:
    slow = 40.0 * np.sin(2.0 * np.pi * np.arange(8000) / 4000.0)
    # An average over five samples takes a fifth of the variance of white noise.
    assert local_rms(WHITE + slow, 1, ALL) == pytest.approx(np.sqrt(0.8), rel=0.03)


def test_a_ripple_over_the_place_does_not_differ_between_visits_at_another_speed() -> None:
    """Differences over a lag do, since they see another length of the ripple."""
    place = np.concatenate([np.linspace(0.0, 1.0, 5000), np.linspace(0.0, 1.0, 3000)])
    ripple = 9.0 * np.sin(2.0 * np.pi * place / 0.02)
    order = np.argsort(place, kind="stable")
    other = (order[:-1] < 5000) != (order[1:] < 5000)
    visits = order[:-1][other], order[1:][other], np.ones(int(other.sum()))
    known = float(known_part(float(other.sum())))
    assert most_apart(WHITE + ripple, 1, *visits[:2]) * known == pytest.approx(1.0, rel=0.06)
    assert most_along(WHITE + ripple, place) * float(known_part(8000.0)) == pytest.approx(1.0, rel=0.06)
    assert level_between(WHITE + ripple, 16, *visits) > 2.0
    slow = 9.0 * np.sin(2.0 * np.pi * np.arange(8000) / 1500.0)
    assert level_between(WHITE + slow, 16, *visits) == pytest.approx(1.0, rel=0.06)
    assert most_apart(WHITE + slow, 1, *visits[:2]) > 2.0


LOAD = 1000.0 * np.abs(np.sin(2.0 * np.pi * np.arange(8000) / 900.0))
EVEN = NoiseProfile()


def loud_under(share: float) -> FloatArray:
    """White noise of 1 at rest, and of this share of the load."""
    return np.hypot(1.0, share * LOAD) * np.random.default_rng(9).standard_normal(8000)


@pytest.mark.parametrize("share", [0.003, 0.01, 0.1])
def test_noise_that_grows_with_the_load_is_told_load_by_load(share: float) -> None:
    """Levels that differ by less than a factor of 1.19 count as one, of loads up to a quarter of the samples apart."""
    found = levels_by_load(loud_under(share), LOAD, 1e-3, EVEN)
    whole = np.sqrt(1.0 + share**2 * np.mean(LOAD**2))
    expected = np.hypot(1.0, share * np.array(found.loads)) / whole
    assert len(found.loads) == 8
    np.testing.assert_allclose(found.by_load, expected, rtol=0.25)
    assert np.sqrt(np.mean(found.of_load(-LOAD) ** 2)) == pytest.approx(1.0)


def test_over_the_noise_that_is_known_nothing_more_is_told() -> None:
    """What is left over the right profile has one level, so that profile stays."""
    known = NoiseProfile(loads=(0.0, 1000.0), by_load=(0.2, 1.38))
    even = np.random.default_rng(9).standard_normal(8000)
    assert levels_by_load(even, LOAD, 1e-3, known) is known
    assert levels_by_load(even, LOAD, 1e-3, EVEN) is EVEN


@pytest.mark.parametrize("period", [3.0, 6.25, 31.0])
def test_a_force_that_swings_under_load_is_no_noise(period: float) -> None:
    swings = 0.02 * LOAD * np.sin(2.0 * np.pi * np.arange(8000) / period)
    assert levels_by_load(loud_under(0.0) + swings, LOAD, 1e-3, EVEN) is EVEN


def test_noise_that_falls_with_the_load_is_told_as_well() -> None:
    falling = np.random.default_rng(9).standard_normal(8000) / np.hypot(1.0, 0.01 * LOAD)
    found = levels_by_load(falling, LOAD, 1e-3, EVEN)
    np.testing.assert_allclose(
        np.array(found.by_load) / found.by_load[0],
        np.hypot(1.0, 0.01 * found.loads[0]) / np.hypot(1.0, 0.01 * np.array(found.loads)),
        rtol=0.2,
    )


def test_a_part_in_the_air_has_one_load() -> None:
    """Most samples at 0 N are one level, not several."""
    load = np.where(np.arange(8000) % 1000 < 800, 0.0, 500.0)
    loud = np.where(load > 0.0, 4.0, 1.0) * np.random.default_rng(9).standard_normal(8000)
    found = levels_by_load(loud, load, 1e-3, EVEN)
    assert found.loads == (0.0, 500.0)
    assert found.by_load[1] / found.by_load[0] == pytest.approx(4.0, rel=0.1)


def test_a_misfit_that_lasts_at_one_load_is_no_noise_of_the_loads() -> None:
    """It differs more between lags of one, two and three samples than the levels of the loads differ at one."""
    white = np.random.default_rng(9).standard_normal(8002)
    lasting = 4.0 * np.convolve(white, np.ones(3) / np.sqrt(3.0), mode="valid")
    steep = np.where((LOAD > 760.0) & (LOAD < 900.0), lasting, white[:8000])
    assert levels_by_load(steep, LOAD, 1e-3, EVEN) is EVEN
