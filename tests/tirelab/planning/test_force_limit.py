"""How deep a rig may go within a force."""

import math

import pytest
from tirelab.planning.force_limit import HALVINGS, depth_within, limits_within_force
from tirelab.planning.waveforms import Limits


@pytest.mark.parametrize("force", [1.0, 100.0, 399.0])
def test_a_spring_is_pressed_until_its_force_is_reached_and_no_deeper(force: float) -> None:
    depth = depth_within(force, 0.02, lambda x: 20e3 * x)
    assert 20e3 * depth <= force
    assert depth == pytest.approx(force / 20e3, abs=0.02 * 0.5**HALVINGS)


def test_a_stroke_that_stays_within_the_force_is_left_as_it_is() -> None:
    assert depth_within(400.0, 0.02, lambda x: 20e3 * x) == 0.02
    assert depth_within(math.inf, 0.02, lambda x: pytest.fail("nothing limits it")) == 0.02


def test_a_preload_beyond_the_force_leaves_no_stroke() -> None:
    assert depth_within(50.0, 0.02, lambda x: 60.0 + 20e3 * x) == 0.0
    assert limits_within_force(Limits(force=50.0), lambda to: 60.0 + 20e3 * to.deepest) is None


def test_of_limits_the_stroke_alone_changes() -> None:
    limits = Limits(deepest=0.02, fastest=0.3, force=100.0)
    found = limits_within_force(limits, lambda to: 20e3 * to.deepest)
    assert found is not None
    assert found.deepest == pytest.approx(0.005, rel=0.01)
    assert (found.fastest, found.force, found.longest) == (0.3, 100.0, limits.longest)


@pytest.mark.parametrize("force", [0.0, -1.0, math.nan, "100 N"])
def test_no_force_is_no_limit_of_a_rig(force: object) -> None:
    with pytest.raises(ValueError, match=r"is no limit of a rig; give a number \[N\] above 0"):
        Limits(force=force)  # type: ignore[arg-type]
