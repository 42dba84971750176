"""Every number between a recording and its verdict stands in one table."""

from __future__ import annotations

from pathlib import Path

from constants import BESIDE, BUDGET, CALIBRATED, DERIVED, constants, page

PAGE = Path(__file__).parents[1] / "examples" / "docs" / "constants.md"


def test_the_page_is_what_the_source_says() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), (
        "run: python tests/constants.py > examples/docs/constants.md"
    )


def test_no_kind_is_told_of_a_number_that_is_gone() -> None:
    known = {c.place for c in constants()}
    assert not {*DERIVED, *CALIBRATED, *BUDGET} - known


def test_every_number_says_what_it_is() -> None:
    assert [c.place for c in constants() if not c.words] == []


def test_what_is_said_to_stand_beside_a_verdict_is_there() -> None:
    places = [c.place for c in constants()]
    assert all(any(p == b or p.startswith(b + ".") for p in places) for b in BESIDE)
