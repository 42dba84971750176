"""Which recordings are drawn."""

from __future__ import annotations

from typing import Any

from tirelab.report.loops import Case
from tirelab.report.pictures import MOST_LOOPS, loops, residuals


def cases(made: Any) -> list[Case]:
    return [Case(r, b, a) for r, b, a in zip(made.recordings, made.before, made.after, strict=True)]


def test_the_largest_misfit_has_a_pair_and_some_others_a_picture(kinds: dict[str, Any]) -> None:
    fitted = cases(kinds["two"])
    drawn = loops(fitted, fitted[:1])
    assert drawn["name"] == max(fitted, key=lambda c: c.excess).recording.name
    assert len(drawn["pair"]) == 2
    assert len(drawn["others"]) == MOST_LOOPS - 1
    assert len(drawn["others"]) + drawn["missing"] + 1 == len(fitted) + 1


def test_without_a_correction_there_is_one_loop_and_one_map(kinds: dict[str, Any]) -> None:
    fitted = cases(kinds["unknown"])
    assert len(loops(fitted, [])["pair"]) == 1
    seen = residuals(fitted, 6.0)
    assert seen["alike"]
    assert (len(seen["lines"]), len(seen["maps"])) == (4, 1)
    assert len(residuals(cases(kinds["one"]), 6.0)["maps"]) == 2
