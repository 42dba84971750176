"""The force at another pressure: published limits, and nothing where no pressure is known."""

from __future__ import annotations

import numpy as np
import pytest
from driving import drive, only
from radialtire import TireModel

REFERENCE = 344.7e3


def factor(pressure: float, **values: float) -> float:
    """The force at 1 cm on the flat over that of the article's tire, 550.9 N."""
    return float(drive(only("inflation_pressure", **values), [0.0], [0.01], pressure=pressure)[0]) / 550.9


def test_a_thin_toroid_is_proportional_to_the_pressure() -> None:
    # Renart & Roura-Grabulosa (2019): all of the force is the air's
    for part in (0.5, 1.0, 1.7):
        assert factor(part * REFERENCE, gain=1.0) == pytest.approx(part, rel=1e-12)


def test_it_is_the_pressure_term_of_the_magic_formula() -> None:
    # MF-Tyre 6.1: 1 + pFz1 dp, dp = (p - p0) / p0, typed a second time
    pFz1, p0, p = 0.7, 2.2e5, 2.8e5
    assert factor(p, gain=pFz1, reference=p0) == pytest.approx(1.0 + pFz1 * (p - p0) / p0, rel=1e-12)


def test_without_air_the_casing_carries_its_share() -> None:
    for power in (1.0, 0.6):
        assert factor(0.0, gain=0.8, power=power) == pytest.approx(0.2, rel=1e-12)
    # a gauge that reads a little below zero is one without pressure
    assert factor(-500.0, gain=0.8) == pytest.approx(0.2, rel=1e-12)


def test_at_the_reference_and_without_a_pressure_all_is_as_before_to_the_last_bit() -> None:
    time, x = np.linspace(0.0, 1.0, 50), np.linspace(-0.002, 0.03, 50)
    tire, bare = only("inflation_pressure", gain=0.8, power=0.7), drive(TireModel(), time, x)
    assert np.array_equal(drive(tire, time, x), bare)
    assert np.array_equal(drive(tire, time, x, pressure=REFERENCE), bare)


def test_the_tire_says_which_channels_it_reads_and_where_they_start() -> None:
    ((number, channel, start),) = only("inflation_pressure", reference=2.5e5).channels
    assert (number, channel.name, channel.variable, channel.unit) == (
        0,
        "pressure",
        "inflation_pressure",
        "Pa",
    )
    assert start == 2.5e5
    assert TireModel().channels == ()
