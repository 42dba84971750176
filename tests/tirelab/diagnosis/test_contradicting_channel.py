"""A channel that contradicts the force is told, and what it refutes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import TireModel
from tirelab.diagnosis.contradicting_channel import ContradictingChannel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.recordings.recording import Recording
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]

NAMES = ("warm_up", "pressure_leak", "mullins_softening", "rate_independent_hysteresis", "inflation_pressure")

TIME = np.arange(0.0, 60.0, 0.02)


def pressed(course: FloatArray) -> Recording:
    """Six cycles of 20 mm under 5 N of noise, the force in proportion to a course."""
    x = 0.02 * (1.0 - np.abs(2.0 * (TIME / 10.0 % 1.0) - 1.0))
    silent = Recording("press", TIME, x, np.full(TIME.size, np.inf), np.zeros(TIME.size))
    noise = 5.0 * np.random.default_rng(1).standard_normal(TIME.size)
    return replace(silent, force=course * simulate(TireModel(), silent) + noise)


def warming(temperature: FloatArray) -> Verdict:
    course = 1.0 + 0.05 * (1.0 - np.exp(-TIME / 20.0))
    return diagnose(replace(pressed(course), temperature=temperature), catalogue=NAMES)


@pytest.mark.slow
def test_the_temperature_of_a_room_contradicts_a_tire_that_warms() -> None:
    found = warming(293.0 + 0.05 * np.random.default_rng(2).standard_normal(TIME.size))
    channel = found.contradiction
    assert isinstance(channel, ContradictingChannel)
    assert (channel.channel, channel.effects, channel.refuted) == ("temperature", ("warm_up",), ("warm_up",))
    assert channel.without == pytest.approx(5.0, rel=0.05)
    assert found.summary.startswith("The channel temperature contradicts the force. Warm up explains all to")
    assert "--columns temperature=." in found.summary
    assert found.confidence <= 0.5
    assert all(effect.probability <= 0.5 for effect in found.effects)
    assert found.to_dict()["verdict"]["contradiction"]["channel"] == "temperature"


def test_a_temperature_that_rises_with_the_force_contradicts_nothing() -> None:
    found = warming(293.0 + 10.0 * (1.0 - np.exp(-TIME / 20.0)))
    assert found.contradiction is None
    assert [effect.name for effect in found.effects] == ["warm_up"]


LEAK = 1.0 - TIME / 600.0


def test_a_gauge_that_does_not_follow_a_leak_contradicts_the_force() -> None:
    pressure = 2e5 + 1e3 * np.random.default_rng(2).standard_normal(TIME.size)
    found = diagnose(replace(pressed(LEAK), pressure=pressure), catalogue=NAMES)
    assert isinstance(found.contradiction, ContradictingChannel)
    assert found.contradiction.refuted == ("pressure_leak",)


def test_beside_a_channel_that_contradicts_the_force_nothing_is_said_to_be_missing_where_nothing_is_named() -> (
    None
):
    pressure = 2e5 + 1e3 * np.random.default_rng(2).standard_normal(TIME.size)
    found = diagnose(
        replace(pressed(LEAK), pressure=pressure), catalogue=("pressure_leak", "viscous_damping")
    )
    assert isinstance(found.contradiction, ContradictingChannel)
    assert not found.effects
    # What is left of all, and what the confidence is a probability of, are all that is said beside it.
    sure = f"That the pressure is right and this is all that acts: {100.0 * found.confidence:.0f} %."
    assert sure in found.summary
    assert not any(other in found.summary for other in ("Left out", "alternatives", "No physics"))


def test_a_pressure_that_was_typed_in_refutes_no_leak() -> None:
    found = diagnose(replace(pressed(LEAK), pressure=np.full(TIME.size, 2e5)), catalogue=NAMES)
    assert [effect.name for effect in found.effects] == ["pressure_leak"]
    assert found.contradiction is None


@pytest.mark.slow
def test_what_was_recorded_before_a_held_out_part_is_taken_without_the_channel_too() -> None:
    course = 1.0 + 0.05 * (1.0 - np.exp(-TIME / 20.0))
    room = replace(
        pressed(course), temperature=293.0 + 0.05 * np.random.default_rng(2).standard_normal(TIME.size)
    )
    fitted, kept = (
        replace(
            room,
            **{
                c: getattr(room, c)[part]
                for c in ("time", "deflection", "surface_radius", "force", "temperature")
            },
        )
        for part in (slice(0, 2000), slice(2000, None))
    )
    found = diagnose(fitted, held_out=replace(kept, history=fitted), catalogue=NAMES)
    assert isinstance(found.contradiction, ContradictingChannel)
