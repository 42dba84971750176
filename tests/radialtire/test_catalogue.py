"""What must hold for every effect of the catalogue, the next one included."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pint
import pytest
from driving import channels_for, converges, drive, sine, tire_with
from hypothesis import given, settings
from hypothesis import strategies as st
from radialtire import (
    CATALOGUE,
    CHANNELS,
    Effect,
    Instant,
    Parameter,
    PowerLaw,
    State,
    TireModel,
    read_tire,
    write_tire,
)
from radialtire.effect import PLACES

EFFECTS = pytest.mark.parametrize("effect", CATALOGUE.values(), ids=CATALOGUE.keys())

REGISTRY = pint.UnitRegistry()

QUANTITY_UNITS = {
    "1": "1",
    "force": "N",
    "travel": "m",
    "gauge": "m",
    "duration": "s",
    "interval": "s",
    "rate": "m/s",
    "acceleration": "m/s^2",
    "pressure": "Pa",
    "temperature": "K",
}
"""Units of the quantities with which a prior scales."""

ABSOLUTE = {"lag", "delay", "mass"}
"""Parameters with a usual size of their own: filters of an amplifier, and a fixture in proportion to the force."""

ISSUE = {
    "deflection_offset",
    "force_offset",
    "rate_independent_hysteresis",
    "viscous_damping",
    "viscoelastic_relaxation",
    "series_compliance",
    "gas_compression",
    "inflation_pressure",
    "bottoming",
    "mullins_softening",
    "pressure_leak",
    "warm_up",
    "inertia",
    "force_lag",
    "saturation",
}
"""Physics that the project set out to name."""


def quantity(unit: str) -> Any:
    """Return one of a unit; of "1", pint 0.24, the last for Python 3.10, makes a plain number."""
    return REGISTRY.Quantity(REGISTRY(unit))


@EFFECTS
def test_a_prior_scales_with_the_recording_as_the_unit_of_its_parameter_does(effect: Effect) -> None:
    """A fibre of micrometres and a column of meganewtons have the same priors, in proportion."""
    for parameter in effect.parameters:
        if parameter.prior is None or parameter.name in ABSOLUTE:
            continue
        above, _, below = parameter.prior.scale.partition("/")
        scale = quantity(QUANTITY_UNITS[above]) / quantity(QUANTITY_UNITS[below or "1"])
        assert quantity(parameter.unit.replace(".", "*")).dimensionality == scale.dimensionality, (
            parameter.name
        )


@EFFECTS
def test_a_force_may_be_that_of_any_part(effect: Effect) -> None:
    """From a fibre to a building: forces are allowed up to a giganewton at least."""
    for parameter in effect.parameters:
        if parameter.unit == "N":
            assert parameter.maximum >= 1e9, parameter.name


def within(parameter: Parameter) -> st.SearchStrategy[float]:
    """Any value of the parameter, small ones as likely as large ones."""
    low, high = parameter.minimum, parameter.maximum
    if low > 0.0:
        return st.floats(math.log(low), math.log(high)).map(lambda u: min(max(math.exp(u), low), high))
    wide = st.floats(low, high)
    small = st.floats(-25.0, 0.0).map(lambda u: min(max(high * math.exp(u), low), high))
    return st.one_of(wide, small, st.just(parameter.start))


def any_values(effect: Effect) -> st.SearchStrategy[State]:
    return st.tuples(*(within(parameter) for parameter in effect.parameters))


@st.composite
def motions(draw: st.DrawFn, count: int = 25) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times of uneven spacing, deflections with lift-off, and surfaces that change."""
    steps = draw(st.lists(st.floats(1e-4, 0.5), min_size=count, max_size=count))
    x = draw(st.lists(st.floats(-0.005, 0.04), min_size=count, max_size=count))
    R = draw(st.lists(st.sampled_from([0.0127, 0.3, math.inf, -0.4]), min_size=count, max_size=count))
    return np.cumsum(steps), np.array(x), np.array(R)


def test_every_effect_that_was_asked_for_is_there() -> None:
    assert CATALOGUE.keys() >= ISSUE


def test_effects_stand_in_the_order_of_the_signals_way() -> None:
    order = [PLACES.index(effect.place) for effect in CATALOGUE.values()]
    assert order == sorted(order)


@EFFECTS
def test_only_what_is_said_to_rest_or_to_be_slow_moves_the_force_in_a_hold(effect: Effect) -> None:
    """A ramp of half a second to 15 mm, and a hold: half a second later filters have settled, to 1e-6 of the force."""
    values = [p.start if p.nominal is None else p.nominal for p in effect.parameters]
    time = np.linspace(0.0, 6.0, 6001)
    force = drive(tire_with((effect.name, values)), time, 0.015 * np.minimum(2.0 * time, 1.0))
    moved = float(np.ptp(force[time >= 1.0])) > 1e-6 * float(force.max())
    assert moved == ("rest" in effect.traits) or "slow" in effect.traits


@EFFECTS
def test_it_is_described(effect: Effect) -> None:
    assert effect.name in CATALOGUE
    assert effect.respond.__module__ == f"radialtire.effects.{effect.name}"
    assert len(effect.source) > 20
    for sentence in (effect.statement, effect.tell_tale, effect.source):
        assert not sentence.endswith(".")
    # The law's own shape is no effect that a verdict names: the refitted law has a look-alike of its own.
    assert (effect.look_alike is None) == (effect.place == "law")
    if effect.look_alike is not None:
        for sentence in (effect.look_alike.what, effect.look_alike.check):
            assert len(sentence) > 10
            assert sentence == sentence.strip(" .")
    assert effect.imitators
    for other in effect.imitators:
        assert other != effect.name
        assert other == "recalibration" or other in CATALOGUE


@EFFECTS
def test_its_parameters_are_described(effect: Effect) -> None:
    names = [parameter.name for parameter in effect.parameters]
    assert len(set(names)) == len(names)
    assert any(parameter.neutral is not None for parameter in effect.parameters)
    for parameter in effect.parameters:
        assert parameter.name.isidentifier()
        assert parameter.name.islower()
        assert parameter.symbol
        assert parameter.unit
        assert len(parameter.meaning) > 10
        assert parameter.minimum < parameter.maximum
        for value in (parameter.start, parameter.nominal_value):
            assert parameter.checked(value) == value
        if parameter.neutral is not None:
            assert parameter.start == parameter.checked(parameter.neutral)
    assert effect.nominal != effect.neutral


@EFFECTS
def test_its_state_at_rest_is_plain_numbers_of_a_fixed_count(effect: Effect) -> None:
    assert all(type(value) is float for value in effect.initial_state)
    instant = Instant(0.0, 0.0, True, 0.01, 0.1, 1.0, 550.9, 1.422, 550.9)
    _, state = effect.respond(1.0, instant, effect.initial_state, effect.nominal)
    assert len(state) == len(effect.initial_state)
    assert type(state) is tuple


@EFFECTS
@given(data=st.data())
@settings(max_examples=25, deadline=None)
def test_off_equals_the_bare_law_exactly(effect: Effect, data: st.DataObject) -> None:
    # whatever the parameters that have no off value are
    others = data.draw(any_values(effect))
    values = [
        other if parameter.neutral is None else parameter.neutral
        for other, parameter in zip(others, effect.parameters, strict=True)
    ]
    time, x, R = data.draw(motions())
    bare = drive(TireModel(), time, x, R)
    for channels in ({}, channels_for(effect, time)):
        assert np.array_equal(drive(tire_with((effect.name, values)), time, x, R, **channels), bare)


@EFFECTS
def test_on_changes_the_force(effect: Effect) -> None:
    time, x = sine(0.5, 0.012, 0.015, 3.0, 300)
    bare = drive(TireModel(), time, x)
    force = drive(tire_with((effect.name, effect.nominal)), time, x, **channels_for(effect, time))
    assert np.max(np.abs(force - bare)) > 1e-4 * np.max(bare)


@EFFECTS
def test_an_effect_that_needs_a_channel_does_nothing_without_it(effect: Effect) -> None:
    if effect.reads is None or effect.reads.reference is None:
        return
    assert effect.reads.reference in [parameter.name for parameter in effect.parameters]
    time, x = sine(0.5, 0.012, 0.015, 3.0, 300)
    assert np.array_equal(
        drive(tire_with((effect.name, effect.nominal)), time, x), drive(TireModel(), time, x)
    )


@EFFECTS
def test_its_place_says_how_it_changes_a_signal(effect: Effect) -> None:
    """A factor multiplies whatever it is given, and what acts beside the law adds to it: `simulate` relies on it."""
    first = Instant(0.0, 0.0, True, 0.012, 0.3, 5.0, 550.9, 1.422, 700.0, 2.0, 4e5, 310.0)
    later = first._replace(
        time=3.0, interval=0.1, first=False, deflection=0.004, rate=-0.2, elastic_force=150.0
    )
    _, state = effect.respond(0.0, first, effect.initial_state, effect.nominal)
    none, one, many = (effect.respond(s, later, state, effect.nominal)[0] for s in (0.0, 1.0, 250.0))
    if effect.place == "scale":
        assert none == 0.0
        assert many == pytest.approx(250.0 * one, rel=1e-12)
    elif effect.place == "parallel":
        assert one == pytest.approx(none + 1.0, rel=1e-12)
        assert many == pytest.approx(none + 250.0, rel=1e-12)


@EFFECTS
def test_it_names_channels_that_there_are(effect: Effect) -> None:
    names = {channel.name for channel in CHANNELS}
    assert {*effect.changes, *([effect.reads.channel] if effect.reads else [])} <= names


@EFFECTS
@given(data=st.data())
@settings(max_examples=30, deadline=None)
def test_it_is_finite_over_its_bounds(effect: Effect, data: st.DataObject) -> None:
    tire = tire_with(
        (effect.name, data.draw(any_values(effect))), reading_noise=data.draw(st.floats(0.0, 0.01))
    )
    time, x, R = data.draw(motions())
    assert np.all(np.isfinite(drive(tire, time, x, R)))
    assert np.all(np.isfinite(drive(tire, time, x, R, **channels_for(effect, time))))


@EFFECTS
def test_finer_steps_converge(effect: Effect) -> None:
    # second order, but for the acceleration, which the filter follows to first order; less 0.3 for turning points
    # that fall between two moments; 1e-5 of the peak is what a delay's kept moments leave
    tire = tire_with((effect.name, effect.nominal))
    order = 0.8 if effect.name == "inertia" else 1.7

    def force(count: int) -> np.ndarray:
        time = np.linspace(0.0, 1.0, count + 1)
        x = 0.013 + 0.008 * np.sin(12.0 * time) - 0.004 * np.cos(5.0 * time)
        return drive(tire, time, x, **channels_for(effect, time))

    assert converges(force, order, 250)


@EFFECTS
@given(data=st.data())
@settings(max_examples=10, deadline=None)
def test_a_saved_state_continues_identically(effect: Effect, data: st.DataObject) -> None:
    tire = tire_with((effect.name, data.draw(any_values(effect))))
    time, x, R = data.draw(motions())
    state = tire.initial_state
    moments = list(zip(x.tolist(), R.tolist(), time.tolist(), strict=True))
    half = time.size // 2
    for moment in moments[:half]:
        _, state = tire.step(*moment, state)
    saved = json.dumps(state)
    for _ in range(2):
        again = tuple(json.loads(saved))
        forces = []
        for moment in moments[half:]:
            force, again = tire.step(*moment, again)
            forces.append(force)
        assert np.array_equal(forces, drive(tire, time, x, R)[half:])


@EFFECTS
@given(data=st.data())
@settings(max_examples=10, deadline=None)
def test_the_same_question_has_the_same_answer(effect: Effect, data: st.DataObject) -> None:
    tire = tire_with((effect.name, data.draw(any_values(effect))))
    state = tire.initial_state
    # plain floats, as in the FMU: numpy's warn where a denormal time constant divides
    for t, x, R in zip(*(channel.tolist() for channel in data.draw(motions())), strict=True):
        answer = tire.step(x, R, t, state)
        tire.step(x + 1e-3, R, t + 0.1, state)
        assert tire.step(x, R, t, state) == answer
        state = answer[1]


@EFFECTS
@given(data=st.data())
@settings(max_examples=10, deadline=None)
def test_a_tire_file_keeps_it_exactly(effect: Effect, data: st.DataObject, tmp_path_factory: object) -> None:
    folder: Path = tmp_path_factory.mktemp("tire")  # type: ignore[attr-defined]
    tire = tire_with((effect.name, data.draw(any_values(effect))))
    write_tire(tire, folder / "tire.json")
    assert read_tire(folder / "tire.json") == tire


@EFFECTS
@given(data=st.data())
@settings(max_examples=20, deadline=None)
def test_it_looks_at_rates_only_if_it_says_so(effect: Effect, data: st.DataObject) -> None:
    values = data.draw(any_values(effect)) if not effect.differentiates else effect.nominal
    slow = Instant(1.0, 0.01, False, 0.02, 0.0, 0.0, 550.9, 1.422, 1400.0)
    fast = slow._replace(rate=data.draw(st.floats(0.1, 5.0)), acceleration=data.draw(st.floats(1.0, 500.0)))
    signal = data.draw(st.floats(1e-3, 2.0))
    same = effect.respond(signal, slow, effect.initial_state, values) == effect.respond(
        signal, fast, effect.initial_state, values
    )
    assert same is not effect.differentiates


def test_one_effect_holds_the_gap_of_a_part() -> None:
    (gap,) = [effect for effect in CATALOGUE.values() if effect.holds_gap]
    tire = TireModel(PowerLaw(100.0, 1.0), ((gap, (-0.002,)),), inflated=False)
    assert tire.tire_deflection(0.005, math.inf, 0.0, tire.initial_state) == pytest.approx(0.003)
