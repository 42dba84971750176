"""F = A x^B and its tangent, against the article's figures and against logarithms."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from published import hull1996 as article
from radialtire import ParameterError, PowerLaw, power_law


def test_one_centimetre_gives_the_coefficient() -> None:
    assert power_law.force(0.01, 718.5, 1.4) == pytest.approx(718.5, rel=1e-15)


@given(st.floats(1e-6, 0.33), st.floats(1e-3, 1e4), st.floats(0.1, 5.0))
def test_force_is_straight_in_logarithms(x: float, A: float, B: float) -> None:
    # a second formulation: ln F = ln A + B ln(x / 1 cm); 20 ulps for the logarithms of numbers up to e^20
    assert math.log(power_law.force(x, A, B)) == pytest.approx(
        math.log(A) + B * math.log(x / 0.01), rel=0, abs=1e-13
    )


@given(st.floats(1e-6, 0.33), st.floats(1e-3, 1e4), st.floats(0.1, 5.0))
def test_stiffness_is_exponent_times_secant(x: float, A: float, B: float) -> None:
    # d(A x^B)/dx = B F / x, within a few roundings
    secant = power_law.force(x, A, B) / x
    assert power_law.stiffness(x, A, B) == pytest.approx(B * secant, rel=1e-12)


@pytest.mark.parametrize("x", [0.0, -1e-12, -1.0])
def test_a_tire_in_the_air_has_neither_force_nor_stiffness(x: float) -> None:
    assert power_law.force(x, 550.9, 1.422) == 0.0
    assert power_law.stiffness(x, 550.9, 1.422) == 0.0


def test_the_other_tire_is_the_start() -> None:
    law = PowerLaw()
    assert law.coefficients(0.3) == law.coefficients(-math.inf) == article.OTHER_TIRE


def test_the_road_tire_is_a_straight_spring() -> None:
    # 150 000 N/m, quoted from Wang and Hull
    law = PowerLaw(1500.0, 1.0)
    assert power_law.stiffness(0.004, *law.coefficients(math.inf)) == pytest.approx(150e3, rel=1e-15)


def test_values_outside_the_bounds_are_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"^exponent = 0 is not allowed; it must lie between 0\.1 and 10$"
    ):
        PowerLaw(exponent=0.0)


@given(st.floats(-0.01, 0.33), st.floats(1e-3, 1e4), st.floats(0.1, 5.0))
def test_the_force_on_one_surface_is_the_same_force(x: float, A: float, B: float) -> None:
    # ln F = ln A + B ln(x / 1 cm) again, and nothing for a tire that is not loaded
    force = power_law.on_surface(A, B)(x)
    if x <= 0.0:
        assert force == 0.0
    elif x > 1e-6:
        assert math.log(force) == pytest.approx(math.log(A) + B * math.log(x / 0.01), rel=0, abs=1e-13)
