"""Obstacles have the sizes and radii they are given, and nothing a wheel reaches is invented."""

import math

import numpy as np
import pytest
from tirelab.errors import TirelabError
from tirelab.terrain import (
    OBSTACLES,
    Profile,
    flat,
    ground_from,
    iso8608,
    kerb,
    log,
    place,
    root,
    rut,
    stick,
    whoops,
)


@pytest.mark.parametrize(
    ("obstacle", "lowest", "highest", "end"),
    [
        (stick(0.0127), 0.0, 0.0254, 0.0),
        (log(), 0.0, 0.20, 0.0),
        (log(0.1, 0.04), 0.0, 0.16, 0.0),
        (root(), 0.0, 0.05, 0.0),
        (rut(), -0.08, 0.0, 0.0),
        (whoops(), 0.0, 0.3, 0.0),
        (kerb(), 0.0, 0.1, 0.1),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_heights(obstacle: "object", lowest: float, highest: float, end: float) -> None:
    z = obstacle.z  # type: ignore[attr-defined]
    assert z.min() == pytest.approx(lowest, abs=1e-12)
    assert z.max() == pytest.approx(highest, abs=1e-12)
    assert z[-1] == pytest.approx(end, abs=1e-12)


def test_a_log_is_a_circle_on_the_ground() -> None:
    shape = log(0.1)
    top = shape.z > 0.15
    np.testing.assert_allclose(np.hypot(shape.u[top], shape.z[top] - 0.1), 0.1, rtol=1e-12)


def test_a_wheel_rests_on_log_and_ground_clear_of_the_corner() -> None:
    """A circle that touches ground and log meets the log at an angle whose cosine is (Rw - R) / (Rw + R)."""
    radius, wheel = 0.1, 0.33
    shape = log(radius)
    distance = math.sqrt((wheel + radius) ** 2 - (wheel - radius) ** 2)
    gap = np.hypot(shape.u + distance, shape.z - wheel) - wheel
    assert gap.min() == pytest.approx(0.0, abs=1e-4)
    touching = np.argmin(gap)
    assert math.acos((wheel - radius) / (wheel + radius)) < math.acos(1.0 / 3.0)
    assert math.hypot(shape.u[touching], shape.z[touching] - radius) == pytest.approx(radius, rel=1e-9)


@pytest.mark.parametrize("name", OBSTACLES)
def test_ground_with_an_obstacle_is_smooth_and_keeps_its_radii(name: str) -> None:
    ground = ground_from(place(flat(16.0), OBSTACLES[name](), 8.0))
    sharpest = {"stick": 0.015, "log": 0.1, "root": 0.05, "kerb": 0.02}
    if name in sharpest:
        round_part = np.quantile(ground.curvature[ground.curvature > 1.0], 0.5)
        assert round_part == pytest.approx(1.0 / sharpest[name], rel=0.02)
    assert np.max(np.abs(ground.direction)) < math.radians(80.0)


def test_rut_has_the_radius_of_its_formula() -> None:
    # z'' at the bottom of -d (1 - (2u/w)^2)^3 is 24 d / w^2.
    ground = ground_from(place(flat(4.0), rut(0.04, 0.5), 2.0), 0.002)
    assert ground.curvature.min() == pytest.approx(-24.0 * 0.04 / 0.25, rel=2e-3)


def test_whoops_have_the_radius_of_their_formula() -> None:
    # (height / 2) (2 pi / wavelength)^2 at a crest away from the ends.
    ground = ground_from(place(flat(16.0), whoops(4, 0.3, 2.5), 8.0), 0.01)
    crest = np.argmin(np.abs(ground.s - (8.0 - 1.25)))
    assert ground.curvature[crest] == pytest.approx(0.15 * (2.0 * np.pi / 2.5) ** 2, rel=1e-3)


def test_a_kerb_stays_up() -> None:
    profile = place(flat(4.0), kerb(0.12), 2.0)
    assert profile.z[-1] == pytest.approx(0.12)
    assert profile.z[0] == 0.0


def test_obstacle_is_added_to_the_ground_that_is_there() -> None:
    slope = Profile(np.linspace(0.0, 4.0, 401), 0.1 * np.linspace(0.0, 4.0, 401))
    profile = place(slope, root(), 2.0)
    assert np.max(profile.z - 0.1 * profile.s) == pytest.approx(0.05, abs=1e-9)
    rough = iso8608("C", 30.0, 1)
    both = place(rough, log(), 15.0)
    away = np.abs(both.s - 15.0) > 1.0
    # CubicSpline through a point gives back the point.
    np.testing.assert_allclose(both.z[away], np.interp(both.s[away], rough.s, rough.z), atol=1e-12)


def test_noise_is_smoothed_before_and_not_after() -> None:
    noisy = Profile(np.arange(401) * 0.01, 1e-3 * np.random.default_rng(0).normal(size=401), "trail", 0.1)
    profile = place(noisy, log(), 2.0)
    assert profile.smoothing_length == 0.0
    assert "smoothed over 0.1 m before log was added" in profile.notes[-1]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: log(-0.1), "log: radius is -0.1"),
        (lambda: log(0.1, 0.2), "sink it by 0 m to its radius"),
        (lambda: kerb(0.01), "too low"),
        (lambda: kerb(face_angle=math.radians(90.0)), "face at 90 degrees"),
        (lambda: whoops(height=math.nan), "whoops: height is nan"),
        (lambda: place(flat(4.0), log(), 3.95), "does not fit on flat ground"),
        (lambda: place(flat(4.0), log(), math.nan), "does not fit"),
    ],
)
def test_bad_sizes(call: "object", sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence):
        call()  # type: ignore[operator]
