"""The engine knows no effect: one that the catalogue does not hold is found once it is declared."""

import math

import numpy as np
import pytest
from radialtire import CATALOGUE, Effect, Instant, Parameter, PowerLaw, Prior, State, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """A tread that blocks up beyond a force."""
    share, onset = values
    return signal + share * max(instant.elastic_force - onset, 0.0), state


TREAD = Effect(
    name="tread_blocking",
    place="parallel",
    parameters=(
        Parameter(
            "share",
            "s",
            "1",
            0.0,
            0.0,
            10.0,
            "stiffening",
            neutral=0.0,
            role="strength",
            prior=Prior("log", 0.2, math.log(4)),
        ),
        Parameter(
            "onset", "Fb", "N", 500.0, 1.0, 1e5, "force", prior=Prior("log", 0.5, math.log(1.7), "force")
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the tread blocks up beyond a force",
    tell_tale="a knee at one force on every surface",
    imitators=(),
    source="made up",
    traits=("static", "localized"),
    form_error=0.001,  # the recording below is made by this very form
)


@pytest.mark.slow
def test_effect_outside_the_catalogue_is_found_once_it_is_declared(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(CATALOGUE, TREAD.name, TREAD)
    time = np.linspace(0.0, 60.0, 1500)
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * time / 20.0))
    elastic = 550.0 * (100.0 * x) ** 1.42
    force = elastic + 0.3 * np.maximum(elastic - 700.0, 0.0)
    force += np.random.default_rng(4).normal(0.0, 4.0, time.size)
    recording = Recording("tread", time, x, np.full(time.size, np.inf), force)
    found = diagnose([recording], TireModel(PowerLaw(550.0, 1.42), tested_range=None))
    assert [e.name for e in found.effects] == [TREAD.name]
    values = found.effects[0].parameters
    assert values["share"].value == pytest.approx(0.3, rel=0.05)
    assert values["onset"].value == pytest.approx(700.0, rel=0.05)
