"""The command that halves and doubles each number changes that number alone, and what is made of it."""

from __future__ import annotations

import ast

import numpy as np
import pytest
from constants import constants
from sensitivity import SCALED, changed, scaled, tried

SOURCE = """
COUNT, PART = 5, 0.25
LIST = (0.1, 3)
GRID = 2.0 * base
MADE = 4 + COUNT
"""


def _after(name: str, factor: float) -> dict[str, object]:
    names: dict[str, object] = {"base": np.array([1.0, 2.0]), SCALED: scaled}
    exec(compile(changed(ast.parse(SOURCE), name, factor), "source", "exec"), names)
    return names


def test_one_number_is_changed_and_what_is_made_of_it() -> None:
    after = _after("COUNT", 2.0)
    assert (after["COUNT"], after["MADE"], after["PART"], after["LIST"]) == (10, 14, 0.25, (0.1, 3))


def test_parts_of_a_pair_are_numbers_of_their_own() -> None:
    assert (_after("PART", 0.5)["PART"], _after("PART", 0.5)["COUNT"]) == (0.125, 5)


def test_whole_numbers_stay_whole_and_above_nothing() -> None:
    assert _after("LIST", 0.5)["LIST"] == (0.05, 2)
    assert scaled(1, 0.5) == 1


def test_of_a_number_near_one_the_distance_from_one_is_changed() -> None:
    assert scaled(0.9, 2.0) == pytest.approx(0.8)
    assert scaled(1.01, 0.5) == pytest.approx(1.005)
    assert (scaled(1.0, 2.0), scaled(0.5, 2.0), scaled(2.0, 0.5)) == (2.0, 1.0, 1.0)


def test_arrays_are_changed_as_a_whole() -> None:
    assert np.array_equal(_after("GRID", 0.5)["GRID"], [1.0, 2.0])  # type: ignore[arg-type]


def test_a_name_that_is_not_there_is_refused() -> None:
    with pytest.raises(ValueError, match="0 numbers are named NOWHERE"):
        changed(ast.parse(SOURCE), "NOWHERE", 2.0)


def test_all_trials_are_gone_round() -> None:
    numbers = [c.place for c in constants()[:4]]
    given = [keys for _, keys in tried(numbers, ["a", "b", "c"], 2)]
    assert given == [["a", "b"], ["c", "a"], ["b", "c"], ["a", "b"]]
