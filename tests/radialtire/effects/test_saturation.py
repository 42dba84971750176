"""A ceiling of the force channel."""

from __future__ import annotations

import math

import numpy as np
import pytest
from driving import LINEAR, STIFFNESS, drive, only

X = np.linspace(0.0, 0.03, 301)
TIME = np.arange(301.0)


def test_a_hard_ceiling_cuts() -> None:
    force = drive(only("saturation", law=LINEAR, limit=1500.0), TIME, X)
    assert force == pytest.approx(np.minimum(STIFFNESS * X, 1500.0), rel=1e-14)
    assert force.max() == 1500.0


def test_a_soft_ceiling_is_never_passed_and_nowhere_far_from_the_hard_one() -> None:
    # the greatest distance is at the limit: k ln 2
    force = drive(only("saturation", law=LINEAR, limit=1500.0, knee=20.0), TIME, X)
    hard = np.minimum(STIFFNESS * X, 1500.0)
    assert np.all(np.diff(force) > -1e-9)
    assert np.all(force <= 1500.0)
    assert np.max(hard - force) == pytest.approx(20.0 * math.log(2.0), rel=1e-9)
    assert np.min(hard - force) > -1e-9


def test_the_knee_joins_its_limits_smoothly() -> None:
    x = (1500.0 + 20.0 * np.array([-40.0 - 1e-7, -40.0 + 1e-7, 40.0 - 1e-7, 40.0 + 1e-7])) / STIFFNESS
    force = drive(only("saturation", law=LINEAR, limit=1500.0, knee=20.0), np.arange(4.0), x)
    assert force[1] - force[0] == pytest.approx(4e-6, abs=1e-7)
    assert force[3] - force[2] == pytest.approx(0.0, abs=1e-9)
