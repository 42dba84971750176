"""Damping, inertia and lag of the rig against what a sine must give."""

from collections.abc import Callable

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import (
    Effect,
    LinearDashpot,
    LowPass,
    MovingMass,
    PowerDashpot,
    PureDelay,
    SaturatingDashpot,
)
from concealed.motion import FloatArray, Motion

MakeMotion = Callable[..., Motion]
Added = Callable[[Effect, Motion], FloatArray]
Area = Callable[[Motion, FloatArray], float]

#: Half stroke of the sines that never leave the ground [m].
HALF = 0.008


@pytest.fixture
def pressed(sine_motion: MakeMotion) -> Callable[[float], Motion]:
    """A sine that stays in full contact, where no damper lets go."""
    return lambda frequency: sine_motion(frequency, 0.008, 0.024)


def test_a_linear_dashpot_loses_pi_c_omega_x_squared(
    pressed: MakeMotion, added: Added, loop_area: Area
) -> None:
    for frequency in (0.05, 0.5, 5.0):
        motion = pressed(frequency)
        area = loop_area(motion, added(LinearDashpot(300.0), motion))
        assert area == pytest.approx(np.pi * 300.0 * 2.0 * np.pi * frequency * HALF**2, rel=1e-4)


def test_300_newton_seconds_give_the_loops_of_the_table(flat_motion: MakeMotion, added: Added) -> None:
    """0.2, 1.8 and 17.9 % of the elastic energy on triangles of 0.05, 0.5 and 5 Hz, for x from 0 to 2.5 cm.

    Elastic energy A x^(B+1)/(B+1) = 20.9 J. Near x = 0 the tire lets go of the ground, which costs some
    percent.
    """
    energy = 550.9 * 2.5**2.422 / 2.422 / 100.0
    for frequency, percent in ((0.05, 0.179), (0.5, 1.79), (5.0, 17.9)):
        time = np.linspace(0.0, 1.0 / frequency, 4001)
        motion = flat_motion(time, 0.025 * (1.0 - np.abs(2.0 * frequency * time - 1.0)))
        force = added(LinearDashpot(300.0), motion)
        area = float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(motion.deflection)))
        assert 100.0 * area / energy == pytest.approx(percent, rel=0.05)


def test_a_power_dashpot_grows_by_its_power(pressed: MakeMotion, added: Added, loop_area: Area) -> None:
    areas = [loop_area(m, added(PowerDashpot(300.0, 0.05, 0.8), m)) for m in (pressed(0.2), pressed(2.0))]
    assert areas[1] / areas[0] == pytest.approx(10.0**0.8, rel=1e-4)


def test_a_saturating_dashpot_is_linear_when_slow_and_flat_when_fast(
    pressed: MakeMotion, added: Added
) -> None:
    effect = SaturatingDashpot(300.0, 0.05)
    slow, fast = pressed(0.01), pressed(50.0)
    assert added(effect, slow) == pytest.approx(300.0 * slow.rate, abs=1e-4)
    assert np.max(np.abs(added(effect, fast))) == pytest.approx(300.0 * 0.05, rel=1e-3)


def test_a_mass_pushes_with_its_acceleration(pressed: MakeMotion, added: Added) -> None:
    """x = m - X cos(w t): a = X w^2 cos(w t). The ends of a spline are its weak spots."""
    motion = pressed(3.0)
    omega = 2.0 * np.pi * 3.0
    expected = 2.5 * HALF * omega**2 * np.cos(omega * motion.time)
    inner = slice(20, -20)
    assert added(MovingMass(2.5), motion)[inner] == pytest.approx(expected[inner], abs=1e-3)


def test_a_delay_shifts_the_force(pressed: MakeMotion, bench: Bench) -> None:
    motion = pressed(1.0)
    shift = 40
    late = Bench(bench.tire, (PureDelay(shift * motion.step),)).force(motion)
    assert late[shift:] == pytest.approx(bench.force(motion)[:-shift], abs=1e-6)


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("bessel", [True, False])
def test_a_low_pass_comes_late_by_its_strength(
    order: int, bessel: bool, bench: Bench, flat_motion: MakeMotion
) -> None:
    """On a steady ramp of the force every filter of unit gain lags by its delay at zero frequency."""
    time = np.arange(4001) * 1e-3
    ramp = 100.0 * time
    late = LowPass(0.02, order, bessel).channel(flat_motion(time, 0.0 * time), ramp)
    assert late[2000:] == pytest.approx(ramp[2000:] - 100.0 * 0.02, abs=1e-6)


@pytest.mark.parametrize("effect", [PureDelay(0.005), LowPass(0.005, 2, True), LowPass(0.005, 4, False)])
def test_a_lag_turns_the_loop_the_wrong_way_round(
    effect: Effect, pressed: MakeMotion, added: Added, loop_area: Area
) -> None:
    """F(t - T) = F - T dF/dt: area -T integral k v^2 dt with the tangent k = A B x^(B - 1)."""
    motion = pressed(0.5)
    cm = 100.0 * motion.deflection[-4001:]
    tangent = 100.0 * 550.9 * 1.422 * cm**0.422
    expected = -0.005 * float(np.sum((tangent * motion.rate[-4001:] ** 2)[:-1])) * motion.step
    assert loop_area(motion, added(effect, motion)) == pytest.approx(expected, rel=2e-3)
