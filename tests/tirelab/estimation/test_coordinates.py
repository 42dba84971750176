"""A remainder depends on no coordinate that the recordings do not show."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from tirelab.estimation.coordinates import coordinates_of
from tirelab.estimation.explanation import explain_misfit
from tirelab.recordings.recording import Recording

TIRE = TireModel(PowerLaw(718.5, 1.4), tested_range=None)


def pressed(triangle: bool) -> Recording:
    """Three cycles of 20 s with a bump of 40 N over the deflection, in five decimals of a millimetre."""
    time = 0.01 * np.arange(6000)
    phase = time / 20.0 % 1.0
    x = 0.02 * (1.0 - np.abs(2.0 * phase - 1.0)) if triangle else 0.01 * (1.0 - np.cos(2.0 * np.pi * phase))
    x = np.round(x, 8)
    force = 718.5 * (100.0 * x) ** 1.4 + 40.0 * np.exp(-(((x - 0.01) / 0.002) ** 2))
    force += np.random.default_rng(2).normal(0.0, 1.0, time.size)
    return Recording("press", time, x, np.full(time.size, np.inf), force)


@pytest.mark.parametrize("triangle", [True, False])
def test_the_acceleration_of_a_triangle_is_none(triangle: bool) -> None:
    found = explain_misfit([pressed(triangle)], TIRE, ("recalibration",), lambda stage: None)
    names = list(coordinates_of(found.model.fit.problem.dataset))
    assert ("acceleration" in names) is not triangle
    assert names[:2] == ["deflection", "rate"]
