"""A law that is no power of the deflection: bend and twist in ln x, and straight lines between heights in x."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import drive, only
from radialtire import CATALOGUE, TireModel

REFERENCE = 0.0125
X = np.linspace(0.0, 0.03, 601)
TIME = np.arange(601.0)
BARE = drive(TireModel(), TIME, X)


def logarithm(**changed: float) -> np.ndarray:
    """ln of the factor on the law at all deflections but 0."""
    force = drive(only("elastic_shape", reference=REFERENCE, **changed), TIME, X)
    return np.asarray(np.log(force[1:] / BARE[1:]))


def test_bend_and_twist_are_a_polynomial_of_the_logarithm() -> None:
    way = np.log(np.maximum(X[1:] / REFERENCE, 0.01))
    np.testing.assert_allclose(logarithm(bend=0.05, twist=-0.01), 0.05 * way**2 - 0.01 * way**3, atol=1e-12)


def test_between_the_heights_are_straight_lines_and_beyond_them_the_last_one() -> None:
    rng = np.random.default_rng(0)
    heights = dict(
        zip((f"height_{i}" for i in range(1, 11)), rng.uniform(-0.3, 0.3, 10).tolist(), strict=True)
    )
    places = 0.2 * REFERENCE * np.arange(1, 11)
    np.testing.assert_allclose(
        logarithm(bend=1e-300, **heights), np.interp(X[1:], places, list(heights.values())), atol=1e-12
    )


@pytest.mark.parametrize("number", range(1, 11))
def test_each_height_is_at_the_place_that_it_states(number: int) -> None:
    (parameter,) = [p for p in CATALOGUE["elastic_shape"].parameters if p.name == f"height_{number}"]
    assert parameter.meaning == f"change of ln F at {0.2 * number:g} times the reference deflection"
    force = drive(
        only("elastic_shape", reference=REFERENCE, **{parameter.name: 0.1}), [0.0], [0.2 * number * REFERENCE]
    )
    bare = drive(TireModel(), [0.0], [0.2 * number * REFERENCE])
    assert math.log(force[0] / bare[0]) == pytest.approx(0.1, rel=1e-9)
