"""Laws on one row of numbers: the same coefficients as the laws themselves."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from radialtire import PowerLaw, Recalibrated
from radialtire.curvature_law import CurvatureLaw
from radialtire.flat_law import coefficients, laid_out
from radialtire.hull1996 import Hull1996

FLAT = float("inf")
LAWS = (
    Hull1996(),
    PowerLaw(400.0, 1.3),
    CurvatureLaw(),
    Recalibrated(PowerLaw(400.0, 1.3), ((FLAT, 0.1, -0.02), (0.1, -0.2, 0.03))),
    Recalibrated(Recalibrated(Hull1996(), ((0.0254, 0.3, 0.0),)), ((FLAT, 0.1, 0.05), (-0.5, 0.0, 0.1))),
)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("radius", [0.0127, 0.0254, 0.2, FLAT, -0.381, -2.0])
def test_a_row_has_the_coefficients_of_its_law(law: object, radius: float) -> None:
    assert coefficients(laid_out(law), radius) == law.coefficients(radius)  # type: ignore[arg-type, attr-defined]


def test_a_law_without_a_row_is_refused_by_name() -> None:
    @dataclass(frozen=True)
    class Cubic:
        name = "cubic"

    with pytest.raises(TypeError, match="cubic"):
        laid_out(Cubic())  # type: ignore[arg-type]
