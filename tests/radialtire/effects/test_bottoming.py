"""The rim: a second spring with a soft onset."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, only


def beyond(x: float, **changed: float) -> float:
    return float(drive(only("bottoming", law=LINEAR, **changed), [0.0], [x])[0]) - STIFFNESS * x


def test_well_beyond_the_onset_it_is_a_spring() -> None:
    got = beyond(0.03, stiffness=3e5, onset=0.022, softness=4e-4)
    # ln(1 + exp(u)) - u is exp(-u) with u = 20
    assert got == pytest.approx(3e5 * 0.008, abs=3e5 * 4e-4 * math.exp(-20.0) + 1e-9)


def test_at_the_onset_it_is_the_logarithm_of_two() -> None:
    assert beyond(0.022, stiffness=3e5, onset=0.022, softness=4e-4) == pytest.approx(
        3e5 * 4e-4 * math.log(2.0)
    )


def test_a_sharp_knee_has_nothing_below() -> None:
    for x in (0.021, 0.022):
        assert beyond(x, stiffness=3e5, onset=0.022, softness=0.0) == beyond(x, stiffness=0.0)
    assert beyond(0.023, stiffness=3e5, onset=0.022, softness=0.0) == pytest.approx(300.0, rel=1e-9)


def test_a_rounded_contact_has_its_power() -> None:
    # K u1 (u / u1)^1.5 with u1 = 1 mm: at 4 mm 8 times that at 1 mm
    one = beyond(0.021, stiffness=1e5, onset=0.02, softness=0.0, power=1.5)
    four = beyond(0.024, stiffness=1e5, onset=0.02, softness=0.0, power=1.5)
    assert one == pytest.approx(100.0, rel=1e-9)
    assert four == pytest.approx(800.0, rel=1e-9)


def test_the_soft_onset_joins_its_limits_smoothly() -> None:
    # where the logarithm is given up for its limit, 40 lengths away, the difference is exp(-40)
    x = 0.02 + 4e-4 * np.array([-40.0 - 1e-9, -40.0 + 1e-9, 40.0 - 1e-9, 40.0 + 1e-9])
    force = [beyond(float(value), stiffness=1e5, onset=0.02, softness=4e-4) for value in x]
    assert force[1] - force[0] == pytest.approx(0.0, abs=1e-9)
    assert force[3] - force[2] == pytest.approx(1e5 * 4e-4 * 2e-9, abs=1e-6)


def test_a_rim_does_not_press_a_tire_in_the_air() -> None:
    assert drive(only("bottoming", stiffness=1e5, onset=0.0, softness=0.01), [0.0], [-1e-3])[0] == 0.0
