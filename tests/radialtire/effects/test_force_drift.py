"""A drifting zero of the force."""

from __future__ import annotations

import numpy as np
import pytest
from driving import drive, only
from radialtire import TireModel


def test_it_adds_in_proportion_to_the_time_since_the_start() -> None:
    time, x = np.linspace(100.0, 400.0, 40), np.linspace(-0.01, 0.03, 40)
    added = drive(only("force_drift", drift=0.05), time, x) - drive(TireModel(), time, x)
    assert added == pytest.approx(0.05 * (time - 100.0), abs=1e-10)


def test_a_drift_that_settles_ends_at_its_rate_over_that_of_its_settling() -> None:
    """d (1 - exp(-k t)) / k: its integral equation F' = d - k (F - F0) by small steps, and its end d / k."""
    time, x = np.linspace(0.0, 400.0, 4001), np.full(4001, 0.01)
    settles = drive(only("force_drift", drift=0.05, settling=0.02), time, x) - drive(TireModel(), time, x)
    middle = 0.5 * (settles[1:] + settles[:-1])
    # Trapezoids of 0.1 s err by (k dt)^2 / 12 of the change, 3e-7.
    assert np.diff(settles) == pytest.approx((0.05 - 0.02 * middle) * np.diff(time), rel=1e-5)
    assert settles[-1] == pytest.approx(0.05 / 0.02, rel=1e-3)
