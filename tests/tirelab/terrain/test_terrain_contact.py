"""Wheel and ground as two circles, where every length has a closed form, and against a brute search on rough ground."""

import numpy as np
import pytest
from tirelab.errors import TirelabError
from tirelab.terrain import (
    Ground,
    Profile,
    contact,
    flat,
    from_function,
    ground_from,
    hub_positions,
    iso8608,
    place,
    reach,
    rolling_path,
    rut,
    sine,
    stick,
)

WHEEL = 0.33


def bump(radius: float, spacing: float = 0.002) -> tuple[Ground, float]:
    """Return a part of a circle of `radius` [m], convex > 0, and where its middle lies, at z = 0."""
    half = min(0.75 * abs(radius), 0.7)
    profile = from_function(
        lambda s: np.sign(radius) * (np.sqrt(radius**2 - (s - half) ** 2) - abs(radius)), 2.0 * half, spacing
    )
    return ground_from(profile, spacing), half


@pytest.mark.parametrize("deflection", [0.03175, 0.0127, 0.001])
def test_flat_ground(deflection: float) -> None:
    ground = ground_from(flat(3.0))
    place_ = hub_positions(ground)
    touch = contact(ground, place_, np.full(place_.size, WHEEL - deflection))
    np.testing.assert_allclose(touch.deflection, deflection, rtol=1e-12)
    np.testing.assert_allclose(touch.contact_position, place_, atol=1e-12)
    np.testing.assert_allclose(touch.inclination, 0.0, atol=1e-12)
    chord = 2.0 * np.sqrt(WHEEL**2 - (WHEEL - deflection) ** 2)
    # d^2 = u^2 + h^2 taken as straight between samples u0, u1 of 1 cm: at most (1 cm)^2 / 4 / (u0 + u1) at either end.
    np.testing.assert_allclose(touch.section_length, chord, atol=5e-5 / (chord - 0.01))
    assert np.all(np.isposinf(touch.surface_radius))
    assert np.all(touch.zones == 1)


def test_off_the_ground_the_deflection_is_minus_the_gap() -> None:
    ground = ground_from(sine(6.0, (0.05, 2.0), spacing=0.005), 0.005)
    hub = rolling_path(ground)
    touch = contact(ground, hub_positions(ground), hub + 0.02)
    assert np.all(touch.deflection < 0.0)
    assert np.all(touch.zones == 0)
    assert np.all(touch.section_length == 0.0)
    # The gap along the normal is at most the lift, and less than it by the cosine of the ground's slope (0.16).
    assert np.all(touch.deflection >= -0.02 - 1e-6)
    assert np.all(touch.deflection < -0.02 * np.cos(0.16))


@pytest.mark.parametrize("radius", [0.584, 0.254, 0.1, -0.381, -0.584])
def test_wheel_on_a_round_surface(radius: float) -> None:
    """The article's surfaces: a wheel pressed on top of a cylinder, or into one, is two circles."""
    ground, middle = bump(radius, 0.001)
    deflection = 0.01
    wheel = min(WHEEL, 0.6 * middle)
    offsets = np.array([0.0, 0.03, -0.05]) if abs(radius) > 0.2 else np.array([0.0, 0.004, -0.006])
    # Hubs on a circle about the cylinder's axis, at which every point of it is pressed in equally deep.
    reach_ = radius + wheel - deflection
    hub = -radius + np.sign(reach_) * np.sqrt(reach_**2 - offsets**2)
    touch = contact(ground, middle + offsets, hub, wheel)
    np.testing.assert_allclose(touch.deflection, deflection, rtol=2e-5)
    np.testing.assert_allclose(touch.surface_radius, radius, rtol=2e-4)
    np.testing.assert_allclose(touch.inclination, np.arcsin(offsets / reach_), atol=2e-4)
    # Two circles of radii r and Rw, d apart: the angle at the axis is acos((r^2 + d^2 - Rw^2) / (2 r d)).
    half_angle = np.arccos((radius**2 + reach_**2 - wheel**2) / (2.0 * radius * reach_))
    expected = 2.0 * abs(radius) * min(half_angle, np.pi - half_angle)
    np.testing.assert_allclose(touch.section_length, expected, rtol=1e-3)


def test_rolling_over_a_bump_is_a_larger_circle() -> None:
    ground, middle = bump(0.5)
    position = middle + np.linspace(-0.03, 0.03, 25)
    hub = rolling_path(ground, position, 0.2)
    np.testing.assert_allclose(np.hypot(position - middle, hub + 0.5), 0.7, rtol=1e-7)


def test_rolling_touches_and_never_presses() -> None:
    ground = ground_from(iso8608("D", 60.0, 4), 0.0025)
    hub = rolling_path(ground)
    touch = contact(ground, hub_positions(ground), hub)
    # Two parabolas, one for height and one for distance, on waves of 10 cm sampled every 2.5 mm.
    np.testing.assert_allclose(touch.deflection, 0.0, atol=2e-6)


def test_rough_ground_against_a_search_over_a_hundred_times_finer_points() -> None:
    spacing = 0.01
    ground = ground_from(iso8608("D", 30.0, 2), spacing)
    fine = ground_from(iso8608("D", 30.0, 2), 1e-4)
    position = np.linspace(2.0, 28.0, 60) + 1e-3
    hub = rolling_path(ground, position) - 0.012
    touch = contact(ground, position, hub)
    for i in range(position.size):
        near = np.abs(fine.s - position[i]) <= WHEEL
        distance = np.hypot(fine.s[near] - position[i], fine.z[near] - hub[i])
        # The parabola's error on waves of 10 cm: 30 micrometres of 12 mm, 0.4 % of the force.
        assert touch.deflection[i] == pytest.approx(WHEEL - distance.min(), abs=5e-5)
        inside = np.flatnonzero(distance < WHEEL)
        deepest = int(np.argmin(distance))
        if touch.zones[i] == 1 and np.all(np.diff(inside) == 1):
            section = fine.curvature[near][inside]
            length = np.ptp(fine.arc[near][inside])
            assert touch.section_length[i] == pytest.approx(length, abs=2.5e-3)
            # A mean over 10 cm whose ends are known to a millimetre, of curvatures of a few per metre.
            assert touch.curvature[i] == pytest.approx(np.mean(section), abs=0.15)
        assert touch.contact_position[i] == pytest.approx(fine.s[near][deepest], abs=2e-3)


def test_curvature_and_not_radius_is_averaged() -> None:
    """On a sine's inflection bump and dip cancel: flat, where the mean radius would be anything."""
    wave, amplitude, deflection = 2.0 * np.pi / 0.4, 0.01, 0.006
    ground = ground_from(sine(4.0, (amplitude, 0.4), spacing=0.001), 0.001)
    slope = np.arctan(amplitude * wave)
    position = np.array([2.0 - (WHEEL - deflection) * np.sin(slope)])
    touch = contact(ground, position, np.array([(WHEEL - deflection) * np.cos(slope)]))
    assert touch.contact_position[0] == pytest.approx(2.0, abs=1e-4)
    assert touch.curvature_min[0] < -0.3 * amplitude * wave**2
    assert touch.curvature_max[0] > 0.3 * amplitude * wave**2
    # The section is a little longer on the side of the dip, towards which the wheel leans.
    assert abs(touch.curvature[0]) < 0.15 * amplitude * wave**2


def test_mean_curvature_of_a_corner_is_its_turn_per_length() -> None:
    slope = 0.2
    ground = ground_from(from_function(lambda s: -slope * np.abs(s - 1.5), 3.0, 0.002), 0.002)
    middle = np.array([1.5])
    touch = contact(ground, middle, rolling_path(ground, middle) - 0.01)
    # On symmetric ramps the circle about (0, h) crosses -slope u at u = (h slope + sqrt(...)) / (1 + slope^2).
    h = touch.hub_height[0]
    cross = (-h * slope + np.sqrt((h * slope) ** 2 + (1.0 + slope**2) * (WHEEL**2 - h**2))) / (1.0 + slope**2)
    length = 2.0 * cross * np.hypot(1.0, slope)
    assert touch.section_length[0] == pytest.approx(length, rel=2e-3)
    assert touch.curvature[0] == pytest.approx(2.0 * np.arctan(slope) / length, rel=2e-3)


def test_a_rut_is_bridged_with_two_contacts() -> None:
    ground = ground_from(place(flat(4.0), rut(0.1, 0.3), 2.0), 0.002)
    middle = np.array([2.0])
    touch = contact(ground, middle, rolling_path(ground, middle) - 0.005)
    assert touch.zones[0] == 2
    away = np.array([1.0])
    assert contact(ground, away, rolling_path(ground, away) - 0.005).zones[0] == 1


def test_wheel_climbs_a_stick_pushed_back_and_leaves_it_pushed_on() -> None:
    ground = ground_from(place(flat(4.0), stick(0.03), 2.0), 0.001)
    position = np.array([1.88, 2.12])
    touch = contact(ground, position, rolling_path(ground, position) - 0.001)
    assert touch.inclination[0] < 0.0 < touch.inclination[1]
    assert touch.inclination[0] == pytest.approx(-touch.inclination[1], abs=1e-3)


def test_a_kilometre_at_one_centimetre() -> None:
    ground = ground_from(iso8608("D", 1000.0, 1), 0.01)
    touch = contact(ground, hub_positions(ground), rolling_path(ground) - 0.01)
    assert touch.deflection.size > 99_000
    # pressed down by 10 mm from where it just touches, the wheel is pressed in by 10 mm at most, along the normal;
    # the ground between two of its points 10 mm apart is rougher than a line by some hundredths of that
    assert touch.deflection.min() > 0.0
    assert touch.deflection.max() <= 0.0101


def test_hub_beneath_the_ground() -> None:
    ground = ground_from(flat(3.0))
    with pytest.raises(TirelabError, match=r"the hub is beneath the ground at s = 1.5 m"):
        contact(ground, np.array([1.0, 1.5]), np.array([0.3, -0.1]))


@pytest.mark.parametrize(
    ("position", "hub", "sentence"),
    [
        ([0.1], [0.33], r"the hub at s = 0.1 m has not the whole wheel over flat ground; keep it between"),
        ([2.9], [0.33], r"the hub at s = 2.9 m"),
        ([], [], "at least one"),
        ([np.nan], [0.33], "finite"),
        ([1.0], [np.nan], "finite"),
        ([1.0, 1.1], [0.33], "one for each position"),
    ],
)
def test_bad_paths(position: list[float], hub: list[float], sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence):
        contact(ground_from(flat(3.0)), np.array(position), np.array(hub))


def test_ground_shorter_than_the_wheel() -> None:
    with pytest.raises(TirelabError, match=r"0\.5 m long; a wheel of 0\.33 m radius needs more"):
        reach(ground_from(flat(0.5)))
    with pytest.raises(TirelabError, match="wheel radius 0 m"):
        reach(ground_from(flat(3.0)), 0.0)


def test_ground_need_not_start_at_zero() -> None:
    shifted = Profile(np.linspace(1e5, 1e5 + 3.0, 301), np.zeros(301))
    ground = ground_from(shifted)
    place_ = hub_positions(ground)
    touch = contact(ground, place_, np.full(place_.size, 0.32))
    np.testing.assert_allclose(touch.deflection, 0.01, rtol=1e-9)
