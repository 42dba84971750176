"""Model Exchange against closed forms: loops, states, derivatives, calls; in a host of a few lines."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from ctypes import c_double, c_size_t
from pathlib import Path
from typing import Any

import pytest
from loader_bench import unpacked_archive
from native_me import RADIAL_FORCE, Unit, runge_kutta
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.fmu.native.pack import build_native_fmu

STIFFNESS = 150_000.0
LINEAR = PowerLaw(1500.0, 1.0)
"""150 000 N/m: Wang and Hull's road tire."""

FLAT = 1e5


def tire_with(**effects: dict[str, float]) -> TireModel:
    acting = []
    for name, given in effects.items():
        effect = CATALOGUE[name]
        acting.append((effect, tuple(given.get(p.name, p.start) for p in effect.parameters)))
    return TireModel(law=LINEAR, effects=tuple(acting))


def unit(tire: TireModel, folder: Path, *start: float) -> Unit:
    return Unit(unpacked_archive(build_native_fmu(tire, folder).path, folder / "fmu"), [*start])


def test_a_low_pass_is_two_states_and_answers_a_step_as_its_equation(tmp_path: Path) -> None:
    """(Q tau)^2 y'' + tau y' + y = F after F has jumped: critically damped for Q = 1/2."""
    tau = 0.01
    lagging = unit(tire_with(force_lag={"lag": tau, "quality": 0.5}), tmp_path, 0.005, FLAT)
    y, h, time = lagging.continuous(), 1e-5, 0.0
    assert y == [STIFFNESS * 0.005, 0.0]
    for _ in range(2000):
        y = runge_kutta(lambda t, y: lagging.evaluate(t, [0.01, FLAT], y)[1], time, y, h)
        time += h
        lagging.evaluate(time, [0.01, FLAT], y)
        lagging.accept()
    fade = 2.0 * time / tau
    expected = STIFFNESS * (0.01 - 0.005 * (1.0 + fade) * math.exp(-fade))
    assert lagging.evaluate(time, [0.01, FLAT], y)[0] == pytest.approx(expected, rel=1e-6)


OF_INPUTS_AND_TIME = (
    "deflection_offset",
    "series_compliance",
    "elastic_shape",
    "gas_compression",
    "bottoming",
    "inflation_pressure",
    "force_offset",
    "force_drift",
    "saturation",
    "pressure_leak",
    "warm_up",
)
"""The first row of the table of effects in examples/docs/fmu.md."""


@pytest.mark.parametrize("name", OF_INPUTS_AND_TIME)
def test_effects_without_memory_are_exact(tmp_path: Path, name: str) -> None:
    """The force of the step of Co-Simulation at the same time, bit by bit; what a solver tries leaves no trace."""
    effect = CATALOGUE[name]
    tire = TireModel(effects=((effect, effect.nominal),))
    fmu = unpacked_archive(build_native_fmu(tire, tmp_path).path, tmp_path / "fmu")
    solved, stepped = (Unit(fmu, [0.01, FLAT], exchange=kind) for kind in (True, False))
    bare = TireModel()
    other = 0
    for i in range(1, 40):
        time, x = 0.25 * i, 0.012 * (1.0 + math.sin(0.7 * i))
        solved.evaluate(time - 0.1, [x + 0.003, 0.3], [])
        found, _ = solved.evaluate(time, [x, FLAT], [])
        solved.accept()
        stepped.set([x, FLAT])
        stepped.step(0.25 * (i - 1), 0.25)
        assert found == stepped.get()
        other += found != bare.step(x, FLAT, time, bare.initial_state)[0]
    assert other > 5 or name == "inflation_pressure"  # at its reference pressure it changes nothing


@pytest.mark.parametrize("name", ["rate_independent_hysteresis", "mullins_softening"])
def test_loops_of_memory_close(tmp_path: Path, name: str) -> None:
    """Kept at accepted steps; what a solver tries in between leaves no trace. The third loop is the second one."""
    effect = CATALOGUE[name]
    rubbing = unit(TireModel(law=LINEAR, effects=((effect, effect.nominal),)), tmp_path, 0.0, FLAT)
    loops: list[list[float]] = [[], [], []]
    for i in range(600):
        x, time = 0.01 * (1.0 - math.cos(2.0 * math.pi * i / 200.0)), 1e-3 * (i + 1)
        tried = rubbing.evaluate(time, [x, FLAT], [])[0]
        rubbing.evaluate(time, [x + 0.004, FLAT], [])
        assert rubbing.evaluate(time, [x, FLAT], [])[0] == tried
        rubbing.accept()
        loops[i // 200].append(tried)
    assert loops[2] == pytest.approx(loops[1], rel=1e-9, abs=1e-9)
    assert loops[0] != pytest.approx(loops[1], rel=1e-3)


def test_a_step_that_is_completed_in_vain_leaves_no_trace(tmp_path: Path) -> None:
    """OpenModelica completes one at each evaluation: of a solver's iterations, and of results at times gone by."""
    effect = CATALOGUE["rate_independent_hysteresis"]
    fmu = unpacked_archive(
        build_native_fmu(TireModel(law=LINEAR, effects=((effect, effect.nominal),)), tmp_path).path,
        tmp_path / "fmu",
    )
    proper, eager = (Unit(fmu, [0.0, FLAT]) for _ in range(2))

    def motion(time: float) -> float:
        return 0.01 * (1.0 - math.cos(10.0 * math.pi * time))

    for i in range(1, 400):
        time, earlier = 1e-3 * i, 1e-3 * i - 5e-4
        for at, off in ((time, 1e-3), (earlier, 2e-3), (earlier, 0.0), (time, -2e-3), (time, 0.0)):
            eager.evaluate(at, [motion(at) + off, FLAT], [])
            eager.accept()
        for at in (earlier, time):
            expected, _ = proper.evaluate(at, [motion(at), FLAT], [])
            proper.accept()
        assert eager.evaluate(time, [motion(time), FLAT], [])[0] == expected


def test_an_event_comes_after_the_step_of_its_time(tmp_path: Path) -> None:
    """What an input jumps from there is remembered: friction turns."""
    effect = CATALOGUE["rate_independent_hysteresis"]
    rubbing = unit(TireModel(law=LINEAR, effects=((effect, effect.nominal),)), tmp_path, 0.0, FLAT)
    rubbing.evaluate(0.1, [0.02, FLAT], [])
    rubbing.accept()
    rubbing("EnterEventMode")
    unloaded, _ = rubbing.evaluate(0.1, [0.01, FLAT], [])
    assert unloaded < STIFFNESS * 0.01 - 20.0


def test_derivatives_by_inputs_and_states(tmp_path: Path) -> None:
    """dF/dx = k (1 + g), dF/dv = c, dF/dq = -g, dq'/dx = k / tau, and along any direction their sum."""
    g, tau, c = 0.2, 0.5, 300.0
    tire = tire_with(
        viscous_damping={"damping": c}, viscoelastic_relaxation={"share_1": g, "relaxation_time_1": tau}
    )
    one = unit(tire, tmp_path, 0.01, FLAT, 0.1, 0.0)
    one.evaluate(0.0, [0.01, FLAT, 0.1, 0.0], one.continuous())
    x, v = one.names["deflection"], one.names["deflection_rate"]
    q = one.names["viscoelastic_relaxation.relaxed_1"]
    rate = one.names["der(viscoelastic_relaxation.relaxed_1)"]
    assert one.derivative(RADIAL_FORCE, [x], [1.0]) == pytest.approx(STIFFNESS * (1.0 + g), rel=1e-6)
    assert one.derivative(RADIAL_FORCE, [v], [1.0]) == pytest.approx(c, rel=1e-6)
    assert one.derivative(RADIAL_FORCE, [q], [1.0]) == pytest.approx(-g, rel=1e-6)
    assert one.derivative(rate, [x], [1.0]) == pytest.approx(STIFFNESS / tau, rel=1e-6)
    along = one.derivative(RADIAL_FORCE, [x, v, q], [1.0, 2.0, 3.0])
    assert along == pytest.approx(STIFFNESS * (1.0 + g) + 2.0 * c - 3.0 * g, rel=1e-6)


def test_a_mass_and_a_damper_follow_the_motion_that_is_connected(tmp_path: Path) -> None:
    """F = k x + c v + m a at once: a solver that knows the motion needs no estimate of it."""
    c, m = 300.0, 2.0
    one = unit(tire_with(viscous_damping={"damping": c}, inertia={"mass": m}), tmp_path, 0.01, FLAT, 0.0, 0.0)
    for i, (x, v, a) in enumerate([(0.01, 0.1, 0.0), (0.01, -0.1, 50.0), (0.012, 0.0, -20.0)]):
        force, _ = one.evaluate(1e-3 * i, [x, FLAT, v, a], [])
        assert force == pytest.approx(STIFFNESS * x + c * v + m * a, rel=1e-12)


def test_a_deflection_that_lags_is_ahead_by_the_rate_that_is_connected(tmp_path: Path) -> None:
    """F = k (x + tau v): the reading lags by tau behind the tire."""
    tau = 0.005
    one = unit(tire_with(deflection_lag={"lag": tau}), tmp_path, 0.01, FLAT, 0.0, 0.0)
    for i, (x, v, a) in enumerate([(0.01, 0.1, 0.0), (0.01, -0.1, 50.0), (0.012, 0.0, -20.0)]):
        force, _ = one.evaluate(1e-3 * i, [x, FLAT, v, a], [])
        assert force == pytest.approx(STIFFNESS * (x + tau * v), rel=1e-12)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_an_input_that_no_tire_has_is_refused_in_continuous_time(tmp_path: Path, bad: float) -> None:
    one = unit(tire_with(), tmp_path, 0.01, FLAT)
    for inputs, name in (([bad, FLAT], "deflection"), ([0.01, bad if math.isnan(bad) else 0.0], "surface")):
        with pytest.raises(AssertionError, match=rf"{name}\w* = .* is not allowed"):
            one.evaluate(0.001, inputs, [])
    assert one.evaluate(0.002, [0.01, FLAT], [])[0] == pytest.approx(STIFFNESS * 0.01, rel=1e-12)


def test_a_seed_that_is_no_number_is_refused(tmp_path: Path) -> None:
    one = unit(tire_with(), tmp_path, 0.01, FLAT)
    for seed in (math.nan, math.inf):
        with pytest.raises(AssertionError, match="the seed of value reference 0 is not a finite number"):
            one.derivative(RADIAL_FORCE, [0], [seed])


def test_the_event_indicator_is_of_the_order_of_one_and_never_zero(tmp_path: Path) -> None:
    """FMI 2.0.5, 3.2.2: at an event's restart z is not 0, and it is scaled; z <= 0 in the air."""
    one = unit(tire_with(), tmp_path, 0.02, FLAT)
    assert one.indicator() == pytest.approx(2.0, rel=1e-12)
    one.set([-0.02, FLAT])
    assert one.indicator() == pytest.approx(-2.0, rel=1e-12)
    for zero in (0.0, -0.0):
        one.set([zero, FLAT])
        assert -1e-9 < one.indicator() < 0.0


def values(one: Unit, *names: str) -> list[float]:
    return [one.get(one.names[name]) for name in names]


def test_states_have_the_values_of_the_start_in_initialization_mode(tmp_path: Path) -> None:
    """Relaxed rubber holds the elastic force and rests; so do the channel's output and its slope."""
    tire = tire_with(
        viscoelastic_relaxation={"share_1": 0.2, "relaxation_time_1": 0.5},
        force_lag={"lag": 0.01, "quality": 0.5},
    )
    fmu = unpacked_archive(build_native_fmu(tire, tmp_path).path, tmp_path / "fmu")
    force = STIFFNESS * 0.01
    for exchange in (True, False):
        one = Unit(fmu, [0.01, FLAT], exchange=exchange, begun=False)
        expected = [force] * 6 + [0.0]
        rest = [0.0] * 7
        states = [name[4:-1] for name in one.names if name.startswith("der(")]
        assert values(one, *states) == pytest.approx(expected, rel=1e-12)
        assert values(one, *(f"der({name})" for name in states)) == pytest.approx(rest, abs=1e-9)
        if exchange:
            assert one.continuous() == pytest.approx(expected, rel=1e-12)
            row = (c_double * 7)()
            one("GetDerivatives", row, c_size_t(7))
            assert list(row) == pytest.approx(rest, abs=1e-9)


def test_what_relaxed_before_the_first_sample_is_in_the_states(tmp_path: Path) -> None:
    """Held for tau / 3 before (f = 3/4), so h = F exp(-(t + tau / 3) / tau) in a hold, and q = F - h."""
    g, tau, held = 0.2, 0.5, STIFFNESS * 0.01
    given = {"share_1": g, "relaxation_time_1": tau, "freshness": 0.75}
    one = unit(tire_with(viscoelastic_relaxation=given), tmp_path, 0.01, FLAT)
    q, h, time = one.continuous(), 1e-3, 0.0
    assert q[0] == pytest.approx(held * (1.0 - math.exp(-1.0 / 3.0)), rel=1e-12)
    for _ in range(500):
        q = runge_kutta(lambda t, q: one.evaluate(t, [0.01, FLAT], q)[1], time, q, h)
        time += h
        one.evaluate(time, [0.01, FLAT], q)
        one.accept()
    expected = held * (1.0 + g * math.exp(-time / tau - 1.0 / 3.0))
    assert one.evaluate(time, [0.01, FLAT], q)[0] == pytest.approx(expected, rel=1e-9)


def test_states_and_rates_mean_the_same_in_co_simulation(tmp_path: Path) -> None:
    """Over h the force rises by D: q = F - D tau / h (1 - exp(-h / tau)), q' = (F - q) / tau, dF/dq = -g."""
    g, tau, h = 0.2, 0.5, 0.1
    tire = tire_with(viscoelastic_relaxation={"share_1": g, "relaxation_time_1": tau})
    fmu = unpacked_archive(build_native_fmu(tire, tmp_path).path, tmp_path / "fmu")
    one = Unit(fmu, [0.01, FLAT], exchange=False)
    names = "viscoelastic_relaxation.relaxed_1", "der(viscoelastic_relaxation.relaxed_1)"
    assert values(one, *names) == pytest.approx([STIFFNESS * 0.01, 0.0], rel=1e-12, abs=1e-9)
    one.set([0.02, FLAT])
    # at once: the rubber has not relaxed yet
    assert values(one, *names) == pytest.approx([STIFFNESS * 0.01, STIFFNESS * 0.01 / tau], rel=1e-12)
    one.step(0.0, h)
    relaxed = STIFFNESS * (0.02 - 0.01 * tau / h * (1.0 - math.exp(-h / tau)))
    rate = (STIFFNESS * 0.02 - relaxed) / tau
    assert values(one, *names) == pytest.approx([relaxed, rate], rel=1e-12)
    assert one.get() == pytest.approx(STIFFNESS * 0.02 + g * tau * rate, rel=1e-12)
    state, slope = (one.names[name] for name in names)
    assert one.derivative(RADIAL_FORCE, [state], [1.0]) == pytest.approx(-g, rel=1e-6)
    assert one.derivative(slope, [state], [1.0]) == pytest.approx(-1.0 / tau, rel=1e-6)
    assert one.derivative(slope, [0], [1.0]) == pytest.approx(STIFFNESS / tau, rel=1e-6)


MODEL_EXCHANGE = """
fmi2GetTypesPlatform              |x |x |x |x |x
fmi2GetVersion                    |x |x |x |x |x
fmi2SetDebugLogging               |x |x |x |x |x
fmi2SetupExperiment               |x |  |  |  |
fmi2EnterInitializationMode       |x |  |  |  |
fmi2ExitInitializationMode        |  |x |  |  |
fmi2Terminate                     |  |  |x |x |
fmi2Reset                         |x |x |x |x |x
fmi2GetReal                       |  |2 |x |x |x
fmi2GetInteger                    |  |2 |x |x |x
fmi2GetBoolean                    |  |2 |x |x |x
fmi2GetString                     |  |2 |x |x |x
fmi2SetReal                       |1 |3 |4 |5 |
fmi2SetInteger                    |1 |3 |4 |  |
fmi2SetBoolean                    |1 |3 |4 |  |
fmi2SetString                     |1 |3 |4 |  |
fmi2GetFMUstate                   |x |x |x |x |x
fmi2SetFMUstate                   |x |x |x |x |x
fmi2FreeFMUstate                  |x |x |x |x |x
fmi2SerializedFMUstateSize        |x |x |x |x |x
fmi2SerializeFMUstate             |x |x |x |x |x
fmi2DeSerializeFMUstate           |x |x |x |x |x
fmi2GetDirectionalDerivative      |  |x |x |x |x
fmi2EnterEventMode                |  |  |x |x |
fmi2NewDiscreteStates             |  |  |x |  |
fmi2EnterContinuousTimeMode       |  |  |x |  |
fmi2CompletedIntegratorStep       |  |  |  |x |
fmi2SetTime                       |  |  |8 |x |
fmi2SetContinuousStates           |  |  |9 |x |
fmi2GetEventIndicators            |  |x |x |x |x
fmi2GetContinuousStates           |  |x |x |x |x
fmi2GetDerivatives                |  |x |x |x |x
fmi2GetNominalsOfContinuousStates |x |x |x |x |x
"""
"""FMI 2.0.5, section 3.2.3, whole. 5: of inputs alone; parameters are taken too, since CasADi sets them there.
8: of a unit that has no continuous time; taken here, which harms nobody.
9: not in the standard; OpenModelica does so."""


def test_each_call_in_each_state(run_host: Callable[..., str], tmp_path: Path) -> None:
    fmu = build_native_fmu(TireModel(), tmp_path).path
    printed: dict[str, Any] = json.loads(run_host("in_each_state.py", fmu, job=None))
    for kind in ("CoSimulation", "ModelExchange"):
        for name, by_state in printed[f"{kind}, calls of the other"].items():
            for state, (status, message) in by_state.items():
                assert (status, "is not allowed in the state" in message) == (3, True), (kind, name, state)
    answers = printed["ModelExchange"]
    states = ("instantiated", "initialization", "event", "continuous", "terminated")
    lines = [line.removeprefix("fmi2").split("|") for line in MODEL_EXCHANGE.strip().splitlines()]
    assert {name.strip() for name, *_ in lines} == set(answers)
    for name, *marks in lines:
        for state, mark in zip(states, marks, strict=True):
            status, message = answers[name.strip()][state]
            refused = "is not allowed in the state" in message
            assert refused == (not mark.strip()), (name, state, message)
            assert status == (3 if refused else 0), (name, state, message)
