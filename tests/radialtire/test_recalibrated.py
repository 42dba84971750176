"""A law recalibrated on measured surfaces."""

import math

import pytest
from radialtire import FLAT_RADIUS, Hull1996, ParameterError, Recalibrated, TireFileError, TireModel
from radialtire.recalibrated import changed_at
from radialtire.tirefile import from_text, to_text

BASE = Hull1996()
LAW = Recalibrated(BASE, ((0.2, 0.10, -0.02), (math.inf, 0.02, 0.01), (-0.5, -0.04, 0.0)))


@pytest.mark.parametrize("radius", [0.2, math.inf, -0.5])
def test_a_measured_surface_has_its_own_change(radius):
    A0, B0 = BASE.coefficients(radius)
    A, B = LAW.coefficients(radius)
    change, exponent = {0.2: (0.10, -0.02), math.inf: (0.02, 0.01), -0.5: (-0.04, 0.0)}[radius]
    assert pytest.approx(A0 * math.exp(change), rel=1e-12) == A
    assert pytest.approx(B0 + exponent, rel=1e-12) == B


def test_between_surfaces_the_change_is_straight_over_the_curvature():
    # 1/0.4 lies half way between 1/0.2 and flat.
    assert LAW.changes(0.4) == pytest.approx((0.06, -0.005), rel=1e-12)
    assert LAW.changes(FLAT_RADIUS) == LAW.changes(math.inf)


def test_beyond_the_measured_surfaces_the_change_is_held():
    assert LAW.changes(0.05) == pytest.approx((0.10, -0.02), rel=1e-12)
    assert LAW.changes(-0.3) == pytest.approx((-0.04, 0.0), rel=1e-12)


def test_a_tire_file_keeps_it():
    tire = TireModel(law=LAW)
    assert from_text(to_text(tire)) == tire


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"inf"', "0", "radius = 0"),
        ('"change": 0.02', '"change": "much"', "not a number"),
        ('"base"', '"bass"', "bass"),
    ],
)
def test_a_broken_entry_is_refused(old, new, said):
    text = to_text(TireModel(law=LAW)).replace(old, new, 1)
    with pytest.raises(TireFileError, match=said):
        from_text(text)


def test_surfaces_are_distinct_and_changes_bounded():
    with pytest.raises(ParameterError, match="one entry for each"):
        Recalibrated(BASE, ((math.inf, 0.0, 0.0), (-math.inf, 0.1, 0.0)))
    with pytest.raises(ParameterError, match="between -100 and 100, and between -5 and 5"):
        Recalibrated(BASE, ((0.2, 109.0, 0.0),))
    with pytest.raises(ParameterError, match="between -100 and 100, and between -5 and 5"):
        Recalibrated(BASE, ((0.2, 0.0, 9.0),))


@pytest.mark.parametrize("deflection", [2e-9, 1e-3, 0.01, 0.7])
def test_an_exponent_changed_about_a_deflection_leaves_the_force_there(deflection: float) -> None:
    """By the definition, A exp(a) x^(B + b) with x in centimetres."""
    x = 100.0 * deflection
    A0, B0 = BASE.coefficients(math.inf)
    A, B = Recalibrated(BASE, ((math.inf, *changed_at(deflection, 0.3, 0.5)),)).coefficients(math.inf)
    assert pytest.approx(B0 + 0.5, rel=1e-12) == B
    assert pytest.approx(A0 * x**B0 * math.exp(0.3), rel=1e-9) == A * x**B
