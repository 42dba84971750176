"""A law with effects: order, purity, the state's way through JSON, the tested range, and what is refused."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import radialtire
from driving import LINEAR, STIFFNESS, drive, only, sine, tire_with
from hypothesis import given
from hypothesis import strategies as st
from published import hull1996 as article
from radialtire import (
    CATALOGUE,
    CHANNELS,
    Hull1996,
    InputError,
    ParameterError,
    PowerLaw,
    TireModel,
    check_inputs,
    power_law,
    tracking,
)
from radialtire.flat_step import RATE
from radialtire.model import check_measured

EVERYTHING = tire_with(*((name, effect.nominal) for name, effect in CATALOGUE.items()), reading_noise=8e-6)


@given(st.floats(-0.1, 0.3), st.sampled_from([0.0127, 0.5, math.inf, -0.4]), st.floats(0.0, 1e6))
def test_a_bare_tire_is_its_law_and_remembers_nothing(x: float, radius: float, time: float) -> None:
    tire = TireModel()
    force, state = tire.step(x, radius, time, tire.initial_state)
    assert force == power_law.force(x, *Hull1996().coefficients(radius))
    assert state == tire.initial_state
    assert tire.stiffness(x, radius, state) == power_law.stiffness(x, *Hull1996().coefficients(radius))


def test_the_same_step_twice_gives_the_same_answer() -> None:
    state = EVERYTHING.initial_state
    for i in range(40):
        step = (0.01 + 0.005 * math.sin(i), 0.3 if i % 3 else -0.5, 0.01 * i, state)
        first, second = EVERYTHING.step(*step), EVERYTHING.step(*step)
        assert first == second
        state = first[1]


def test_a_state_goes_through_json_without_a_trace() -> None:
    state = EVERYTHING.initial_state
    for i in range(60):
        _, state = EVERYTHING.step(0.01 + 0.005 * math.sin(0.3 * i), 0.3, 0.01 * i, state)
        again = tuple(json.loads(json.dumps(state)))
        assert again == state
        assert EVERYTHING.step(0.012, -0.5, 1.0, again) == EVERYTHING.step(0.012, -0.5, 1.0, state)


def test_looking_again_at_a_moment_keeps_rate_and_force() -> None:
    # a master may ask for the output at the time of the last step
    tire = only("viscous_damping", damping=300.0)
    state = tire.initial_state
    for i in range(10):
        force, state = tire.step(0.01 + 1e-4 * i, math.inf, 0.001 * i, state)
    again, after = tire.step(0.01 + 9e-4, math.inf, 0.009, state)
    assert again == force
    assert after[RATE] == state[RATE]


def test_time_counts_from_the_first_moment() -> None:
    tire = only("pressure_leak", rate=1e-3)
    early = drive(tire, np.arange(5.0), 0.01)
    late = drive(tire, np.arange(5.0) + 1e6, 0.01)
    assert np.array_equal(early, late)


def test_the_rate_is_that_of_the_tire_and_not_of_the_reading() -> None:
    # a linear tire K with a spring 1/k in series moves at 1 / (1 + k K) of the rate read: half of it here
    damped = ("viscous_damping", (100.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    tire = tire_with(("series_compliance", (1.0 / STIFFNESS, 0.0)), damped, law=LINEAR)
    time = np.linspace(0.0, 0.1, 201)
    force = drive(tire, time, 0.01 + 0.1 * time)
    elastic = STIFFNESS * 0.5 * (0.01 + 0.1 * time[-1])
    assert force[-1] == pytest.approx(elastic + 100.0 * 0.05, rel=1e-6)


def test_behind_a_lag_the_rate_follows_from_rate_and_acceleration_of_noisy_readings() -> None:
    # x = y + (tau + delta) v + delta (tau + delta / 2) a moves at v + (tau + delta) a; a spring K with a dashpot c
    tau, delta, damping, noise = 0.005, 0.004, 300.0, 8e-6
    tire = tire_with(
        ("deflection_lag", (tau, delta)),
        ("viscous_damping", (damping, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)),
        reading_noise=noise,
        law=LINEAR,
    )
    time = np.arange(0.0, 1.0, 0.0025)
    read = 0.015 + 0.005 * np.sin(6.0 * time) + noise * np.random.default_rng(5).standard_normal(time.size)
    track = tracking.begin(read[0])
    rates, accelerations = np.zeros_like(time), np.zeros_like(time)
    for i in range(1, time.size):
        track = tracking.follow(track, time[i] - time[i - 1], read[i], noise)
        rates[i], accelerations[i] = tracking.rate(track), tracking.acceleration(track)
    deflection = read + (tau + delta) * rates + delta * (tau + 0.5 * delta) * accelerations
    expected = STIFFNESS * deflection + damping * (rates + (tau + delta) * accelerations)
    assert drive(tire, time, read) == pytest.approx(expected, abs=1e-6)


def test_behind_a_spring_the_rate_of_noisy_readings_is_the_springs_part_of_it() -> None:
    # as above, without a noise: half of the rate read, which the estimator knows to the noise over its memory
    damped = ("viscous_damping", (100.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    spring = ("series_compliance", (1.0 / STIFFNESS, 0.0))
    tire = tire_with(spring, damped, reading_noise=8e-6, law=LINEAR)
    time = np.linspace(0.0, 0.1, 201)
    force = drive(tire, time, 0.01 + 0.1 * time)
    elastic = STIFFNESS * 0.5 * (0.01 + 0.1 * time[-1])
    assert force[-1] == pytest.approx(elastic + 100.0 * 0.05, rel=1e-6)


def test_the_ground_cannot_pull() -> None:
    # unloading at 1 m/s against 1000 N s/m would pull with 1000 N
    tire = only("viscous_damping", damping=1000.0)
    time = np.linspace(0.0, 0.01, 101)
    force = drive(tire, time, 0.01 - time)
    assert force.min() == 0.0
    assert force[0] > 0.0


def test_a_reading_may_be_negative() -> None:
    assert drive(only("force_offset", offset=-5.0), [0.0, 1.0], [-0.01, -0.01])[-1] == -5.0


def test_the_stiffness_of_a_tire_with_effects_is_its_tangent() -> None:
    # friction that turns round within 1 mm adds S / d at a moment from which it has not yet moved
    tire = only("rate_independent_hysteresis", law=LINEAR, slip_force=50.0, reach=1e-3)
    _, state = tire.step(0.01, math.inf, 0.0, tire.initial_state)
    assert tire.stiffness(0.01, math.inf, state) == pytest.approx(STIFFNESS + 50.0 / 1e-3, rel=1e-3)


@pytest.mark.parametrize(
    ("deflection", "radius", "force", "inside"),
    [
        (0.01, math.inf, 500.0, True),
        (0.01, article.SMALLEST_RADIUS, 500.0, True),
        (0.01, 0.999 * article.SMALLEST_RADIUS, 500.0, False),
        (0.01, -0.381, 500.0, True),
        (0.01, -0.38, 500.0, False),
        (article.GREATEST_DEFLECTION, math.inf, article.GREATEST_FORCE, True),
        (0.0318, math.inf, 500.0, False),
        (0.01, math.inf, 2240.1, False),
        (-0.1, math.inf, 0.0, True),
    ],
)
def test_the_tested_range_is_the_articles(
    deflection: float, radius: float, force: float, inside: bool
) -> None:
    assert TireModel().in_tested_range(deflection, radius, force) is inside


def test_nothing_is_tested_where_no_range_is_known() -> None:
    assert not TireModel(tested_range=None).in_tested_range(0.01, math.inf, 500.0)


@pytest.mark.parametrize("x", [-1e3, 0.0, 0.33])
@pytest.mark.parametrize("radius", [1e-9, -1e-9, math.inf, -math.inf])
def test_what_a_wheel_can_meet_is_accepted(x: float, radius: float) -> None:
    check_inputs(x, radius)


@pytest.mark.parametrize("x", [math.nan, math.inf, -math.inf, 0.331, -1001.0])
def test_a_deflection_that_no_wheel_has_is_refused(x: float) -> None:
    with pytest.raises(InputError, match=r"^deflection = .* m is not allowed; it must lie between -1000 m"):
        check_inputs(x, 0.3)


@pytest.mark.parametrize(("held", "air"), [(True, False), (False, False), (True, True)])
def test_a_part_has_no_wheel_that_it_could_reach_beyond(held: bool, air: bool) -> None:
    highest = TireModel(PowerLaw(), two_sided=held, inflated=air).deflection_highest
    check_inputs(0.6, math.inf, highest)
    with pytest.raises(
        InputError, match=r"^deflection = 1001 m is not allowed; it must lie between -1000 m and 1000 m$"
    ):
        check_inputs(1001.0, math.inf, highest)


@pytest.mark.parametrize("radius", [0.0, -0.0, math.nan])
def test_a_radius_that_no_surface_has_is_refused(radius: float) -> None:
    with pytest.raises(InputError, match=r"^surface_radius = .* m is not allowed; it must be positive"):
        check_inputs(0.01, radius)


def test_an_effect_twice_is_refused() -> None:
    pair = (CATALOGUE["inertia"], (1.0,))
    with pytest.raises(ParameterError, match="an effect occurs twice in inertia, inertia"):
        TireModel(effects=(pair, pair))


def test_effects_against_the_signals_way_are_refused() -> None:
    inertia, offset = (CATALOGUE["inertia"], (1.0,)), (CATALOGUE["deflection_offset"], (0.0,))
    with pytest.raises(
        ParameterError, match="the effects inertia, deflection_offset must stand in the order"
    ):
        TireModel(effects=(inertia, offset))


def test_values_of_an_effect_are_checked() -> None:
    with pytest.raises(ParameterError, match="mass = -1 is not allowed"):
        TireModel(effects=((CATALOGUE["inertia"], (-1.0,)),))
    with pytest.raises(ParameterError, match="reading_noise = 2 is not allowed"):
        TireModel(reading_noise=2.0)


def test_effects_act_in_the_order_of_the_signals_way() -> None:
    # offset before the law, lag and zero after it: a held tire reads A (x + x0)^B + F0
    tire = tire_with(
        ("deflection_offset", (1e-3,)), ("force_lag", (0.005, 0.0, 0.0)), ("force_offset", (7.0,))
    )
    force = drive(tire, np.linspace(0.0, 1.0, 101), 0.01)
    assert force[-1] == pytest.approx(power_law.force(0.011, 550.9, 1.422) + 7.0, rel=1e-12)


def test_the_force_of_all_effects_at_once_is_finite_and_another() -> None:
    time, x = sine(1.0, 0.01, 0.012, 3.0, 200)
    force = drive(EVERYTHING, time, x)
    assert np.all(np.isfinite(force))
    assert np.max(np.abs(force - drive(TireModel(), time, x))) > 10.0


def test_the_package_needs_the_standard_library_only() -> None:
    # -I -S: no site-packages, no environment; this is how the FMU has it
    folder = str(Path(radialtire.__file__).parents[1])
    program = (
        f"import sys; sys.path.insert(0, {folder!r}); import radialtire; print(len(radialtire.CATALOGUE))"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", program], capture_output=True, text=True, check=False
    )
    assert done.stderr == ""
    assert int(done.stdout) == len(CATALOGUE)


def test_the_tires_own_deflection_is_the_measured_one_less_a_gauges_offset() -> None:
    offset = TireModel(effects=((CATALOGUE["deflection_offset"], (1.5e-3,)),))
    state = offset.initial_state
    assert offset.channels == ()
    inside = offset.tire_deflection(10e-3, math.inf, 0.1, state)
    # The force of the tire with the effect is that of the law at its own deflection.
    force, _ = offset.step(10e-3, math.inf, 0.1, state)
    assert force == pytest.approx(TireModel().step(inside, math.inf, 0.1, TireModel().initial_state)[0])
    assert abs(inside - 10e-3) == pytest.approx(1.5e-3)
    assert TireModel().tire_deflection(10e-3, math.inf, 0.1, TireModel().initial_state) == 10e-3


def test_a_channel_outside_its_bounds_is_refused_with_them() -> None:
    pressure = next(channel for channel in CHANNELS if channel.name == "pressure")
    check_measured(pressure, pressure.maximum)
    with pytest.raises(InputError, match=r"inflation_pressure = .* is not allowed; it must lie between"):
        check_measured(pressure, 2.0 * pressure.maximum)


def test_a_part_is_held_at_both_ends_or_has_neither_air_nor_a_ground() -> None:
    assert TireModel(PowerLaw(), two_sided=True).is_part
    assert TireModel(PowerLaw(), inflated=False).is_part
    assert not TireModel(PowerLaw()).is_part
    assert not TireModel(inflated=False).is_part
