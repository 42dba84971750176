"""The law over curvature: exact at its surfaces, straight between them, constant beyond them."""

from __future__ import annotations

import math
from itertools import permutations
from pathlib import Path

import pytest
from radialtire import ParameterError, PowerLaw, TireModel, read_tire, write_tire
from radialtire.curvature_law import SURFACES_MAX, CurvatureLaw

SURFACES = ((-2.0, 700.0, 1.5), (0.0, 550.0, 1.4), (10.0, 350.0, 1.2))


def test_it_passes_through_its_surfaces_in_whatever_order_they_come() -> None:
    for order in permutations(SURFACES):
        law = CurvatureLaw.through(order)
        assert law.coefficients(-0.5) == (700.0, 1.5)
        assert law.coefficients(math.inf) == (550.0, 1.4)
        assert law.coefficients(0.1) == (350.0, 1.2)


def test_it_is_straight_in_the_curvature_between_two_surfaces() -> None:
    # R = 0.2 m is 5 1/m, half way from flat to 10 1/m; R = -1 m is half way from -2 1/m to flat
    law = CurvatureLaw.through(SURFACES)
    assert law.coefficients(0.2) == pytest.approx((450.0, 1.3), rel=1e-15)
    assert law.coefficients(-1.0) == pytest.approx((625.0, 1.45), rel=1e-15)


def test_it_extrapolates_nothing() -> None:
    law = CurvatureLaw.through(SURFACES)
    assert law.coefficients(1e-6) == (350.0, 1.2)
    assert law.coefficients(-1e-6) == (700.0, 1.5)


def test_one_surface_is_the_power_law() -> None:
    law = CurvatureLaw.through([(4.0, 718.5, 1.4)])
    for radius in (0.01, 0.25, math.inf, -0.4):
        assert law.coefficients(radius) == PowerLaw(718.5, 1.4).coefficients(radius)


def test_very_flat_counts_as_flat() -> None:
    assert CurvatureLaw.through(SURFACES).coefficients(-2e5) == (550.0, 1.4)


def test_a_tire_file_gives_it_back_exactly(tmp_path: Path) -> None:
    tire = TireModel(law=CurvatureLaw.through(SURFACES), name="three surfaces", source="a test")
    write_tire(tire, tmp_path / "tire.json")
    assert read_tire(tmp_path / "tire.json") == tire


def test_surfaces_out_of_order_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"curvatures must rise, but 0 1/m follows 1 1/m"):
        CurvatureLaw(curvature_1=1.0, curvature_2=0.0, coefficient_2=500.0)


@pytest.mark.parametrize("count", [0, SURFACES_MAX + 1])
def test_no_surface_and_too_many_are_refused(count: int) -> None:
    with pytest.raises(ParameterError, match="the law holds 1 to 6"):
        CurvatureLaw.through([(float(i), 500.0, 1.4) for i in range(count)])


def test_a_value_outside_its_bounds_is_refused() -> None:
    with pytest.raises(ParameterError, match="exponent_1 = 0 is not allowed"):
        CurvatureLaw(exponent_1=0.0)
