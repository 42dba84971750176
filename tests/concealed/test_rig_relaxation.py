"""Relaxation and softening of the rig against closed forms."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import Effect, GatheringDamage, OgdenRoxburgh, PronySeries, Springpot
from concealed.effects.relaxation import fractional_derivative, overstress
from concealed.motion import FloatArray, Motion

MakeMotion = Callable[..., Motion]
Added = Callable[[Effect, Motion], FloatArray]
Area = Callable[[Motion, FloatArray], float]


def test_a_branch_under_a_ramp_and_a_hold() -> None:
    """q = Q' tau (1 - exp(-t/tau)) while the force rises at Q', and decays by exp(-t/tau) after."""
    tau, step = 0.7, 0.01
    time = np.arange(1001) * step
    force = np.minimum(time, 3.0) * 200.0
    q = overstress(force, step, tau)
    rising, held = time <= 3.0, time >= 3.0
    peak = 200.0 * tau * -math.expm1(-3.0 / tau)
    assert q[rising] == pytest.approx(200.0 * tau * -np.expm1(-time[rising] / tau), rel=1e-9)
    assert q[held] == pytest.approx(peak * np.exp(-(time[held] - 3.0) / tau), rel=1e-9)


def test_the_loss_of_one_branch_peaks_at_its_own_frequency(
    sine_motion: MakeMotion, added: Added, loop_area: Area
) -> None:
    """Loop area over frequency is w tau/(1 + w^2 tau^2): largest at f = 1/(2 pi tau), equal an octave either
    way.

    A small stroke keeps the elastic force nearly harmonic; three cycles are enough for the start to be
    forgotten.
    """
    tau = 0.1
    effect = PronySeries(0.1, (1.0,), (tau,))
    peak = 1.0 / (2.0 * np.pi * tau)
    areas = []
    for factor in (0.5, 1.0, 2.0):
        motion = sine_motion(factor * peak, 0.015, 0.016)
        areas.append(loop_area(motion, added(effect, motion)))
    assert areas[1] / areas[0] == pytest.approx(1.25, rel=0.01)
    assert areas[2] == pytest.approx(areas[0], rel=0.01)


@pytest.mark.parametrize("order", [0.2, 0.35, 0.5])
def test_the_fractional_derivative_of_a_ramp_and_a_step(order: float) -> None:
    """D^a t = t^(1-a)/Gamma(2-a); D^a 1 = t^-a/Gamma(1-a). The scheme is of first order in the step."""
    step = 1e-3
    time = np.arange(1, 5001) * step
    ramp = fractional_derivative(np.concatenate([[0.0], time]), step, order)[1:]
    jump = fractional_derivative(np.ones(5001), step, order)[1:]
    late = time > 0.5
    assert ramp[late] == pytest.approx(time[late] ** (1.0 - order) / math.gamma(2.0 - order), rel=1e-3)
    assert jump[late] == pytest.approx(time[late] ** -order / math.gamma(1.0 - order), rel=2e-3)


def test_the_loss_of_a_springpot_is_a_power_of_the_frequency(
    sine_motion: MakeMotion, added: Added, loop_area: Area
) -> None:
    """Loss modulus ~ w^a. Three cycles after rest are not yet periodic: 3 %."""
    effect = Springpot(0.05, 1.0, 0.3)
    areas = []
    for frequency in (0.1, 10.0):
        motion = sine_motion(frequency, 0.015, 0.016)
        areas.append(loop_area(motion, added(effect, motion)))
    assert areas[1] / areas[0] == pytest.approx(100.0**0.3, rel=0.03)


def test_nothing_is_left_of_a_prony_series_after_a_long_hold(flat_motion: MakeMotion, added: Added) -> None:
    """The law of the tire is the relaxed one."""
    time = np.arange(6001) * 0.02
    force = added(PronySeries(0.1, (0.5, 0.5), (0.3, 4.0)), flat_motion(time, 0.02 * np.minimum(time, 1.0)))
    assert np.max(force) > 50.0
    assert abs(force[-1]) < 1e-6


@pytest.mark.parametrize("effect", [OgdenRoxburgh(0.1, 4.0, 0.3), GatheringDamage(0.1, 0.01, 3.0)])
def test_softening_spares_the_first_loading_and_new_ground(
    effect: Effect, flat_motion: MakeMotion, added: Added
) -> None:
    peaks = np.interp(np.arange(5001), [0, 1000, 2000, 3000, 4000, 5000], [0, 0.015, 0.0, 0.015, 0.025, 0.0])
    force = added(effect, flat_motion(np.arange(5001) * 0.01, peaks))
    assert np.max(np.abs(force[:1001])) < 1e-9
    assert np.min(force[1001:3000]) < -20.0
    assert abs(force[3000]) < 1e-9, "back at the largest deflection so far"
    assert np.max(np.abs(force[3001:4001])) < 1e-6, "deeper than ever before"
    assert np.min(force[4001:]) < -20.0


def test_ogden_roxburgh_reaches_its_closed_form(flat_motion: MakeMotion, bench: Bench) -> None:
    """At x = 0 after a peak: eta = 1 - s erf(W_m/(m + b W_m)), with W = 0.4 F x."""
    x = np.concatenate([np.linspace(0.0, 0.02, 500), np.linspace(0.02, 1e-6, 500)])
    motion = flat_motion(np.arange(1000) * 0.01, x)
    energy = 0.4 * 550.9 * 2.0**1.422 * 0.02
    eta = OgdenRoxburgh(0.2, 3.0, 0.4).softening(bench.contact(motion))
    assert np.asarray(eta)[-1] == pytest.approx(1.0 - 0.2 * math.erf(energy / (3.0 + 0.4 * energy)), rel=1e-6)


def test_damage_gathers_over_the_cycles_and_then_rests(
    sine_motion: MakeMotion, added: Added, loop_area: Area
) -> None:
    motion = sine_motion(0.1)
    troughs = added(GatheringDamage(0.1, 0.02, 3.0), motion).reshape(-1)[:-1].reshape(3, -1).min(axis=1)
    assert troughs[0] > troughs[1] > troughs[2]
    assert abs(troughs[2] - troughs[1]) < 0.3 * abs(troughs[1] - troughs[0])
