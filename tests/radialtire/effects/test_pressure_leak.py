"""Leaking air: exponential, in proportion to the force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import drive, only
from radialtire import TireModel

X = np.array([0.005, 0.01, 0.02, 0.03])


def test_the_force_falls_exponentially_at_every_deflection() -> None:
    time = np.array([0.0, 100.0, 500.0, 3000.0])
    factor = drive(only("pressure_leak", rate=1e-3), time, X) / drive(TireModel(), time, X)
    assert factor == pytest.approx(np.exp(-1e-3 * time), rel=1e-14)


def test_the_casing_carries_its_share_to_the_end() -> None:
    factor = drive(only("pressure_leak", rate=1.0, structural=0.2), [0.0, 1e3], [0.02, 0.02])
    assert factor[1] / factor[0] == pytest.approx(0.2, rel=1e-14)


def test_a_sound_tire_shows_nothing_in_an_hour() -> None:
    # 0.3 psi of 50 a day
    rate = 0.3 / 50.0 / 86400.0
    factor = drive(only("pressure_leak", rate=rate), [0.0, 3600.0], [0.02, 0.02])
    assert 1.0 - factor[1] / factor[0] == pytest.approx(0.3 / 50.0 / 24.0, rel=1e-3)
    assert math.log(0.5) / -rate > 80.0 * 86400.0
