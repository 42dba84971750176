"""A dashpot: the area of its loop, and its exponents."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, loop_area, only, sine, values_of
from radialtire import Instant
from radialtire.effects.viscous_damping import RELEASED, VISCOUS_DAMPING, carried, flow


@pytest.mark.parametrize("frequency", [0.05, 0.5, 5.0])
def test_its_loop_has_the_area_of_a_dashpot(frequency: float) -> None:
    # pi c w a^2, growing with the frequency; the rate is followed to second order of 1/4000 of a cycle
    c, a = 300.0, 0.008
    time, x = sine(frequency, a, 0.012, 2.0, 4000)
    force = drive(only("viscous_damping", law=LINEAR, damping=c), time, x)
    last = slice(-4001, None)
    expected = math.pi * c * 2.0 * math.pi * frequency * a * a
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=1e-4)


def ramp(speed: float, depth: float, **changed: float) -> float:
    """Force beyond the elastic one at `depth` in a ramp at `speed`."""
    time = np.linspace(0.0, 0.02, 201)
    x = depth + speed * (time - time[-1])
    return float(drive(only("viscous_damping", law=LINEAR, **changed), time, x)[-1]) - STIFFNESS * depth


def test_speed_and_depth_enter_with_their_exponents() -> None:
    assert ramp(0.2, 0.02, damping=300.0) == pytest.approx(60.0, rel=1e-6)
    assert ramp(0.1, 0.01, damping=300.0, rate_exponent=0.5, deflection_exponent=2.0) == pytest.approx(
        30.0, rel=1e-6
    )
    assert ramp(0.4, 0.01, damping=300.0, rate_exponent=0.5) == pytest.approx(30.0 * 2.0, rel=1e-6)
    assert ramp(0.1, 0.02, damping=300.0, deflection_exponent=2.0) == pytest.approx(30.0 * 4.0, rel=1e-6)
    assert ramp(-0.4, 0.01, damping=300.0, rate_exponent=0.5) == pytest.approx(-60.0, rel=1e-6)


def test_the_way_back_is_damped_by_a_share_of_its_own() -> None:
    # the loop's area is the mean of both ways' dashpots: (1 + u)/2 pi c w a^2
    assert ramp(-0.2, 0.02, damping=300.0, rebound=2.5) == pytest.approx(-150.0, rel=1e-6)
    assert ramp(0.2, 0.02, damping=300.0, rebound=2.5) == pytest.approx(60.0, rel=1e-6)
    time, x = sine(0.5, 0.008, 0.012, 2.0, 4000)
    force = drive(only("viscous_damping", law=LINEAR, damping=300.0, rebound=2.5), time, x)
    last = slice(-4001, None)
    expected = 1.75 * math.pi * 300.0 * math.pi * 0.008**2
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=1e-4)


def test_a_tire_in_the_air_is_not_damped() -> None:
    time = np.linspace(0.0, 0.1, 101)
    assert np.all(drive(only("viscous_damping", damping=1e4), time, time - 0.2) == 0.0)


C, E = 5000.0, 2e-5
"""A dashpot [N s/m] in series with a spring [m/N]: a Maxwell element of 0.1 s."""


@pytest.mark.parametrize("frequency", [0.2, 1.0 / (2.0 * math.pi * C * E), 5.0])
def test_behind_a_compliance_its_loop_is_that_of_a_maxwell_element(frequency: float) -> None:
    # pi c w a^2 / (1 + (w c e)^2); an implicit step lags by half of it: 1/8000 of a cycle
    a = 0.008
    time, x = sine(frequency, a, 0.012, 4.0, 8000)
    force = drive(only("viscous_damping", law=LINEAR, damping=C, compliance=E), time, x)
    last = slice(-8001, None)
    w = 2.0 * math.pi * frequency
    expected = math.pi * C * w * a * a / (1.0 + (w * C * E) ** 2)
    assert loop_area(x[last], force[last]) == pytest.approx(expected, rel=2e-3)


def test_a_small_compliance_is_none() -> None:
    time, x = sine(0.5, 0.008, 0.012, 2.0, 4000)
    form = {"damping": 300.0, "rate_exponent": 0.4, "thinning": 20.0, "rebound": 2.0}
    rigid = drive(only("viscous_damping", law=LINEAR, **form), time, x)
    nearly = drive(only("viscous_damping", law=LINEAR, **form, compliance=1e-12), time, x)
    # At a reversal the rate is some nm/s, and the spring takes as much.
    passing = np.abs(np.gradient(x, time)) > 1e-5
    np.testing.assert_allclose(nearly[passing], rigid[passing], rtol=1e-6)


@pytest.mark.parametrize("exponent", [1.0, 0.5])
def test_in_a_hold_its_force_falls_as_the_dashpot_creeps(exponent: float) -> None:
    """dD/dt = -v_d(D) / e: D0 exp(-t / c e) for n = 1; D0 / (1 + v0 D0 t / e C^2) for n = 1/2, C the force at v0."""
    speed, end, h = 0.1, 0.2, 1e-4
    time = np.arange(0.0, 0.6, h)
    x = 0.001 + speed * np.minimum(time, end)
    tire = only("viscous_damping", law=LINEAR, damping=C, rate_exponent=exponent, compliance=E)
    added = drive(tire, time, x) - STIFFNESS * x
    at = np.searchsorted(time, end + 0.01)
    first, t = added[at], time[at:] - time[at]
    expected = (
        first * np.exp(-t / (C * E)) if exponent == 1.0 else first / (1.0 + 0.1 * first * t / (E * 500.0**2))
    )
    assert first > 100.0
    np.testing.assert_allclose(added[at:], expected, rtol=5e-3, atol=0.5)


def test_within_its_play_it_has_no_force() -> None:
    """A sine of 2 mm within a play of 5 mm; one of 8 mm pays for the play at each reversal and no more."""
    small = sine(0.5, 0.002, 0.012, 2.0, 4000)
    tire = only("viscous_damping", law=LINEAR, damping=300.0, play=0.005)
    free = drive(tire, *small)[2000:] - STIFFNESS * small[1][2000:]
    # The first sample is at rest in the middle of the play.
    assert np.max(np.abs(free)) == pytest.approx(0.0, abs=1e-9)
    time, x = sine(0.5, 0.008, 0.012, 2.0, 4000)
    added = drive(tire, time, x)[4000:] - STIFFNESS * x[4000:]
    rate = np.gradient(x, time)[4000:]
    moving = np.abs(added) > 1e-6
    # The step in which it meets the end of its play has a part of the force.
    whole = moving & np.roll(moving, 1)
    np.testing.assert_allclose(added[whole], 300.0 * rate[whole], rtol=1e-3, atol=0.05)
    turned = np.flatnonzero(np.diff(np.sign(rate)) != 0)[0]
    again = turned + np.argmax(moving[turned + 5 :]) + 5
    assert abs(x[4000:][again] - x[4000:][turned]) == pytest.approx(0.005, rel=0.02)


def moment(
    x: float, rate: float, interval: float, *, first: bool = False, two_sided: bool = False
) -> Instant:
    return Instant(0.0, interval, first, x, rate, 0.0, 1000.0, 1.0, 0.0, 0.0, two_sided=two_sided)


@pytest.mark.parametrize(
    "mount", [{"compliance": E}, {"play": 0.004}, {"compliance": E, "play": 0.004}], ids="+".join
)
def test_a_solver_finds_the_force_of_given_steps(mount: dict[str, float]) -> None:
    """Its rates, added up in steps of 1/8000 of a cycle: either way errs by the order of a step."""
    time, x = sine(0.5, 0.008, 0.012, 2.0, 8000)
    form = {"damping": C, "rebound": 2.0, **mount}
    given = drive(only("viscous_damping", law=LINEAR, **form), time, x) - STIFFNESS * x
    values, state, added, h = values_of(VISCOUS_DAMPING, **form), (0.0,), np.empty(time.size), time[1]
    for i in range(time.size):
        rate = (x[i] - x[i - 1]) / h if i else 0.0
        instant = moment(float(x[i]), float(rate), h, first=i == 0)
        force, rates = flow(0.0, instant, state, values)
        added[i] = force
        state = rates if i == 0 else (state[0] + h * rates[0],)
    # Each meets the end of the play a step or two apart: at the start and after four reversals. Nowhere else.
    off = np.abs(added - given)[1:] > 0.01 * np.max(np.abs(given))
    assert np.max(np.abs(given)) > 50.0
    assert np.count_nonzero(off) <= 2 * 5


def test_for_a_solver_what_gave_way_springs_back_where_nothing_holds_it() -> None:
    """In the air, and where the dashpot has no force at all: to the end of the play, with the time RELEASED."""
    values = values_of(VISCOUS_DAMPING, damping=C, compliance=E, play=0.002)
    assert flow(5.0, moment(-0.01, 0.1, 1e-3), (0.003,), values) == (5.0, (-0.003 / RELEASED,))
    assert flow(5.0, moment(-0.01, 0.1, 1e-3, first=True), (0.0,), values) == (5.0, (0.0,))
    no_patch = values_of(VISCOUS_DAMPING, damping=C, deflection_exponent=1.0, compliance=E, play=0.002)
    signal, rates = flow(5.0, moment(0.0, 0.1, 1e-3, two_sided=True), (-0.003,), no_patch)
    assert (signal, rates[0]) == (5.0, pytest.approx(0.1 + 0.002 / RELEASED))
    left, state = VISCOUS_DAMPING.respond(5.0, moment(0.0, -3.0, 1e-3, two_sided=True), (0.0,), no_patch)
    assert (left, state) == (5.0, (-0.001,))


def test_for_a_solver_it_begins_at_the_force_of_a_constant_rate() -> None:
    values = values_of(VISCOUS_DAMPING, damping=C, compliance=E, play=0.002)
    force, state = flow(0.0, moment(0.01, -0.02, 0.0, first=True), (0.0,), values)
    assert (force, state[0]) == (pytest.approx(-100.0), pytest.approx(-0.001 - 100.0 * E))
    # And at a constant rate it stays there.
    again, rates = flow(0.0, moment(0.01, -0.02, 1e-3), state, values)
    assert (again, rates[0]) == (pytest.approx(-100.0), pytest.approx(0.0, abs=1e-12))


def test_a_step_without_time_is_taken_by_the_compliance() -> None:
    """A jump of 1 mm: half of the play first, then the spring; without one nothing can be said, and nothing is."""
    sprung = values_of(VISCOUS_DAMPING, damping=C, compliance=E, play=0.001)
    jump = Instant(0.0, 0.0, False, 0.01, 0.0, 0.0, 1000.0, 1.0, 0.0, 0.0)
    assert VISCOUS_DAMPING.respond(0.0, jump, (0.0015,), sprung) == (pytest.approx(0.001 / E), (0.0015,))
    rigid = values_of(VISCOUS_DAMPING, damping=C, play=0.001)
    assert VISCOUS_DAMPING.respond(0.0, jump, (0.0015,), rigid) == (0.0, (0.0015,))


def test_the_search_of_its_force_ends_whatever_it_is_given() -> None:
    assert math.isnan(carried(math.nan, 1e-3, 0.0, E, (C, 1.0, 0.0)))
    # The force is less than the smallest number.
    assert carried(1e-300, 1.0, 0.0, E, (1e-30, 1.0, 0.0)) == 0.0
    for exponent in (0.5, 1.0):
        assert math.isnan(carried(math.nan, 1e-3, 0.0, E, (C, exponent, 0.0)))
    assert carried(1e-300, 1.0, 0.0, E, (1e-30, 2.0, 0.0)) == 0.0
    # The compliance would hold 1e40 times the force at the rate v0, at which a rate is no number.
    assert carried(1.0, 1e-3, 0.9e40, 1e-40, (1.0, 0.05, 0.0)) == pytest.approx(10000.0**0.05, rel=1e-12)


@pytest.mark.parametrize("thinning", [0.0, 3.0, 200.0])
@pytest.mark.parametrize("exponent", [0.05, 0.3, 1.0, 1.7, 3.0])
@pytest.mark.parametrize("begun", [0.0, 0.3, 0.97, 1.0, 2.0])
def test_the_force_behind_a_compliance_solves_its_equation(
    exponent: float, thinning: float, begun: float
) -> None:
    """e D + h v_d(D) = reach, by bisection of the rate: D = reach / e - h v / e, and the dashpot's own force at v."""
    size, interval, reach = 40.0, 2e-3, 1.3e-3

    def off(rate: float) -> float:
        felt = math.asinh(thinning * rate) / thinning if thinning else rate
        return size * (felt / 0.1) ** exponent - (reach - interval * rate) / E

    low, high = 0.0, reach / interval
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if off(middle) > 0.0 else (middle, high)
    expected = (reach - interval * low) / E
    found = carried(reach, interval, begun * expected, E, (size, exponent, thinning))
    # What is left of the reach is rounded, and its part of the whole is small where the dashpot takes most of it.
    assert found == pytest.approx(expected, rel=1e-9)
