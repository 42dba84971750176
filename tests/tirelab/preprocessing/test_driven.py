"""Shapes that a misfit may have over a motion, and visits of the same place."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tirelab.preprocessing.driven import Driven

FloatArray = NDArray[np.float64]

PERIOD = 200
TRIANGLES = 0.02 * np.abs(np.arange(4 * PERIOD) % PERIOD / (PERIOD / 2) - 1.0)
"""Four cycles between 20 mm and 0."""


def driven(deflection: FloatArray) -> Driven:
    rate = np.gradient(deflection)
    surface = np.zeros(deflection.size, dtype=np.intp)
    return Driven(1.0, deflection, rate, np.gradient(rate), surface)


def left_of(force: FloatArray, columns: FloatArray) -> float:
    """Return the part of a force that columns and a constant do not follow."""
    columns = np.column_stack([columns / np.abs(columns).max(axis=0), np.ones(force.size)])
    fitted = columns @ np.linalg.lstsq(columns, force, rcond=None)[0]
    return float(np.std(force - fitted) / np.std(force))


@pytest.mark.parametrize("name", ["stop", "friction", "knee after the turn"])
def test_shapes_follow_what_is_a_function_of_a_place(name: str) -> None:
    """Straight lines between ten places follow a curve of one bend to a hundredth, a kink to a step between them."""
    way = np.where(np.gradient(TRIANGLES) > 0.0, 1.0, -1.0)
    turned = np.where(way > 0.0, TRIANGLES, 0.02 - TRIANGLES)
    force = {
        "stop": np.maximum(TRIANGLES - 0.0171, 0.0),
        "friction": way * TRIANGLES**1.3,
        "knee after the turn": way * (1.0 - 2.0 * np.exp(-turned / 3e-3)),
    }[name]
    assert left_of(force, driven(TRIANGLES).shapes(1)) < 0.12


def test_shapes_do_not_follow_what_no_place_has() -> None:
    """White noise: thirty of 800 coefficients take little of its power."""
    noise = np.random.default_rng(1).normal(size=TRIANGLES.size)
    assert left_of(noise, driven(TRIANGLES).shapes(1)) > 0.9


def test_visits_pair_samples_of_one_place_in_other_cycles() -> None:
    kinds = list(driven(TRIANGLES).visits(2))
    assert len(kinds) == 3
    for number, (one, other, sign) in enumerate(kinds):
        assert np.all(np.abs(one - other) > 8)
        # Half the path of two samples: a hundredth of the 20 mm.
        if number < 2:
            assert np.all(np.abs(TRIANGLES[one] - TRIANGLES[other]) <= 2.0001e-4)
        if number > 0:
            assert np.all(sign == 1.0)
    assert np.any(kinds[0][2] == -1.0)


def test_visits_of_other_surfaces_are_not_of_one_place() -> None:
    surface = np.repeat([0, 1], 2 * PERIOD)
    whole = driven(TRIANGLES)
    apart = Driven(1.0, whole.deflection, whole.rate, whole.acceleration, surface)
    for one, other, _ in apart.visits(2):
        assert one.size > 0
        assert np.all(surface[one] == surface[other])
