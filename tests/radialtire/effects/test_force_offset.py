"""A shifted zero of the force."""

from __future__ import annotations

import numpy as np
from driving import drive, only
from radialtire import TireModel


def test_it_adds_one_constant_on_the_ground_and_in_the_air() -> None:
    time, x = np.arange(40.0), np.linspace(-0.01, 0.03, 40)
    force = drive(only("force_offset", offset=-12.5), time, x)
    assert np.array_equal(force, drive(TireModel(), time, x) - 12.5)
