"""The motions to choose from, and the rows in which they are compared."""

import math
from dataclasses import replace

import numpy as np
import pytest
from radialtire import TireModel
from tirelab.planning.menu import drive_of, experiment_of, menu, peak_force
from tirelab.planning.rig import Rig

RIG = Rig(stroke=0.02, speed=0.1, surfaces=(math.inf, 0.254), time=80.0, noise=6.0)


def test_every_motion_keeps_within_the_limits() -> None:
    drives = menu(RIG)
    assert {d.surface for d in drives} == {"flat", "radius 25.4 cm"}
    for drive in drives:
        assert drive.fastest <= 0.1 * 1.02
        assert drive.deflection.max() <= 0.02 + 1e-12
        assert drive.duration <= 0.25 * 80.0 + 0.005


def test_pressures_are_held_the_others_by_slow_triangles_and_none_where_none_is_given() -> None:
    assert {d.pressure for d in menu(RIG)} == {None}
    drives = menu(replace(RIG, pressures=(2e5, 3e5)))
    assert len([d for d in drives if d.pressure == 2e5]) == len(menu(RIG))
    others = [d for d in drives if d.pressure != 2e5]
    assert {(d.pressure, d.name) for d in others} == {(3e5, "slow triangles")}
    assert others[0].measured["pressure"].tolist() == [3e5] * others[0].time.size


def test_a_motion_that_is_too_fast_for_the_rig_is_left_out() -> None:
    """A short "cycles, rest, cycles": 9 strokes of twice 20 mm in 2.5 s would be 144 mm/s."""
    names = [(d.name, round(d.duration, 1)) for d in menu(replace(RIG, time=40.0))]
    assert ("cycles, rest, cycles", 2.5) not in names
    assert ("cycles, rest, cycles", 10.0) in names


def test_a_row_stands_for_as_many_samples_as_it_averages() -> None:
    slow = drive_of("slow triangles", 0.25, math.inf, RIG)
    found = experiment_of(slow, TireModel(), 6.0)
    assert found.size > 1
    assert found.noise == pytest.approx(6.0 / math.sqrt(found.size))
    assert found.time.size == pytest.approx(slow.time.size / found.size, abs=1)
    assert np.all(found.misfit == 0.0)


def test_corners_are_not_compared_and_the_rest_is() -> None:
    fast = experiment_of(drive_of("fast triangles", 0.25, math.inf, RIG), TireModel(), 6.0)
    assert 0.5 < fast.counts.mean() < 1.0
    assert np.abs(fast.acceleration[fast.counts]).max() < 0.05 * np.abs(fast.acceleration).max()
    assert np.abs(np.abs(fast.rate[fast.counts]) - 0.1).max() < 1e-6


def test_a_slow_corner_shows_no_inertia_and_a_sine_does() -> None:
    """A triangle has no acceleration but in its corners, which an actuator rounds in its own way."""
    rates = experiment_of(drive_of("triangles at three rates", 0.25, math.inf, RIG), TireModel(), 6.0)
    assert rates.counts.mean() > 0.8
    assert np.abs(rates.acceleration[rates.counts]).max() < 1e-6
    sine = experiment_of(drive_of("fast sine", 0.25, math.inf, RIG), TireModel(), 6.0)
    assert sine.counts.mean() > 0.95
    swing = 0.3 * RIG.stroke
    assert np.abs(sine.acceleration[sine.counts]).max() == pytest.approx(RIG.speed**2 / swing, rel=0.03)


def test_the_largest_force_is_the_articles() -> None:
    """550.9 x^1.422 at 2 cm on flat ground; a convex surface yields more."""
    drives = [d for d in menu(RIG) if math.isinf(d.surface_radius[0])]
    assert peak_force(drives, TireModel()) == pytest.approx(550.9 * 2.0**1.422, rel=1e-3)
