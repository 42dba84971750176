"""What holds on any ground: moving it, mirroring it, lowering the hub."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tirelab.terrain import Profile, contact, ground_from, rolling_path
from tirelab.terrain.curvature import Ground

HEIGHTS = st.lists(st.floats(-0.15, 0.15), min_size=12, max_size=12)
DROPS = st.floats(1e-3, 0.03)


def wavy(heights: list[float]) -> Ground:
    """Return 2.4 m of ground through `heights`, a point every 0.2 m and flat at its ends."""
    s = np.arange(14) * 0.2
    profile = Profile(s, np.concatenate([[0.0], heights, [0.0]]))
    return ground_from(profile, 0.01)


HUBS = np.array([0.9, 1.3, 1.7])


@settings(max_examples=40, deadline=None)
@given(HEIGHTS, DROPS)
def test_lowering_the_hub_deepens_the_contact_by_no_more(heights: list[float], drop: float) -> None:
    ground = wavy(heights)
    hub = rolling_path(ground, HUBS)
    high, low = contact(ground, HUBS, hub - 0.5 * drop), contact(ground, HUBS, hub - drop)
    gain = low.deflection - high.deflection
    # The parabola between samples of 1 cm is good to a few hundredths of a millimetre on such waves.
    assert np.all(gain > 0.0)
    assert np.all(gain <= 0.5 * drop + 1e-4)
    assert np.all(low.section_length >= high.section_length - 1e-3) or np.any(low.zones != high.zones)


@settings(max_examples=40, deadline=None)
@given(HEIGHTS, DROPS)
def test_mirrored_ground_is_met_mirrored(heights: list[float], drop: float) -> None:
    ground, mirror = wavy(heights), wavy(heights[::-1])
    there = 2.6 - HUBS
    np.testing.assert_allclose(rolling_path(ground, HUBS), rolling_path(mirror, there), atol=1e-9)
    hub = rolling_path(ground, HUBS) - drop
    one, other = contact(ground, HUBS, hub), contact(mirror, there, hub)
    np.testing.assert_allclose(one.deflection, other.deflection, atol=1e-9)
    single = (one.zones == 1) & (other.zones == 1)
    np.testing.assert_allclose(one.inclination[single], -other.inclination[single], atol=1e-6)
    np.testing.assert_allclose(one.curvature[single], other.curvature[single], atol=1e-6)


@settings(max_examples=40, deadline=None)
@given(HEIGHTS, DROPS, st.floats(-500.0, 3000.0))
def test_contact_does_not_care_where_the_ground_lies(heights: list[float], drop: float, rise: float) -> None:
    ground = wavy(heights)
    s = np.arange(14) * 0.2
    moved = ground_from(Profile(s + 100.0, np.concatenate([[0.0], heights, [0.0]]) + rise), 0.01)
    hub = rolling_path(ground, HUBS)
    one = contact(ground, HUBS, hub - drop)
    other = contact(moved, HUBS + 100.0, hub + rise - drop)
    np.testing.assert_allclose(one.deflection, other.deflection, atol=1e-7)
    np.testing.assert_allclose(one.curvature, other.curvature, atol=1e-5)


@settings(max_examples=40, deadline=None)
@given(HEIGHTS)
def test_turn_per_length_is_the_mean_of_the_curvature(heights: list[float]) -> None:
    ground = wavy(heights)
    hub = rolling_path(ground, HUBS) - 0.02
    touch = contact(ground, HUBS, hub)
    for i in np.flatnonzero(touch.zones == 1):
        inside = np.hypot(ground.s - HUBS[i], ground.z - hub[i]) < 0.33
        curvature, arc = ground.curvature[inside], ground.arc[inside]
        mean = np.trapezoid(curvature, arc) / np.ptp(arc)
        # Up to a sample at either end of the section, 1 cm along the ground, is missing from the sum.
        missing = touch.section_length[i] - np.ptp(arc)
        assert 0.0 <= missing < 0.04
        spread = touch.curvature_max[i] - touch.curvature_min[i]
        assert abs(touch.curvature[i] - mean) <= missing / touch.section_length[i] * spread + 0.02
