"""Tires of the rig."""

import math

import numpy as np
import pytest
from concealed.article import ARTICLE_SURFACES, coefficients
from concealed.tires import (
    INFLATION,
    ContactPatchTire,
    PowerTire,
    Surface,
    article_tire,
    best_power_law,
    contact_patch_tire,
    deviating_tire,
)
from scipy.optimize import curve_fit


def test_the_articles_equations() -> None:
    """5a to 6b of the article, worked by hand: e^-0.31991 = 0.72621, e^-5.32638 = 0.0048617, and so on."""
    assert coefficients(math.inf) == (550.9, 1.422)
    a, b = coefficients(0.0127)
    assert a == pytest.approx(550.9 - 337.8 * 0.72621, abs=0.01)
    assert b == pytest.approx(1.422 - 0.2469 * 0.81087, abs=1e-4)
    a, b = coefficients(-0.381)
    assert a == pytest.approx(550.9 + 7822.0 * 0.0048617, abs=0.01)
    assert b == pytest.approx(1.422 + 0.2128 * 0.33252, abs=1e-4)


def test_the_articles_surfaces() -> None:
    """Ten convex from 1.27 to 58.4 cm, the flat, three concave of -38.1, -50.8 and -58.4 cm."""
    convex = [r for r in ARTICLE_SURFACES if 0.0 < r < math.inf]
    concave = [r for r in ARTICLE_SURFACES if r < 0.0]
    assert (len(convex), min(convex), max(convex)) == (10, pytest.approx(0.0127), pytest.approx(0.5842))
    assert sorted(concave, reverse=True) == pytest.approx([-0.381, -0.508, -0.5842])


def test_a_contact_patch_without_saturation_has_a_closed_form() -> None:
    """Width q h: F = p q integral h ds = p q (4/3) x (2 x/k)^(1/2), the thin toroid's exponent of 3/2."""
    tire = ContactPatchTire(INFLATION, 0.33, 0.1, 1e4, 1.6, 0.0, 0.0)
    x = np.array([0.001, 0.01, 0.025])
    for radius, curvature in (
        (math.inf, 1 / 0.33),
        (0.254, 1 / 0.33 + 1 / 0.354),
        (-0.4, 1 / 0.33 - 1 / 0.5),
    ):
        force = tire.force(x, np.full(3, radius), np.ones(3))
        expected = INFLATION * 1.6 * 4.0 / 3.0 * x * np.sqrt(2.0 * x / curvature)
        assert force == pytest.approx(expected, rel=1e-4)


def test_pressure_acts_on_the_pneumatic_part_alone() -> None:
    tire = contact_patch_tire(np.random.default_rng(1))
    x, flat = np.array([0.02]), np.array([math.inf])
    empty, half, full = (tire.force(x, flat, np.array([ratio]))[0] for ratio in (0.0, 0.5, 1.0))
    assert 0.0 < empty < 0.2 * full
    assert half == pytest.approx(0.5 * (empty + full))


@pytest.mark.parametrize("seed", range(10))
def test_contact_patch_tires_are_like_the_articles(seed: int) -> None:
    """1.2 to 2.5 kN at 2.5 cm on the flat; softer on bumps, stiffer in hollows; exponents like the law's."""
    tire = contact_patch_tire(np.random.default_rng(seed))
    forces = {r: float(tire.force(np.array([0.025]), np.array([r]), np.ones(1))[0]) for r in ARTICLE_SURFACES}
    assert 1200.0 < forces[math.inf] < 2500.0
    order = [forces[r] for r in sorted(ARTICLE_SURFACES, key=lambda r: 1.0 / r, reverse=True)]
    assert order == sorted(order)
    assert all(1.2 < best_power_law(tire, r, 0.025).b < 1.7 for r in ARTICLE_SURFACES)
    assert 100e3 < tire.pressure < 500e3


def test_the_best_power_law_is_the_least_squares_one() -> None:
    tire = contact_patch_tire(np.random.default_rng(3))
    x = np.linspace(0.0, 0.025, 61)[1:]
    force = tire.force(x, np.full(60, math.inf), np.ones(60))
    (a, b), _ = curve_fit(lambda x, a, b: a * (100.0 * x) ** b, x, force, p0=(500.0, 1.4))
    found = best_power_law(tire, math.inf, 0.025)
    assert (found.a, found.b) == pytest.approx((a, b), rel=1e-5)


def test_deviations_are_of_some_percent_and_differ_by_surface() -> None:
    own, article = deviating_tire(np.random.default_rng(0)), article_tire()
    ratios = np.array([own.at(r).a / article.at(r).a for r in ARTICLE_SURFACES])
    assert 0.005 < np.std(ratios) < 0.08
    assert np.all(np.abs(ratios - 1.0) < 0.25)


def test_between_its_surfaces_a_power_tire_is_interpolated_over_the_curvature() -> None:
    tire = PowerTire((Surface(math.inf, 600.0, 1.4), Surface(0.1, 400.0, 1.2)))
    assert tire.at(0.2) == Surface(0.2, 500.0, pytest.approx(1.3))
