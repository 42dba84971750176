"""Softening by the largest deflection so far."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from driving import drive, only
from radialtire import PowerLaw, TireModel

UP = np.linspace(0.0, 0.02, 101)
DOWN_UP = np.concatenate([UP, UP[::-1], UP])
BARE = drive(TireModel(), np.arange(303.0), DOWN_UP)


def driven(**changed: float) -> np.ndarray:
    return drive(only("mullins_softening", **changed), np.arange(303.0), DOWN_UP)


def test_the_first_loading_is_that_of_a_new_tire() -> None:
    assert np.array_equal(driven(share=0.3)[:101], BARE[:101])


def test_unloading_and_the_second_loading_are_one_curve() -> None:
    force = driven(share=0.3)
    assert np.array_equal(force[101:202], force[202:][::-1])
    assert np.all(force[202:-1] <= BARE[202:-1])


def test_far_below_the_share_is_lost() -> None:
    # 1 - D (1 - exp(-u - c u^2)) with u = (20 - 2) mm / (0.05 * 20 mm)
    force = driven(share=0.3, ratio=0.05)
    i = 202 + 10
    assert UP[10] == pytest.approx(2e-3)
    assert force[i] / BARE[i] == pytest.approx(0.7, abs=0.3 * math.exp(-18.0) + 1e-12)


def test_width_ratio_and_gaussian_shape_it_as_stated() -> None:
    force = driven(share=0.2, width=2e-3, ratio=0.1, gaussian=3.0)
    i = 202 + 90  # 2 mm below 20 mm: u = 2 / (2 + 0.1 * 20) = 1/2
    assert force[i] / BARE[i] == pytest.approx(1.0 - 0.2 * (1.0 - math.exp(-0.5 - 0.75)), rel=1e-12)


def test_it_is_that_of_ogden_and_roxburgh() -> None:
    """eta = 1 - D erf((W_m - W) / m) on one surface, in the stored energy W = F x / (1 + B)."""
    x = np.linspace(0.0, 0.02, 201)[::-1]
    work = 550.9 * (100.0 * x) ** 2.422
    scale = 1.1 * 0.3 * work[0]  # u = z / 1.1 where the argument of the error function is z
    force = drive(only("mullins_softening", share=0.2, ratio=0.3, load=1.0), np.arange(201.0), x)
    eta = np.array([1.0 - 0.2 * math.erf((work[0] - w) / scale) for w in work[:-1]])
    np.testing.assert_allclose(
        force[:-1] / drive(TireModel(), np.arange(201.0), x)[:-1], eta, atol=0.2 * 0.003
    )


def test_measured_in_the_energy_it_depends_on_the_parts_of_the_energy() -> None:
    # Stored in x^2.422, half of the largest energy is left at 2^(-1/2.422) of the largest deflection: u = 1/2 / (1/4)
    half = 0.02 * 2.0 ** (-1.0 / 2.422)
    tire = only("mullins_softening", share=0.2, ratio=0.25, gaussian=0.0, load=1.0)
    force = drive(tire, np.arange(2.0), np.array([0.02, half]))
    bare = drive(TireModel(), np.arange(2.0), np.array([0.02, half]))
    assert force[1] / bare[1] == pytest.approx(1.0 + 0.2 * math.expm1(-2.0), rel=1e-12)


@pytest.mark.parametrize("load", [0.0, 1.0])
def test_from_one_surface_to_another_the_measure_goes_on(load: float) -> None:
    # At 15 mm the bump bears less force than the flat ground did: only the deflection is its largest so far.
    time, x, radius = np.arange(2.0), np.array([0.015, 0.015]), np.array([np.inf, 0.01905])
    force = drive(only("mullins_softening", share=0.2, ratio=0.25, gaussian=0.0, load=load), time, x, radius)
    bare = drive(TireModel(), time, x, radius)
    u = load * (1.0 - bare[1] / bare[0]) / 0.25
    assert bare[1] < 0.9 * bare[0]
    assert force[1] / bare[1] == pytest.approx(1.0 + 0.2 * math.expm1(-u), rel=1e-12)


def test_what_is_fixed_is_the_same_on_every_surface() -> None:
    # Fixed at 12 mm on Hull's tire on flat ground: pressed there to 12 mm, and left, u = 1.
    x = np.array([0.012, 0.0, 1e-9])
    for radius in (np.inf, 0.01905):
        tire = only("mullins_softening", share=0.2, ratio=5e-3, width=0.012, gaussian=0.0, load=1.0)
        force = drive(tire, np.arange(3.0), x, np.full(3, radius))
        bare = drive(TireModel(), np.arange(3.0), x, np.full(3, radius))
        work = bare[0] / (550.9 * 1.2**1.422)
        assert force[2] / bare[2] == pytest.approx(
            1.0 + 0.2 * math.expm1(-work / (5e-3 * work + 1.0)), rel=1e-5
        )


@pytest.mark.parametrize(("softer", "smaller"), [(1e-3, 1.0), (1.0, 1e-2), (1e4, 1e3)])
def test_it_is_the_same_in_any_units(softer: float, smaller: float) -> None:
    """A part with so many times the force at so many times the deflection softens by the same factor."""
    law, values = PowerLaw(400.0, 1.3), {"share": 0.3, "ratio": 0.2, "load": 0.7}
    lengths = {"width": 2e-5, "gathering": 3e-4, "history": 4e-5}
    tire = only("mullins_softening", **values, **lengths)
    scaled = only("mullins_softening", **values, **{n: smaller * v for n, v in lengths.items()})
    other = PowerLaw(softer * law.coefficient / smaller**law.exponent, law.exponent)
    time, x = np.arange(303.0), 0.01 * DOWN_UP
    one = drive(replace(tire, law=law, two_sided=True), time, x)
    same = drive(replace(scaled, law=other, two_sided=True), time, smaller * x)
    np.testing.assert_allclose(same, softer * one, rtol=1e-9)


def test_beyond_the_largest_deflection_it_is_new_again() -> None:
    x = np.array([0.01, 0.005, 0.012])
    force = drive(only("mullins_softening", share=0.3), np.arange(3.0), x)
    bare = drive(TireModel(), np.arange(3.0), x)
    assert force[1] < bare[1]
    assert force[2] == bare[2]


def test_rest_does_not_heal_it() -> None:
    tire = only("mullins_softening", share=0.3)
    soon = drive(tire, [0.0, 1.0, 2.0], [0.02, 0.0, 0.01])
    late = drive(tire, [0.0, 1.0, 1e6], [0.02, 0.0, 0.01])
    assert soon[-1] == late[-1]


def test_a_tire_with_a_history_starts_soft() -> None:
    used = drive(only("mullins_softening", share=0.3, history=0.02), [0.0], [0.01])
    new_then_used = drive(only("mullins_softening", share=0.3), [0.0, 1.0], [0.02, 0.01])
    assert used[0] == new_then_used[-1]


def test_it_gathers_along_the_way_below() -> None:
    # down 20 mm and up 2 mm again: g = 1 - exp(-22 / 11), and all of the share is at stake far below
    i = 202 + 10
    force = driven(share=0.3, ratio=0.05, gathering=0.011)
    gathered = -math.expm1(-2.0)
    assert force[i] / BARE[i] == pytest.approx(
        1.0 - 0.3 * gathered * -math.expm1(-18.0 - 0.62 * 18.0**2), rel=1e-9
    )


def test_the_noise_of_a_gauge_at_rest_is_no_way() -> None:
    # 5000 readings of 1e-5 m of noise walk 5000 * 2/sqrt(pi) * 1e-5 = 56 mm
    held = 0.01 + 1e-5 * np.random.default_rng(8).standard_normal(5000)
    x = np.concatenate([[0.02], held])
    noisy = drive(only("mullins_softening", share=0.3, ratio=0.05, gathering=0.02), np.arange(5001.0), x)
    bare = drive(TireModel(), np.arange(5001.0), x)
    gathered = -math.expm1(-0.01 / 0.02)
    # what is left of the noise: 1e-5 m beside the 20 mm of the way
    assert noisy[-1] / bare[-1] == pytest.approx(1.0 - 0.3 * gathered * -math.expm1(-10.0), rel=1e-3)
