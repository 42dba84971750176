"""The compression of the air: the gas law."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import drive, only
from radialtire import PowerLaw, TireModel
from radialtire.effects.gas_compression import REFERENCE


def factor(x: float, **changed: float) -> float:
    one = drive(only("gas_compression", **changed), [0.0], [x])[0]
    return float(one / drive(TireModel(), [0.0], [x])[0])


def test_half_the_volume_is_twice_the_absolute_pressure() -> None:
    # Boyle: with b = p_atmosphere / p_gauge, 2 (1 + b) - b = 2 + b of the gauge pressure
    assert factor(REFERENCE, lost_volume=0.5, atmosphere=0.3) == pytest.approx(2.3, rel=1e-14)


def test_fast_compression_is_adiabatic() -> None:
    expected = 1.25 * 0.75**-1.4 - 0.25
    got = factor(REFERENCE, lost_volume=0.25, atmosphere=0.25, polytropic_exponent=1.4)
    assert got == pytest.approx(expected, rel=1e-14)


def test_a_small_loss_raises_the_pressure_in_proportion() -> None:
    # 3 to 4 % of gauge pressure at 25 mm come of a loss of 2.5 to 3 %: dp / p0 = n (1 + b) w
    rise = factor(REFERENCE, lost_volume=0.025, atmosphere=0.294) - 1.0
    assert rise == pytest.approx(0.025 * 1.294, rel=0.03)
    assert 0.03 < rise < 0.04


def test_the_loss_grows_with_the_stated_power() -> None:
    small = {"lost_volume": 1e-6, "power": 3.0, "atmosphere": 1.0}
    ratio = (factor(0.02, **small) - 1.0) / (factor(0.01, **small) - 1.0)
    assert ratio == pytest.approx(8.0, rel=1e-4)


def test_in_the_air_nothing_is_compressed() -> None:
    tire = only("gas_compression", lost_volume=0.5, atmosphere=0.3)
    assert drive(tire, [0.0, 1.0], [-1e-3, 0.0]).tolist() == [0.0, 0.0]


def test_it_never_compresses_the_air_to_nothing() -> None:
    force = drive(only("gas_compression", lost_volume=0.5, power=4.0), [0.0, 1.0], [0.1, 0.3])
    assert np.all(np.isfinite(force))


def test_a_bump_takes_less_of_the_volume() -> None:
    # R = r_w / 3: both curvatures make four times that of the wheel, a patch of half the length
    small = {"lost_volume": 1e-6, "atmosphere": 1.0}
    law = PowerLaw(550.9, 1.422)
    x = np.array([REFERENCE])

    def rise(radius: float, surface: float) -> float:
        one = drive(only("gas_compression", law=law, surface=surface, **small), [0.0], x, radius)[0]
        return float(one / drive(TireModel(law), [0.0], x, radius)[0]) - 1.0

    assert rise(0.11, 0.5) / rise(math.inf, 0.5) == pytest.approx(0.5, rel=1e-3)
    assert rise(0.11, 0.0) == rise(math.inf, 0.0)
