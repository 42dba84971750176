"""Presses at three pressures: with the channel the pressure is named and its gain found, without it nothing is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from rivals import rivals
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording
from tirelab.simulation.simulate import simulate

REFERENCE, SHARE = 2.6e5, 0.75
LAW = TireModel(PowerLaw(550.9, 1.422), tested_range=None)


def pressed(pressure: float, seed: int) -> Recording:
    """A press of 24 mm at a gauge pressure [Pa]: a casing that carries a quarter at the reference, and the air."""
    random = np.random.default_rng(seed)
    time = np.linspace(0.0, 40.0, 800)
    x = 0.012 * (1.0 - np.cos(0.2 * np.pi * time))
    force = 550.9 * (100.0 * x) ** 1.422 * ((1.0 - SHARE) + SHARE * pressure / REFERENCE)
    gauge = pressure + random.normal(0.0, 200.0, time.size)
    return Recording(
        f"{pressure / 1e5:g} bar",
        time,
        x,
        np.full(time.size, np.inf),
        force + random.normal(0.0, 4.0, time.size),
        pressure=gauge,
    )


RECORDINGS = [pressed(p, i) for i, p in enumerate((2.0e5, 2.6e5, 3.2e5))]


def test_the_pressure_is_named_and_a_pressure_that_was_not_recorded_is_foretold() -> None:
    found = diagnose(RECORDINGS, LAW, catalogue=rivals("inflation_pressure"))
    assert [e.name for e in found.effects] == ["inflation_pressure"]
    values = found.effects[0].parameters
    assert values["gain"].value == pytest.approx(SHARE, rel=0.05)
    assert values["reference"].value == pytest.approx(REFERENCE, rel=0.02)
    other = pressed(2.3e5, 9)
    assert float(np.sqrt(np.mean((other.force - simulate(found.tire, other)) ** 2))) < 6.0


@pytest.mark.slow
def test_without_the_channel_nothing_is_said_of_the_pressure() -> None:
    without = [replace(r, pressure=None) for r in RECORDINGS]
    found = diagnose(without, LAW, catalogue=["inflation_pressure", "recalibration"])
    sets = [found.names, *(alternative.names for alternative in found.alternatives)]
    assert all("inflation_pressure" not in names for names in sets)
    assert "inflation" not in found.summary
