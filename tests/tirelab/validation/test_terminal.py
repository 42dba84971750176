"""The table of acceptance criteria as a terminal shows it."""

from __future__ import annotations

import io
from collections.abc import Callable

from rich.console import Console
from tirelab.validation.page import Proof
from tirelab.validation.score import Discrimination, Score
from tirelab.validation.terminal import criteria_table, lines

Make = Callable[..., Score]


def lines_of(proof: Proof) -> list[str]:
    text = io.StringIO()
    Console(file=text, width=150, color_system=None).print(criteria_table(proof))
    return text.getvalue().splitlines()


def line_with(lines: list[str], figure: str) -> str:
    (found,) = [line for line in lines if figure in line]
    return found


def test_every_criterion_is_a_line_with_its_limit_and_result(score: Make) -> None:
    right = [score("single", "lag", "lag", confidence=1.0) for _ in range(81)]
    alarms_made = [score("none", "none", "gas", confidence=0.5) for _ in range(9)]
    lines = lines_of(Proof(7, (*right, *alarms_made)))
    assert "90 blind trials, seed 7" in lines[0]
    exact = line_with(lines, "exact set named")
    assert "90.0 % (81 of 90)" in exact
    assert ">= 0.9" in exact
    assert exact.rstrip(" │").endswith("pass")
    alarms = line_with(lines, "false alarms")
    assert "100.0 % (9 of 9)" in alarms
    assert "<= 0.02" in alarms
    # nine trials leave 70 to 100 %
    assert alarms.rstrip(" │").endswith("too few trials")
    # 81 confident and right, nine alarms at half confidence: 9 * 0.25 / 90
    assert "0.025" in line_with(lines, "Brier")


def test_what_no_trial_measured_has_neither_passed_nor_failed(score: Make) -> None:
    unknown = line_with(lines_of(Proof(7, (score("single", "lag", "lag"),))), "unknown recognised")
    assert "no trial" in unknown
    assert unknown.rstrip(" │").endswith("not measured")


def test_how_many_are_right_with_the_recommended_recording_is_told_where_it_was_recorded(score: Make) -> None:
    decided = Discrimination(2, True, "decided rightly", right_after=True)
    scores = (score("single", "lag", "gas", discrimination=decided), score("single", "lag", "lag"))
    line = line_with(lines(Proof(7, scores)), "With the recommended recording")
    assert line == "With the recommended recording right in 100.0 % (1 of 1), before it in 0.0 % (0 of 1)."
    assert not [told for told in lines(Proof(7, scores[1:])) if "recommended recording" in told]
