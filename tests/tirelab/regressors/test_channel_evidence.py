"""What the channels show of simulated presses: leak, compressed air and set pressures told apart before any fit."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.regressors.excitation import Excitation, excitation_of

FloatArray = NDArray[np.float64]
LAW = TireModel(PowerLaw(550.9, 1.422), tested_range=None)
SET = 3e5


def pressed(
    pressure: FloatArray | None, *, temperature: FloatArray | None = None, name: str = "press"
) -> Recording:
    """A press of 1 min, 6 cycles of 24 mm, whose force is in proportion to the pressure."""
    time = np.linspace(0.0, 60.0, 1500)
    x = 0.012 * (1.0 - np.cos(0.2 * np.pi * time))
    air = np.ones_like(time) if pressure is None else pressure / SET
    force = 550.9 * (100.0 * x) ** 1.422 * air + np.random.default_rng(3).normal(0.0, 4.0, time.size)
    flat = np.full(time.size, np.inf)
    return Recording(name, time, x, flat, force, pressure=pressure, temperature=temperature)


def shown(*recordings: Recording) -> Excitation:
    return excitation_of(dataset_of(recordings, LAW))


TIME = np.linspace(0.0, 60.0, 1500)
DEPTH = 0.012 * (1.0 - np.cos(0.2 * np.pi * TIME)) / 0.024
GAUGE = np.random.default_rng(5).normal(0.0, 100.0, TIME.size)


def test_without_a_channel_nothing_that_needs_it_can_be() -> None:
    found = shown(pressed(None))
    assert found.channels.impossible == {"inflation_pressure"}
    assert not found.channels.unvaried


def test_a_constant_pressure_refutes_what_would_change_it() -> None:
    found = shown(pressed(SET + GAUGE))
    assert {"pressure_leak", "gas_compression", "warm_up"} <= found.channels.impossible
    assert "was the same" in found.hidden("inflation_pressure")


@pytest.mark.parametrize(
    ("course", "right", "wrong"),
    [
        (-0.05 * TIME / 60.0, "pressure_leak", {"gas_compression", "warm_up"}),
        (0.03 * DEPTH**2.4, "gas_compression", {"pressure_leak", "warm_up"}),
        (0.04 * (1.0 - np.exp(-TIME / 20.0)), "warm_up", {"pressure_leak", "gas_compression"}),
    ],
    ids=["falls with time", "rises with the deflection", "rises to a level"],
)
def test_the_course_of_the_pressure_tells_its_causes_apart(
    course: FloatArray, right: str, wrong: set[str]
) -> None:
    found = shown(pressed(SET * (1.0 + course) + GAUGE))
    assert right not in found.channels.impossible
    assert wrong <= found.channels.impossible
    # a pressure that only followed one of them was not set: its own gain is not shown
    assert found.hidden("inflation_pressure")


def test_a_pressure_that_swings_with_the_direction_is_no_setting() -> None:
    swing = 0.04 * np.sign(np.sin(0.2 * np.pi * TIME))
    found = shown(pressed(SET * (1.0 + swing) + GAUGE))
    assert found.hidden("inflation_pressure")


def test_recordings_at_two_pressures_show_what_the_pressure_does() -> None:
    found = shown(pressed(SET + GAUGE, name="a"), pressed(0.8 * SET + GAUGE, name="b"))
    assert not found.hidden("inflation_pressure")
    assert "inflation_pressure" not in found.channels.impossible


def test_a_tire_that_kept_its_temperature_has_not_warmed() -> None:
    still = np.full(TIME.size, 293.0)
    assert "temperature was the same" in shown(pressed(None, temperature=still)).hidden("warm_up")
    warming = 293.0 + 8.0 * TIME / 60.0
    assert not shown(pressed(None, temperature=warming)).hidden("warm_up")
