"""Leaking air: exponential, in proportion to the force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import drive, only
from radialtire import TireModel
from scipy.integrate import solve_ivp

X = np.array([0.005, 0.01, 0.02, 0.03])


def test_the_force_falls_exponentially_at_every_deflection() -> None:
    time = np.array([0.0, 100.0, 500.0, 3000.0])
    factor = drive(only("pressure_leak", rate=1e-3), time, X) / drive(TireModel(), time, X)
    assert factor == pytest.approx(np.exp(-1e-3 * time), rel=1e-14)


@pytest.mark.parametrize("flow", [0.5, 1.0, 1.0 + 1e-12, 2.0])
def test_the_flow_follows_its_power_of_the_pressure(flow: float) -> None:
    """Against dq/dt = -l q^n, integrated by scipy."""
    time = np.linspace(0.0, 150.0, 16)
    end = (0.0, 150.0)
    solved = solve_ivp(lambda _, q: -1e-2 * q**flow, end, [1.0], t_eval=time, rtol=1e-10, atol=1e-12)
    factor = drive(only("pressure_leak", rate=1e-2, flow=flow), time, [0.02] * 16)
    np.testing.assert_allclose(factor / factor[0], solved.y[0], rtol=1e-7)


def test_through_a_hole_it_is_empty_at_twice_the_time_constant() -> None:
    tire = only("pressure_leak", rate=1e-2, flow=0.5, structural=0.1)
    factor = drive(tire, [0.0, 100.0, 200.0, 1e6], [0.02] * 4)
    # q = (1 - l t / 2)^2: a quarter at one time constant, nothing from two on
    assert factor[1:] / factor[0] == pytest.approx([0.1 + 0.9 / 4.0, 0.1, 0.1], rel=1e-12)


def test_the_casing_carries_its_share_to_the_end() -> None:
    factor = drive(only("pressure_leak", rate=1.0, structural=0.2), [0.0, 1e3], [0.02, 0.02])
    assert factor[1] / factor[0] == pytest.approx(0.2, rel=1e-14)


def test_a_sound_tire_shows_nothing_in_an_hour() -> None:
    # 0.3 psi of 50 a day
    rate = 0.3 / 50.0 / 86400.0
    factor = drive(only("pressure_leak", rate=rate), [0.0, 3600.0], [0.02, 0.02])
    assert 1.0 - factor[1] / factor[0] == pytest.approx(0.3 / 50.0 / 24.0, rel=1e-3)
    assert math.log(0.5) / -rate > 80.0 * 86400.0
