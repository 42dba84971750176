"""Relaxation: holds, loss peak and storage of standard linear solids."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, harmonic, only, sine, values_of
from hypothesis import given, settings
from hypothesis import strategies as st
from radialtire import CATALOGUE, TireModel
from radialtire.effects.viscoelastic_relaxation import overstress

NAME = "viscoelastic_relaxation"


def test_a_held_force_decays_with_the_relaxation_times() -> None:
    # loaded in 1e-6 s: F_e (1 + g1 exp(-t/tau1) + g2 exp(-t/tau2)); 1e-6 s of 0.3 s is lost on the way up
    tire = only(NAME, law=LINEAR, share_1=0.05, relaxation_time_1=0.3, share_2=0.08, relaxation_time_2=4.0)
    time = np.concatenate([[0.0, 1e-6], np.linspace(0.01, 20.0, 50)])
    force = drive(tire, time, np.concatenate([[0.0], np.full(51, 0.02)]))
    expected = STIFFNESS * 0.02 * (1.0 + 0.05 * np.exp(-time / 0.3) + 0.08 * np.exp(-time / 4.0))
    assert force[1:] == pytest.approx(expected[1:], rel=1e-5)


def test_five_terms_follow_a_power_of_the_time_over_four_decades() -> None:
    """A step relaxes as t^-0.4 from 10 ms to 100 s, which is the sum of exponentials of all times (Laplace)."""
    times = np.geomspace(0.01, 100.0, 5)
    held = np.geomspace(0.01, 100.0, 41)
    shares, *_ = np.linalg.lstsq(
        np.exp(-held[:, None] / times) * held[:, None] ** 0.4, np.ones(41), rcond=None
    )
    assert shares.min() > 0.0
    values = {f"share_{i}": 0.02 * g for i, g in enumerate(shares, start=1)}
    values |= {f"relaxation_time_{i}": t for i, t in enumerate(times, start=1)}
    force = drive(only(NAME, law=LINEAR, **values), [0.0, 1e-9, *held], [0.0, *np.full(42, 0.02)])
    added = force[2:] / (STIFFNESS * 0.02) - 1.0
    # One exponential to a decade ripples by a tenth, and falls short where its own times end.
    inside = (held > 0.02) & (held < 50.0)
    np.testing.assert_allclose(added[inside], 0.02 * held[inside] ** -0.4, rtol=0.15)


@pytest.mark.parametrize("times_tau", [0.1, 1.0, 10.0])
def test_storage_and_loss_are_those_of_a_standard_linear_solid(times_tau: float) -> None:
    # K (1 + g i w tau / (1 + i w tau)); straight lines between 500 moments of a cycle lose (2 pi / 500)^2 / 12
    g, tau, frequency, a = 0.2, 0.5, times_tau / (2.0 * math.pi * 0.5), 0.008
    cycles = max(3.0, math.ceil(8.0 * tau * frequency))
    time, x = sine(frequency, a, 0.012, cycles, 500)
    force = harmonic(
        time, drive(only(NAME, law=LINEAR, share_1=g, relaxation_time_1=tau), time, x), frequency
    )
    w_tau = 1j * times_tau
    expected = STIFFNESS * a * (1.0 + g * w_tau / (1.0 + w_tau))
    assert abs(force - expected) < 1e-3 * g * abs(expected)


def test_the_loss_peaks_where_omega_tau_is_one() -> None:
    tau = 0.5

    def loss(times_tau: float) -> float:
        frequency = times_tau / (2.0 * math.pi * tau)
        time, x = sine(frequency, 0.008, 0.012, 5.0, 300)
        force = drive(only(NAME, law=LINEAR, share_1=0.2, relaxation_time_1=tau), time, x)
        return harmonic(time, force, frequency).imag

    at_peak = loss(1.0)
    assert at_peak == pytest.approx(0.2 * STIFFNESS * 0.008 / 2.0, rel=2e-3)
    assert loss(0.7) < at_peak
    assert loss(1.4) < at_peak


@given(
    st.floats(-100.0, 100.0),
    st.floats(-500.0, 500.0),
    st.floats(1e-4, 2.0),
    st.floats(1e-4, 1e3),
    st.integers(2, 9),
)
@settings(max_examples=100, deadline=None)
def test_a_straight_way_may_be_cut_anywhere(
    h: float, change: float, interval: float, tau: float, parts: int
) -> None:
    # exact integration: n parts of a straight line give what the whole gives
    whole = overstress(h, change, interval, tau)
    for _ in range(parts):
        h = overstress(h, change / parts, interval / parts, tau)
    assert h == pytest.approx(whole, rel=1e-10, abs=1e-9)


def test_no_time_passing_is_a_sudden_change() -> None:
    assert overstress(3.0, 5.0, 0.0, 1.0) == 8.0


def test_a_law_of_the_sudden_force_relaxes_from_it() -> None:
    # r = 1: a step reads the law at once, and 1 - g of it in the end
    tire = only(NAME, law=LINEAR, share_1=0.1, relaxation_time_1=1.0, sudden=1.0)
    force = drive(tire, [0.0, 1e-9, 100.0], [0.0, 0.02, 0.02])
    assert force[1] == pytest.approx(STIFFNESS * 0.02, rel=1e-8)
    assert force[2] == pytest.approx(0.9 * STIFFNESS * 0.02, rel=1e-8)


def test_three_terms_follow_six() -> None:
    # documented: rubber of six times over three decades, fitted with three, within a few tenths of a percent
    time = np.geomspace(1e-3, 100.0, 200)
    six = sum(0.02 * np.exp(-time / tau) for tau in np.geomspace(0.01, 10.0, 6))
    columns = np.stack([np.exp(-time / tau) for tau in (0.016, 0.3, 6.5)], axis=1)
    shares, *_ = np.linalg.lstsq(columns, six, rcond=None)
    assert np.all(shares > 0.0)
    assert np.max(np.abs(columns @ shares - six)) < 0.005


TERMS = {"share_1": 0.2, "relaxation_time_1": 30.0, "share_2": 0.1, "relaxation_time_2": 800.0}


@pytest.mark.parametrize("held", [0.0, 0.7, 30.0, 400.0])
def test_a_recording_that_begins_in_a_hold_has_what_the_whole_one_has_left(held: float) -> None:
    """A step, a rest, and then the recording: F_e (1 + sum g_i exp(-t / tau_i)) from the step on, in closed form; and
    whatever follows as it is where the step is recorded too.
    """
    fresh = only(NAME, law=LINEAR, freshness=30.0 / (30.0 + held), **TERMS)
    time = np.linspace(0.0, 300.0, 61)
    force = drive(fresh, time, np.full(61, 0.01))
    expected = 1000.0 * (1.0 + 0.2 * np.exp(-(held + time) / 30.0) + 0.1 * np.exp(-(held + time) / 800.0))
    assert force == pytest.approx(expected, rel=1e-12)
    x = 0.01 + 0.008 * np.sin(time / 20.0)
    whole = drive(
        only(NAME, law=LINEAR, **TERMS),
        np.concatenate([[0.0, 1e-9, held + 2e-9], held + time[1:] + 2e-9]),
        np.concatenate([[0.0, 0.01], x]),
    )
    assert drive(fresh, time, x) == pytest.approx(whole[2:], rel=1e-8)


def test_of_a_deflection_that_took_a_while_the_time_counts_from_its_middle() -> None:
    """A ramp of 2 s: (1 - exp(-T / tau)) tau / T is exp(-T / 2 tau) but for (T / tau)^2 / 24."""
    ramp = drive(only(NAME, law=LINEAR, **TERMS), [0.0, 2.0, 102.0], [0.0, 0.01, 0.01])
    fresh = drive(only(NAME, law=LINEAR, freshness=30.0 / 31.0, **TERMS), [0.0, 100.0], [0.01, 0.01])
    assert fresh == pytest.approx(ramp[1:], abs=1.1 * 200.0 * (2.0 / 30.0) ** 2 / 24.0)


def test_a_recording_that_begins_without_a_force_is_the_same_however_fresh() -> None:
    time = np.linspace(0.0, 10.0, 101)
    x = 0.01 * np.sin(time) - 1e-3
    relaxed, fresh = (drive(only(NAME, freshness=f, **TERMS), time, x) for f in (0.0, 0.9))
    assert fresh.tolist() == relaxed.tolist()
    assert relaxed.max() > 100.0


def test_a_preload_has_relaxed_already() -> None:
    values = values_of(CATALOGUE[NAME], freshness=0.5, sudden=1.0, share_1=0.2, relaxation_time_1=30.0)
    part = TireModel(LINEAR, ((CATALOGUE[NAME], values),), two_sided=True, preload=50.0)
    # 1 - r g + g exp(-1) of -1 kN, beside the preload
    assert drive(part, [0.0], [-0.01]) == pytest.approx(50.0 - 1000.0 * (1.0 - 0.2 + 0.2 * math.exp(-1.0)))


def test_a_relaxing_tire_leaves_the_ground_before_its_shape_does() -> None:
    # unloaded fast from a long hold the overstress is negative: near x = 0 it would pull
    tire = only(NAME, law=LINEAR, share_1=0.5, relaxation_time_1=10.0)
    time = np.concatenate([[0.0], np.linspace(1000.0, 1000.1, 101)])
    x = np.concatenate([[0.02], np.linspace(0.02, 0.0, 101)])
    force = drive(tire, time, x)
    assert force[-10] == 0.0
    assert x[-10] > 0.0
