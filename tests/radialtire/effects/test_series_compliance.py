"""A spring in series: against its own equation, closed forms, and the article's wheel."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, only
from hypothesis import given, settings
from hypothesis import strategies as st
from published import hull1996 as article
from radialtire import Instant, PowerLaw, TireModel, power_law
from radialtire.effects.series_compliance import SERIES_COMPLIANCE, stiffening
from scipy.optimize import brentq


@given(
    st.floats(-12.0, 0.0).map(lambda u: 0.33 * math.exp(u)),
    st.floats(-30.0, 0.0).map(lambda u: 1e-4 * math.exp(u)),
    st.floats(-6.0, 13.0).map(math.exp),
    st.floats(0.1, 10.0),
)
@settings(max_examples=300, deadline=None)
def test_the_parts_add_up_to_the_reading(x: float, k: float, A: float, B: float) -> None:
    # its own equation; a change of x of one rounding changes k F by up to B of them
    instant = Instant(0.0, 0.0, True, x, 0.0, 0.0, A, B, 0.0)
    tire, _ = SERIES_COMPLIANCE.respond(x, instant, (), (k, 0.0))
    assert 0.0 < tire <= x * (1.0 + 1e-15)
    assert tire + k * power_law.force(tire, A, B) == pytest.approx(x, rel=2e-14)


def test_two_straight_springs_share_the_deflection() -> None:
    # closed form: 1 / (k + 1/K)
    k = 5e-6
    force = drive(only("series_compliance", law=LINEAR, compliance=k), [0.0], [0.02])
    assert force[0] == pytest.approx(0.02 / (k + 1.0 / STIFFNESS), rel=1e-14)


def test_a_spring_against_its_square_root_has_the_roots_of_a_quadratic() -> None:
    # B = 2: k A (100 x)^2 + x = X; B = 1/2: x + k A (100 x)^0.5 = X, quadratic in the root of x
    k, A, X = 2e-5, 800.0, 0.03
    a = k * A * 1e4
    square = (-1.0 + math.sqrt(1.0 + 4.0 * a * X)) / (2.0 * a)
    force = drive(only("series_compliance", law=PowerLaw(A, 2.0), compliance=k), [0.0], [X])
    assert force[0] == pytest.approx(A * (100.0 * square) ** 2, rel=1e-13)
    b = k * A * 10.0
    root = ((-b + math.sqrt(b * b + 4.0 * X)) / 2.0) ** 2
    force = drive(only("series_compliance", law=PowerLaw(A, 0.5), compliance=k), [0.0], [X])
    assert force[0] == pytest.approx(A * (100.0 * root) ** 0.5, rel=1e-13)


def test_the_articles_wheel_hides_the_printed_share_of_the_stiffness() -> None:
    # tangents in series: 1/K_both = 1/K_tire + 1/K_wheel; 1.7e5 N/m with the wheel lose 8.5 %, printed "up to 8.8 %"
    both = article.GREATEST_STIFFNESS
    alone = 1.0 / (1.0 / both - 1.0 / article.WHEEL_STIFFNESS)
    assert 1.0 - both / alone == pytest.approx(article.GREATEST_UNDERESTIMATE, abs=0.004)
    law = PowerLaw(alone / 100.0, 1.0)
    force = drive(only("series_compliance", law=law, compliance=1.0 / article.WHEEL_STIFFNESS), [0.0], [0.01])
    assert force[0] / 0.01 == pytest.approx(both, rel=1e-12)


def test_in_the_air_nothing_gives_way() -> None:
    x = np.array([-0.5, -1e-9, 0.0])
    assert list(drive(only("series_compliance", compliance=1e-5), [0.0, 1.0, 2.0], x)) == [0.0, 0.0, 0.0]


def test_a_spring_that_stiffens_by_so_much() -> None:
    # linear tire K, k = 1 / K: d (1 + h d) = x - d, so h d^2 + 2 d = x; h x = 3 gives d = x / 3
    x = 0.03
    force = drive(
        only("series_compliance", law=LINEAR, compliance=1.0 / STIFFNESS, stiffening=3.0 / x), [0.0], [x]
    )
    assert force[0] == pytest.approx(STIFFNESS * (x - x / 3.0), rel=1e-12)


def test_a_spring_that_stiffens_gives_way_less_than_a_plain_one() -> None:
    x = np.linspace(0.0, 0.03, 50)
    plain = drive(only("series_compliance", compliance=4e-6), x, x)
    stiffer = drive(only("series_compliance", compliance=4e-6, stiffening=100.0), x, x)
    rigid = drive(TireModel(), x, x)
    assert np.all(plain[1:] < stiffer[1:])
    assert np.all(stiffer[1:] < rigid[1:])


def stiffening_part(x: float, A: float, B: float, compliance: float, stiffening: float) -> float:
    instant = Instant(0.0, 0.0, True, x, 0.0, 0.0, A, B, 0.0)
    return SERIES_COMPLIANCE.respond(x, instant, (), (compliance, stiffening))[0]


@pytest.mark.parametrize(
    ("x", "A", "B", "k", "h"),
    [
        # Newton's steps and halvings go on between two neighbouring numbers until there are too many of them
        (0.16480921549555533, 297784.55518061545, 7.419966040574482, 8.087582869992886e-05, 912.526143627438),
        (
            0.22745462084471585,
            273400.37602136726,
            9.391705766341751,
            2.1969222534702155e-05,
            576.4878528657675,
        ),
        (0.02, 800.0, 1.4, 5e-6, 30.0),
    ],
)
def test_a_stiffening_spring_against_a_bracketed_root(
    x: float, A: float, B: float, k: float, h: float
) -> None:
    # a second formulation: scipy's bracketing root finder on d (1 + h d) = k F(x - d)
    d = brentq(lambda d: d * (1.0 + h * d) - k * power_law.force(x - d, A, B), 0.0, x, xtol=1e-18, rtol=1e-15)
    # the search may stop at its largest number of steps, a few hundred roundings of x from the root
    assert stiffening_part(x, A, B, k, h) == pytest.approx(x - d, abs=1e-13 * x)


def test_a_tire_that_gets_less_than_a_rounding_of_the_deflection_is_no_division_by_zero() -> None:
    # the tire's part u solves k F(u) = x, to first order in u / x: u = 0.01 (x / (k A))^(1/B)
    x, A, B, k, h = 2.2263590412981563e-08, 163580.0, 0.2, 2.12e-05, 0.01
    part = 0.01 * (x / (k * A)) ** (1.0 / B)
    assert part < 1e-17 * x
    assert stiffening_part(x, A, B, k, h) == pytest.approx(part, abs=1e-14 * x)


@pytest.mark.parametrize("x", [4.97765304193e-311, 2.1401787e-317, 5e-324])
def test_a_deflection_that_has_died_away_leaves_nothing_to_the_tire(x: float) -> None:
    # What a lag leaves of a deflection after minutes at rest: below it all smaller numbers are 0.
    assert stiffening_part(x, 4.83, 0.2, 6.1e-4, 513.0) == pytest.approx(0.0, abs=x)


def test_the_search_of_the_parts_ends_whatever_it_is_given() -> None:
    assert math.isnan(stiffening(math.nan, 1e-6, 10.0, 1000.0, 1.0, 0.01))
