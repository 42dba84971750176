"""The coordinates of samples cut into bins: equal counts, true bounds, names for parts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import Drive, flat_force, read, ride
from radialtire import TireModel
from tirelab.diagnosis.binning import BINS, Axis, axes_of
from tirelab.preprocessing.samples import raw_dataset_of


def press(cycles: int = 3, radius: float = np.inf, name: str = "press") -> Drive:
    """Triangles of 10 s to 20 mm."""
    time = np.arange(1000 * cycles) * 0.01
    deflection = 0.02 * (1.0 - np.abs(1.0 - 2.0 * (time / 10.0 % 1.0)))
    drive = read(name, time, deflection, flat_force(deflection), 1)
    return replace(drive, surface_radius=np.full(time.size, radius))


def axes(*drives: Drive) -> dict[str, Axis]:
    dataset = raw_dataset_of(drives, TireModel())
    kept = [np.arange(e.rows.size) for e in dataset.experiments]
    return {axis.by: axis for axis in axes_of(drives, dataset, kept)}


def test_a_single_press_has_every_coordinate_but_the_recording():
    assert list(axes(press())) == [
        *("deflection", "rate", "acceleration", "force", "history", "time", "direction", "cycle", "radius"),
    ]
    assert "cycle" not in axes(press(cycles=1))


def test_bins_hold_about_as_many_samples_and_are_bounded_by_them():
    drive = read("ride", *ride(3)[:2], flat_force(ride(3)[1]), 4)
    found = axes(drive)["deflection"]
    dataset = raw_dataset_of([drive], TireModel())
    values = dataset.experiments[0].sampled.motion.deflection
    counts = np.bincount(found.bin_of)
    assert found.start.size == counts.size <= BINS
    # 6000 samples in 800 bins: 7 or 8 in each; none is empty.
    assert counts.min() >= 1
    assert np.median(counts) == pytest.approx(values.size / BINS, abs=1.0)
    for number in (0, 100, counts.size - 1):
        own = values[found.bin_of == number]
        assert (found.start[number], found.stop[number]) == (own.min(), own.max())
    assert np.all(found.start[1:] >= found.stop[:-1])


def test_directions_and_cycles_have_names():
    found = axes(press())
    direction = found["direction"]
    assert [direction.label(i, i) for i in range(2)] == ["unloading", "loading"]
    assert direction.parts == (0, 1, 2)
    cycle = found["cycle"]
    # Cycles are counted from 1; a turn at the end begins none.
    assert cycle.start[0] == 1.0
    assert cycle.label(0, 0) == "cycle 1"
    assert cycle.label(0, 2) == "cycles 1 to 3"


def test_the_time_of_each_recording_is_a_part_of_its_own():
    one, two = press(name="one"), press(name="two")
    late = replace(two, time=two.time + 500.0)
    found = axes(one, late)
    assert found["time"].recordings == ("one", "two")
    first, second = np.split(found["time"].start, [found["time"].parts[1]])
    assert first.max() < 30.0
    # Times are those of the recording, not counted from its first sample.
    assert second.min() == pytest.approx(500.0)
    assert found["recording"].label(1, 1) == "two"
    assert axes(one)["time"].recordings is None


def test_few_surfaces_are_parts_in_the_order_of_their_curvature():
    found = axes(*(press(radius=r, name=str(r)) for r in (np.inf, 0.1, -0.381)))["radius"]
    assert found.start.tolist() == [-0.381, np.inf, 0.1]
    assert [found.label(i, i) for i in range(3)] == [
        "concave, radius 0.381 m",
        "flat",
        "convex, radius 0.1 m",
    ]


def test_terrain_is_concave_flat_or_convex():
    """More radii than can be parts of their own make one part each for concave, flat and convex."""
    drive = press()
    curvature = np.linspace(-2.0, 2.0, drive.time.size)
    curvature[np.abs(curvature) < 0.5] = 0.0
    radius = np.where(curvature == 0.0, np.inf, 1.0 / np.where(curvature == 0.0, 1.0, curvature))
    found = axes(replace(drive, surface_radius=radius))["radius"]
    assert len(found.parts) == 4
    concave, flat, convex = (slice(a, b) for a, b in zip(found.parts[:-1], found.parts[1:], strict=True))
    assert found.start[flat].tolist() == [np.inf]
    assert found.label(found.parts[1], found.parts[1]) == "flat"
    assert np.all(found.start[concave] < 0.0)
    assert np.all(found.stop[convex] > 0.0)
    # Every bin's bounds hold radii of one sign, between the sharpest of 0.5 m and the shallowest of 2 m.
    assert np.abs(found.start[convex]).max() <= 2.01
    assert np.abs(found.start[convex]).min() == pytest.approx(0.5, rel=0.01)
