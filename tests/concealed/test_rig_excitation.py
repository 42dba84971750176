"""The motions that the actuator is given."""

import math

import numpy as np
import pytest
from concealed.alternatives import one_constant_rate
from concealed.excitation import (
    ACTUATOR_SPEED,
    EXCITATIONS,
    FEWEST_RIG_SAMPLES,
    MOST_RIG_SAMPLES,
    DepthLimits,
)
from concealed.motion import rounded

FLAT = DepthLimits((math.inf,), (0.025,))
THREE = DepthLimits((math.inf, 0.0508, -0.381), (0.025, 0.03, 0.02))


@pytest.mark.parametrize("name", EXCITATIONS)
@pytest.mark.parametrize("reach", [FLAT, THREE], ids=["one surface", "three surfaces"])
def test_every_test_stays_within_the_rig(name: str, reach: DepthLimits) -> None:
    for seed in range(6):
        motion = EXCITATIONS[name](np.random.default_rng(seed), reach)
        samples = motion.recorded(motion.time).size
        assert 0.9 * FEWEST_RIG_SAMPLES <= samples <= MOST_RIG_SAMPLES + 1
        assert motion.time.size <= MOST_RIG_SAMPLES * 1.2
        assert np.all(np.diff(motion.time) > 0.0)
        assert 0.0024 < motion.sample_step <= 0.5
        assert set(motion.surfaces) == set(reach.surfaces)
        assert np.min(motion.deflection) >= -1e-12
        for radius, deepest in zip(reach.surfaces, reach.deepest, strict=True):
            assert np.max(motion.deflection[motion.radius == radius]) <= deepest * (1.0 + 1e-9)
        assert np.max(np.abs(motion.rate)) < 1.2 * ACTUATOR_SPEED


def test_the_articles_test() -> None:
    """A triangle wave with a period of 30 s, recorded at 5 Hz."""
    motion = EXCITATIONS["article_triangle"](np.random.default_rng(0), FLAT)
    assert motion.sample_step == pytest.approx(0.2)
    x = motion.recorded(motion.deflection)
    peaks = np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] > x[2:])) + 1
    assert np.diff(peaks) * 0.2 == pytest.approx(30.0, abs=0.2)


def test_triangles_change_the_surface_unloaded() -> None:
    for name in ("article_triangle", "many_rates_triangle", "growing_triangle", "ramp_and_hold"):
        motion = EXCITATIONS[name](np.random.default_rng(2), THREE)
        changes = np.flatnonzero(np.diff(1.0 / motion.radius))
        assert changes.size == 2
        assert np.all(motion.deflection[changes] < 0.06 * min(THREE.deepest)), "rounded corners"


def test_one_constant_rate_is_recognised() -> None:
    rng = np.random.default_rng(4)
    slow = EXCITATIONS["article_triangle"](rng, FLAT)
    assert one_constant_rate((slow,))
    assert not one_constant_rate((EXCITATIONS["article_triangle"](rng, THREE),))
    for name in ("many_rates_triangle", "ramp_and_hold", "sine", "ride", "sweep"):
        assert not one_constant_rate((EXCITATIONS[name](rng, FLAT),)), name
        assert not one_constant_rate((slow, EXCITATIONS[name](rng, FLAT))), name


def test_rounding_keeps_straight_lines_and_ends() -> None:
    """A mean over a symmetric span leaves a straight line as it is."""
    path = np.concatenate([np.linspace(0.0, 1.0, 101), np.linspace(1.0, 0.0, 101)[1:]])
    smooth = rounded(path, 0.01, 0.1)
    assert smooth.size == path.size
    assert smooth[20:90] == pytest.approx(path[20:90], abs=0.01)
    assert np.max(np.abs(np.diff(smooth, 2))) < 0.25 * np.max(np.abs(np.diff(path, 2)))
