"""The forms of effects for a solver, integrated by small steps, against the forms for given steps and closed forms."""

from __future__ import annotations

import math

import pytest
from radialtire import CATALOGUE, NONE_MEASURED
from radialtire.effect import Instant, State
from radialtire.effects.force_lag import flow as lag_flow
from radialtire.effects.viscoelastic_relaxation import flow as relaxation_flow
from radialtire.flat_step import (
    CONTINUOUS,
    DEFLECTION,
    FOLLOWED,
    STARTED,
    TANGENT_STEP,
    laid_out,
    step,
    stiffness,
)

FLAT = float("inf")
LAW = (500.0, 1.4)


def at(time: float, interval: float, *, first: bool = False, elastic: float = 0.0) -> Instant:
    return Instant(time, interval, first, 0.01, 0.0, 0.0, 500.0, 1.4, elastic, 0.0)


def relaxing(share: float, tau: float, sudden: float = 0.0, freshness: float = 0.0) -> State:
    return (share, tau, 0.0, 1.0, 0.0, 1.0, sudden, 0.0, 1.0, 0.0, 1.0, freshness)


def test_overstress_of_a_held_force_decays_with_its_time() -> None:
    """dq/dt = (F - q) / tau from q = 0: F (1 - exp(-t / tau)); Euler with h errs by h / 2 tau at most."""
    values, q, h = relaxing(0.5, 2.0), 0.0, 1e-3
    for k in range(2000):
        _, rates = relaxation_flow(0.0, at(h * k, h, elastic=100.0), (0.0, q, q, q, q, q), values)
        q += h * rates[1]
    assert q == pytest.approx(100.0 * (1.0 - math.exp(-1.0)), rel=1e-3)
    added, _ = relaxation_flow(0.0, at(2.0, h, elastic=100.0), (0.0, q, q, q, q, q), values)
    assert added == pytest.approx(0.5 * 100.0 * math.exp(-1.0), rel=1e-3)


def test_the_first_sample_has_relaxed_already() -> None:
    added, states = relaxation_flow(
        7.0, at(0.0, 0.0, first=True, elastic=100.0), (0.0,) * 6, relaxing(0.5, 2.0, 0.2)
    )
    assert added == pytest.approx(7.0 - 0.2 * 0.5 * 100.0)
    assert states[1:] == (100.0,) * 5


def test_the_first_sample_may_be_fresh() -> None:
    """f = 1/2: held for tau_1 = 2 s; the third time is 1 s, so exp(-1) and exp(-2) of the force are left."""
    values = relaxing(0.5, 2.0, 0.2, freshness=0.5)
    added, states = relaxation_flow(7.0, at(0.0, 0.0, first=True, elastic=100.0), (0.0,) * 6, values)
    assert added == pytest.approx(7.0 + 0.5 * 100.0 * (math.exp(-1.0) - 0.2))
    assert states[1:] == pytest.approx(
        (100.0 * (1.0 - math.exp(-1.0)), *[100.0 * (1.0 - math.exp(-2.0))] * 4)
    )
    again, _ = CATALOGUE["viscoelastic_relaxation"].respond(
        7.0, at(0.0, 0.0, first=True, elastic=100.0), (0.0,) * 6, values
    )
    assert again == pytest.approx(added)


def lagging(state: State, tau: float, quality: float, *, first: bool = False) -> tuple[float, State]:
    whole = (*state, *[0.0] * (len(CATALOGUE["force_lag"].initial_state) - 3))
    return lag_flow(10.0, at(1.0, 1e-3, first=first), whole, (tau, 0.0, quality))


def test_a_channel_begins_at_its_input_and_one_without_a_lag_passes_it_on() -> None:
    reading, state = lagging((0.0, 0.0, 0.0), 0.1, 0.0, first=True)
    assert (reading, state[:2]) == (10.0, (10.0, 0.0))
    reading, state = lagging((3.0, 0.0, 10.0), 0.0, 0.0)
    assert (reading, state[:2]) == (10.0, (0.0, 0.0))


def test_a_first_order_channel_moves_by_what_it_misses_over_its_time() -> None:
    reading, state = lagging((3.0, 0.0, 10.0), 0.1, 0.0)
    assert (reading, state[0]) == (3.0, pytest.approx(70.0))


def test_a_second_order_channel_obeys_its_equation() -> None:
    """(Q tau)^2 y'' + tau y' + y = u with y = 3, y' = 20, u = 10."""
    tau, quality = 0.1, 0.7
    reading, state = lagging((3.0, 20.0, 10.0), tau, quality)
    assert (reading, state[0]) == (3.0, 20.0)
    assert (quality * tau) ** 2 * state[1] + tau * 20.0 + 3.0 == pytest.approx(10.0)


def test_a_solvers_step_gives_the_rates_of_flows_and_follows_a_spring_under_the_tire() -> None:
    """Damping beside a series spring: the tire's rate is that of its share of the deflection."""
    effects = [CATALOGUE[n] for n in ("series_compliance", "viscous_damping", "viscoelastic_relaxation")]
    path, p, s = laid_out(effects, tracks=0)
    for stages in path[:6]:
        for stage in stages:
            p[stage.switch] = 1.0
    (spring,) = path.series
    p[spring.values] = 1e-6
    damper, rubber = path.parallel
    p[damper.values] = 300.0
    p[rubber.values] = 0.2
    p[CONTINUOUS] = p[FOLLOWED] = 1.0
    n = list(s)
    s[STARTED] = 1.0
    s[rubber.state : rubber.state_end] = [0.0] * (rubber.state_end - rubber.state)
    force, x = step(path, LAW, (0.01, FLAT, 0.5, 0.2, 0.0, *NONE_MEASURED), p, s, n)
    p[damper.values] = 0.0
    still, _ = step(path, LAW, (0.01, FLAT, 0.5, 0.2, 0.0, *NONE_MEASURED), p, s, n)
    p[damper.values] = 300.0
    _, above = step(path, LAW, (0.01 + 1e-7, FLAT, 0.5, 0.0, 0.0, *NONE_MEASURED), p, s, n)
    assert x < 0.01
    assert force - still == pytest.approx(300.0 * 0.2 * (above - x) / 1e-7, rel=1e-2)
    elastic = LAW[0] * (100.0 * x) ** LAW[1]
    assert n[rubber.state + 1] == pytest.approx(elastic / p[rubber.values + 1], rel=1e-4)
    assert n[DEFLECTION] == pytest.approx(0.01 + 1e-7)


@pytest.mark.parametrize(
    ("x", "begin"),
    [(0.5 * TANGENT_STEP, 0.5 * TANGENT_STEP), (0.0, -TANGENT_STEP)],
    ids=["in contact", "in the air"],
)
def test_the_tangent_is_one_sided_where_the_contact_begins(x: float, begin: float) -> None:
    path, p, s = laid_out([], tracks=0)

    def force(deflection: float) -> float:
        return LAW[0] * max(100.0 * deflection, 0.0) ** LAW[1]

    found = stiffness(path, LAW, (x, FLAT, 0.0, 0.0, 0.0, *NONE_MEASURED), p, s, list(s))
    assert found == pytest.approx((force(begin + TANGENT_STEP) - force(begin)) / TANGENT_STEP)


def test_effects_that_are_switched_off_do_nothing() -> None:
    path, p, s = laid_out([CATALOGUE[n] for n in ("series_compliance", "viscous_damping")], tracks=0)
    force, x = step(path, LAW, (0.01, FLAT, 0.0, 0.2, 0.0, *NONE_MEASURED), p, s, list(s))
    assert (force, x) == (pytest.approx(LAW[0]), 0.01)
