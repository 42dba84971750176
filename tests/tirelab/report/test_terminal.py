"""The screenful that a diagnosis prints."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from tirelab.report import first_screen
from tirelab.report.terminal import print_diagnosis, printable


def printed(diagnosis: dict[str, Any]) -> str:
    text = io.StringIO()
    print_diagnosis(Console(file=text, width=100, color_system=None), diagnosis, Path("out"))
    return " ".join(text.getvalue().split())


@pytest.mark.parametrize("kind", ["nothing", "one", "two", "alternatives", "unknown"])
def test_every_kind_begins_with_its_verdict_and_ends_with_its_files(kinds: dict[str, Any], kind: str) -> None:
    text = printed(kinds[kind].diagnosis)
    assert text.startswith(first_screen.headline(kinds[kind].diagnosis))
    assert kinds[kind].diagnosis["verdict"]["summary"] in text
    files = "report.html, tire.json, BicycleTire.fmu, diagnosis.json, plots.csv"
    assert text.endswith(
        f"Written to out: {files}" + (", separating_test.csv" if kind == "alternatives" else "")
    )
    assert "held-out" in text
    assert "where they differ" in text


def test_parameters_are_printed_with_their_meaning(kinds: dict[str, Any]) -> None:
    text = printed(kinds["two"].diagnosis)
    assert "refitted law, without it 61 % of the error comes back" in text
    assert "with the law refitted" in text
    assert "slip force 30.10 ± 0.60 N friction whatever the load: half the loop's height" in text


def test_the_law_of_a_curve_has_no_constants_of_a_power(kinds: dict[str, Any]) -> None:
    """Those of the power law below a part's curve are next to nothing, and say nothing."""
    diagnosis = kinds["two"].diagnosis
    law = {**next(e for e in diagnosis["verdict"]["effects"] if e["name"] == "recalibration"), "law": []}
    text = printed({**diagnosis, "verdict": {**diagnosis["verdict"], "effects": [law]}})
    assert "A before" not in text
    assert "log factor" not in text
    assert "and 1 constants of its shape: the curve is in report.html" in text


def test_what_to_do_next_is_said_as_on_the_page(kinds: dict[str, Any]) -> None:
    undecided = kinds["alternatives"].diagnosis
    text = printed(undecided)
    assert f"What to do next: {first_screen.next_step(undecided).action} It decides " in text
    assert "Drive separating_test.csv. Written to out" in text
    text = printed(kinds["one"].diagnosis)
    assert "What to do next: Nothing: use this tire. Written to out" in text


def test_a_regression_is_printed_with_its_errors(kinds: dict[str, Any]) -> None:
    diagnosis = kinds["unknown"].diagnosis
    regression = {"by": "deflection", "unit": "m", "repeats": 0.88, "after": 6.4, "held_out_after": None}
    content = {**diagnosis, "verdict": {**diagnosis["verdict"], "corrections": [regression]}}
    assert "the deflection 6.40 – 88 %" in printed(content)
    regression["repeats"] = None
    assert "the deflection 6.40 – not known" in printed(content)


def test_without_places_and_held_out_data_their_tables_are_left_out(kinds: dict[str, Any]) -> None:
    diagnosis = kinds["one"].diagnosis
    fit = {**diagnosis["fit"], "held_out_before": None, "held_out_after": None}
    text = printed({**diagnosis, "where": [], "fit": fit})
    assert "where they differ" not in text
    assert "held-out" not in text


def test_what_could_control_a_terminal_is_a_question_mark() -> None:
    assert printable("a\x1b[31mb\tc\n轮胎") == "a?[31mb?c?轮胎"


def test_what_no_catalogue_holds_is_printed_beside_what_is_named(kinds: dict[str, Any]) -> None:
    text = printed(kinds["alternatives"].diagnosis)
    assert "friction in the guides of the machine friction loop press a steel spring in its place" in text
    assert "leaves the same" not in printed(kinds["nothing"].diagnosis)


def test_alternatives_and_the_refitted_law_are_printed_as_people_know_them(kinds: dict[str, Any]) -> None:
    text = printed(kinds["alternatives"].diagnosis)
    assert "viscous damping instead of friction loop 30 % repeat at 30 mm/s" in text
    text = printed(kinds["two"].diagnosis)
    assert "flat ground 550.9 600.0 ± 1.2 1.422 1.3800 ± 0.0040" in text
    of_part = printed(kinds["two"].diagnosis | {"baseline_tire": {"inflated": False}})
    assert "the part 550.9 600.0 ± 1.2 1.422 1.3800 ± 0.0040" in of_part
    assert (
        "ground" not in of_part[of_part.index("the part") :].split("Written")[0].split("What to do next")[0]
    )
    assert "log factor on A" not in text
