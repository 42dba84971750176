"""Every number between a recording and its verdict stands in one table."""

from __future__ import annotations

from pathlib import Path

from constant_kinds import ARITHMETIC, BESIDE, BOUNDS, DERIVED, EFFORT, PRIOR
from constants import constants, page, within_functions

PAGE = Path(__file__).parents[1] / "examples" / "docs" / "constants.md"


def test_the_page_is_what_the_source_says() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), (
        "run: python tests/constants.py > examples/docs/constants.md"
    )


def test_no_kind_is_told_of_a_number_that_is_gone() -> None:
    known = {c.place for c in constants()}
    assert not {*DERIVED, *PRIOR, *EFFORT} - known
    assert set(BOUNDS) <= set(EFFORT)


def test_few_numbers_are_set_by_hand() -> None:
    """At most 25 that are not derived, the effort being one of them: it is scaled as a whole."""
    chosen = [c.place for c in constants() if c.kind == "chosen" and not c.beside]
    assert len(chosen) + 1 <= 25, chosen


def test_every_number_says_what_it_is() -> None:
    assert [c.place for c in constants() if not c.words] == []


def test_what_is_said_to_stand_beside_a_verdict_is_there() -> None:
    places = [c.place for c in constants()]
    assert all(any(p == b or p.startswith(b + ".") for p in places) for b in BESIDE)


def test_no_function_decides_with_a_number_that_has_no_name() -> None:
    """Such a number would be in no table: give it a name, its kind and its words, or say what it is (ARITHMETIC)."""
    found = within_functions()
    assert {key: line for key, line in found.items() if key not in ARITHMETIC} == {}
    assert set(ARITHMETIC) <= set(found)
