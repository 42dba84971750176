"""What stays of a deflection: closed forms of loading, unloading and the loading after it."""

from __future__ import annotations

import numpy as np
import pytest
from driving import drive, only
from radialtire import PowerLaw, TireModel

UP = np.linspace(0.0, 0.02, 201)
CYCLES = np.concatenate([UP[:101], UP[:100][::-1], UP, UP[:200][::-1], UP])
"""To 10 mm and back, to 20 mm and back, and to 20 mm again, in steps of 0.1 mm."""

FIRST, BACK, SECOND, BACK_AGAIN, LAST = (
    slice(0, 101),
    slice(101, 201),
    slice(201, 402),
    slice(402, 602),
    slice(602, 803),
)


def driven(**changed: float) -> np.ndarray:
    return drive(only("permanent_set", **changed), np.arange(CYCLES.size * 1.0), CYCLES)


BARE = drive(TireModel(), np.arange(CYCLES.size * 1.0), CYCLES)


def test_a_new_largest_deflection_has_the_force_of_the_law() -> None:
    force = driven(share=0.3, power=1.2)
    assert np.array_equal(force[FIRST], BARE[FIRST])
    assert np.array_equal(force[SECOND][101:], BARE[SECOND][101:])


def test_there_is_no_force_before_what_stays_and_the_law_is_compressed_beyond() -> None:
    """With q = 1: F((x - 3 mm) / (10 mm - 3 mm) * 10 mm); 0 below 3 mm."""
    force = driven(share=0.3)
    x = CYCLES[BACK]
    inner = np.maximum(x - 0.003, 0.0) / 0.007 * 0.01
    law = drive(TireModel(), np.arange(x.size * 1.0), inner)
    assert force[BACK] == pytest.approx(law, rel=1e-9, abs=1e-9)


def test_loading_again_goes_back_on_the_curve_of_the_unloading() -> None:
    force = driven(share=0.3, power=0.7)
    assert force[SECOND][:100] == pytest.approx(force[BACK][::-1], rel=1e-9, abs=1e-9)
    assert force[LAST][:200] == pytest.approx(force[BACK_AGAIN][::-1], rel=1e-9, abs=1e-9)


def test_the_unloading_of_what_all_stays_has_the_exponent_of_oliver_and_pharr() -> None:
    """h_f = 0.9 h_max, a law F = C h^2: the unloading is a power 2 q^0.9 of h - h_f."""
    effects = only("permanent_set", share=0.9, power=0.7).effects
    tire = TireModel(PowerLaw(100.0, 2.0), effects, tested_range=None)
    x = np.array([0.01, 0.0095, 0.0092])
    force = drive(tire, np.arange(3.0), x)
    exponents = np.log(force[1:] / force[0]) / np.log((x[1:] - 0.009) / 0.001)
    assert exponents == pytest.approx(2.0 * 0.7**0.9, rel=1e-9)


def test_up_to_the_yield_deflection_nothing_stays() -> None:
    force = driven(share=0.3, onset=0.01)
    assert np.array_equal(force[BACK], BARE[BACK])
    held = drive(only("permanent_set", share=0.3, onset=0.01), np.arange(2.0), np.array([0.02, 0.0029]))
    assert held[1] == 0.0


def test_what_it_has_been_through_counts() -> None:
    """A part that was at 20 mm before is loaded as one that was there in the recording."""
    x = UP[:150]
    before = drive(only("permanent_set", share=0.3, history=0.02), np.arange(150.0), x)
    assert before == pytest.approx(driven(share=0.3)[LAST][:150], rel=1e-12)


def test_the_curve_has_no_step_where_the_force_begins_or_where_the_largest_deflection_is() -> None:
    tire = only("permanent_set", share=0.3, power=0.6)
    near = np.array([0.01, 0.01 - 1e-9, 0.003 + 1e-12, 0.003 - 1e-12])
    force = drive(tire, np.arange(4.0), near)
    assert force[1] == pytest.approx(force[0], rel=1e-6)
    assert force[2] < 1e-3
    assert force[3] == 0.0


def test_a_smaller_share_vanishes_whatever_the_exponent() -> None:
    assert driven(share=1e-9, power=3.0) == pytest.approx(BARE, rel=1e-5, abs=1e-5)
