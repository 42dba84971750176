"""A drifting zero of the deflection."""

from __future__ import annotations

import numpy as np
import pytest
from driving import drive, only
from radialtire import TireModel


def test_the_deflection_moves_in_proportion_to_the_time_since_the_start() -> None:
    time, x = np.linspace(100.0, 400.0, 40), np.linspace(0.01, 0.03, 40)
    drifting = drive(only("deflection_drift", drift=-2e-6), time, x)
    moved = drive(TireModel(), time, x - 2e-6 * (time - 100.0))
    assert drifting == pytest.approx(moved, rel=1e-12)


def test_a_drift_that_is_over_leaves_an_offset_of_its_rate_over_that_of_its_settling() -> None:
    """u (1 - exp(-k t)) / k: 100 um of which all but exp(-8) are over at the end, as an offset of 100 um less that."""
    time, x = np.linspace(0.0, 400.0, 4001), np.full(4001, 0.01)
    settles = drive(only("deflection_drift", drift=2e-6, settling=0.02), time, x)
    offset = drive(only("deflection_offset", offset=1e-4 * (1.0 - np.exp(-8.0))), time, x)
    assert settles[0] == drive(TireModel(), time, x)[0]
    assert settles[-1] == pytest.approx(offset[-1], rel=1e-12)
    # At first it is the straight line, whose next term is k t / 2 of it.
    even = drive(only("deflection_drift", drift=2e-6), time, x)
    early = slice(1, 6)
    assert (settles[early] - settles[0]) / (even[early] - even[0]) == pytest.approx(
        1.0 - 0.01 * time[early], abs=1e-4
    )
