"""Numbers that stand side by side."""

from __future__ import annotations

import pytest
from tirelab.fmu.native.translation.neighbours import run_of


@pytest.mark.parametrize(
    ("texts", "count"),
    [
        (["x[3]", "x[4]", "x[5]"], 3),
        (["x[3]", "x[4]", "x[6]"], 2),
        (["x[3]", "y[4]"], 1),
        (["x[3]", "x[3]"], 1),
        (["x[i]", "x[4]"], 1),
        (["a.v[0]", "a.v[1]", "0.0"], 2),
        (["x"], 1),
    ],
)
def test_a_run_ends_where_the_next_is_no_neighbour(texts: list[str], count: int) -> None:
    assert run_of(texts) == count
