"""A loop and its turns."""

import numpy as np
import pytest
from part_readings import recording
from tirelab.identification.both_ways import loop_state, passed_both_ways


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
