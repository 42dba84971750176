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
