"""A gauge at the end of its travel is seen, and a hold, a ring or a quick peak is not taken for one."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray
from tirelab.regressors.end_of_travel import beyond_travel, said_of

FloatArray = NDArray[np.float64]
TIME = np.linspace(0.0, 6.0, 2401)
MOTION = 0.012 - 0.012 * np.cos(2.0 * np.pi * 0.5 * TIME)
FORCE = 8e4 * MOTION * (1.0 + 30.0 * MOTION)


def noisy(reading: FloatArray, seed: int = 0) -> FloatArray:
    return reading + np.random.default_rng(seed).normal(0.0, 8e-6, reading.size)


def test_a_clipped_reading_is_found_where_it_is_clipped() -> None:
    end = 0.021
    found = beyond_travel(noisy(np.minimum(MOTION, end)), FORCE)
    assert found[end < MOTION].mean() > 0.99
    assert found[end - 1e-3 > MOTION].sum() == 0


def test_at_the_other_end_too() -> None:
    end = -0.009
    pulled = MOTION - 0.012
    found = beyond_travel(noisy(np.maximum(pulled, end)), 8e4 * pulled)
    assert found[pulled < end].mean() > 0.99
    assert found[pulled > end + 1e-3].sum() == 0


@pytest.mark.parametrize("step", [0.0, 5e-5])
def test_a_peak_that_was_followed_is_none(step: float) -> None:
    reading = noisy(MOTION) if step == 0.0 else step * np.round(MOTION / step)
    assert not beyond_travel(reading, FORCE).any()


def test_the_force_relaxes_in_a_hold() -> None:
    ramp = np.minimum(0.01 * TIME, 0.02)
    force = 8e4 * ramp * (1.0 - 0.2 * (1.0 - np.exp(-np.maximum(TIME - 2.0, 0.0))))
    assert not beyond_travel(noisy(ramp), force).any()


def test_a_frame_rings_in_a_hold() -> None:
    ramp = np.minimum(0.01 * TIME, 0.02)
    since = np.maximum(TIME - 2.0, 0.0)
    force = 8e4 * ramp + 120.0 * np.sin(2.0 * np.pi * 3.0 * since) * np.exp(-2.0 * since)
    assert not beyond_travel(noisy(ramp), force).any()


@dataclass(frozen=True)
class Read:
    name: str = "clipped"
    time: FloatArray = field(default_factory=lambda: TIME)
    deflection: FloatArray = field(default_factory=lambda: noisy(np.minimum(MOTION, 0.021)))
    force: FloatArray = field(default_factory=lambda: FORCE)
    surface_radius: FloatArray = field(default_factory=lambda: np.full(TIME.size, np.inf))


def test_it_is_said_with_recording_and_place() -> None:
    said = said_of([Read(), Read("whole", deflection=noisy(MOTION))])
    assert said.startswith("In clipped the deflection's reading stands still at 21 mm in ")
    assert "whole" not in said
