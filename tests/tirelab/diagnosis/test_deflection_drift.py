"""A zero of the deflection that drifts is told from a leak, a warming tire and a zero of the force that drifts."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import TireModel
from tirelab import Recording, diagnose

NOISE = 2.0
TIME = np.arange(0.0, 120.0, 0.02)
DEFLECTION = 1e-3 * np.interp(TIME % 20.0, [0.0, 6.0, 8.0, 14.0, 20.0], [1.0, 18.0, 18.0, 4.0, 1.0])


def pressed(shift: np.ndarray, gain: np.ndarray, zero: np.ndarray) -> Recording:
    """The default tire's law, written here, of a deflection [m] that is shifted, with a gain and a zero [N]."""
    A, B = TireModel().law.coefficients(np.inf)
    noise = np.random.default_rng(3).normal(0.0, NOISE, TIME.size)
    force = gain * A * (100.0 * np.maximum(DEFLECTION + shift, 0.0)) ** B + zero + noise
    return Recording.from_arrays(TIME, DEFLECTION, force, "flat")


PART = TIME / TIME[-1]
"""Time as a part of the recording."""

DRIFTS = {
    "deflection_drift": pressed(-6e-4 * PART, np.ones(TIME.size), np.zeros(TIME.size)),
    "pressure_leak": pressed(np.zeros(TIME.size), np.exp(-0.06 * PART), np.zeros(TIME.size)),
    "force_drift": pressed(np.zeros(TIME.size), np.ones(TIME.size), -40.0 * PART),
}
"""Three that lower the force with time: by its tangent, in proportion to it, and by as much everywhere."""


@pytest.mark.slow
@pytest.mark.parametrize("name", DRIFTS)
def test_what_lowers_the_force_with_time_is_told_by_where(name: str) -> None:
    verdict = diagnose([DRIFTS[name]], TireModel())
    assert verdict.names == (name,)
    assert verdict.confidence > 0.9


@pytest.mark.slow
def test_a_drift_is_named_with_its_rate() -> None:
    ((effect, values),) = diagnose([DRIFTS["deflection_drift"]], TireModel()).tire.effects
    assert effect.name == "deflection_drift"
    # 600 um in 120 s; a noise of 2 N over 6000 samples at 1e5 N/m is 0.3 um of them.
    assert values[0] == pytest.approx(-6e-4 / TIME[-1], rel=0.01)
    assert values[1] == 0.0


@pytest.mark.slow
def test_what_settles_settles_in_the_tire_that_is_delivered() -> None:
    """Within a third of the recording; what is over sooner is unusual by its prior."""
    settling = -8e-4 * (1.0 - np.exp(-TIME / 40.0))
    recording = pressed(settling, np.ones(TIME.size), np.zeros(TIME.size))
    verdict = diagnose([recording], TireModel())
    ((effect, values),) = verdict.tire.effects
    assert effect.name == "deflection_drift"
    assert values[0] / values[1] == pytest.approx(-8e-4, rel=0.01)
    assert values[1] == pytest.approx(1.0 / 40.0, rel=0.05)
