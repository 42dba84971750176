"""Warming: the force rises to a new level."""

from __future__ import annotations

import math

import pytest
from driving import drive, only


def test_it_has_risen_by_63_percent_of_the_gain_after_the_time_constant() -> None:
    force = drive(only("warm_up", gain=0.1, time_constant=60.0), [0.0, 60.0, 6000.0], [0.02] * 3)
    assert force[1] / force[0] == pytest.approx(1.0 + 0.1 * (1.0 - math.exp(-1.0)), rel=1e-14)
    assert force[2] / force[0] == pytest.approx(1.1, rel=1e-14)


def test_stretched_it_has_risen_as_far_at_its_time_but_is_slower_in_the_end() -> None:
    tire = only("warm_up", gain=0.1, time_constant=60.0, stretch=0.5)
    force = drive(tire, [0.0, 15.0, 60.0, 960.0], [0.02] * 4)
    # (t / tau)^(1/2) is 1/2, 1 and 4
    expected = [1.0 + 0.1 * (1.0 - math.exp(-root)) for root in (0.5, 1.0, 4.0)]
    assert force[1:] / force[0] == pytest.approx(expected, rel=1e-14)


def test_ten_kelvin_at_40_psi_are_three_percent_and_more() -> None:
    # gas law at constant volume: absolute pressure in proportion to the temperature; 1 psi for 10 degF, within 10 %
    absolute = 40.0 + 14.7
    gain_for_10_degF = absolute * (10.0 / 1.8) / 293.0 / 40.0
    assert gain_for_10_degF * 40.0 == pytest.approx(1.0, rel=0.1)
    force = drive(only("warm_up", gain=gain_for_10_degF, time_constant=1.0), [0.0, 100.0], [0.02] * 2)
    assert force[1] / force[0] == pytest.approx(1.0 + 1.0 / 40.0, abs=0.003)


def test_a_measured_temperature_takes_the_place_of_time() -> None:
    # 10 K above the temperature at the start the force has risen by the gain, whenever that is
    tire = only("warm_up", gain=0.03, time_constant=60.0)
    force = drive(tire, [0.0, 1e4, 2e4], [0.02] * 3, temperature=[290.0, 290.0, 300.0])
    assert force[1] == force[0]
    assert force[2] / force[0] == pytest.approx(1.03, rel=1e-14)


def test_a_tire_that_cools_presses_less() -> None:
    force = drive(only("warm_up", gain=0.03), [0.0, 1.0], [0.02] * 2, temperature=[300.0, 295.0])
    assert force[1] / force[0] == pytest.approx(0.985, rel=1e-14)


def test_a_temperature_that_comes_later_counts_from_its_first_value() -> None:
    """An FMU's input that is set after its initialization: no kelvin was measured before, and none was risen."""
    tire = only("warm_up", gain=0.03, time_constant=1e6)
    unknown = float("nan")
    force = drive(tire, [0.0, 1.0, 2.0, 3.0], [0.02] * 4, temperature=[unknown, unknown, 293.0, 303.0])
    assert force[:3] / force[0] == pytest.approx(1.0, abs=1e-6)
    assert force[3] / force[2] == pytest.approx(1.03, rel=1e-14)
