"""A loop and its turns."""

import numpy as np
import pytest
from part_readings import recording
from radialtire import PowerLaw, TireModel
from tirelab.identification.both_ways import common_curve, loop_state, passed_both_ways


def test_a_loop_goes_from_one_way_to_the_other_within_twice_its_reach() -> None:
    """In by ten reaches, back by one and by two: 1, then 0, then -1, and the limits are kept."""
    x = np.array([0.0, 0.5, 10.0, 9.0, 8.0, 2.0, 3.0])
    assert loop_state(x, 1.0) == pytest.approx([0.0, 0.5, 1.0, 0.0, -1.0, -1.0, 0.0])


def test_a_state_depends_on_the_way_and_not_on_its_samples() -> None:
    way = np.abs(np.linspace(-3.0, 3.0, 601))
    assert loop_state(way, 0.25)[::20] == pytest.approx(loop_state(way[::20], 0.25))


@pytest.mark.parametrize(("back", "both"), [(1.0, True), (0.3, False), (0.0, False)])
def test_a_part_is_passed_both_ways_where_it_comes_back_through_most_places(back: float, both: bool) -> None:
    way = np.linspace(0.0, 0.02, 500)
    x = np.concatenate([way, way[::-1][: int(back * 500)]])
    assert passed_both_ways([recording(x, 1e4 * x)]) is both


@pytest.mark.parametrize(("creeps", "told"), [(0.0, 24.0), (5e-4, 0.0)])
def test_what_cycles_of_a_part_that_creeps_have_apart_is_no_curve_of_the_deflection(
    creeps: float, told: float
) -> None:
    """Ten cycles of 1 mm beside a spring of 1e4 N/m: a wave of 34 N over the deflection, and of a part that creeps by
    half a millimetre in each cycle a force of 34 N that changes from cycle to cycle.
    """
    cycle = np.arange(2000) // 200
    way = 5e-4 * (1.0 - np.cos(2.0 * np.pi * np.arange(2000) / 200.0))
    x = way + creeps * cycle
    extra = 34.0 * (np.cos(2.0 * np.pi * x / 5e-4) if creeps == 0.0 else np.sin(2.2 * cycle))
    spring = TireModel(PowerLaw(100.0, 1.0), two_sided=True, inflated=False, preload=0.0, tested_range=None)
    found, _ = common_curve([recording(x, 1e4 * x + extra)], spring)
    assert found == pytest.approx(told, rel=0.1)
