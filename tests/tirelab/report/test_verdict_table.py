"""The table that a notebook shows of a verdict."""

from __future__ import annotations

import re
from typing import Any

import pytest
from tirelab.report.verdict_table import verdict_table


def shown(diagnosis: dict[str, Any]) -> str:
    """The table's text, a bar between its cells."""
    table = verdict_table({"held_out_by": "recordings given", **diagnosis})
    return re.sub(r"\|+", "|", re.sub(r"<[^>]*>", "|", table))


@pytest.mark.parametrize("kind", ["nothing", "one", "two", "alternatives", "unknown"])
def test_every_kind_has_verdict_confidence_and_errors(kinds: dict[str, Any], kind: str) -> None:
    diagnosis = kinds[kind].diagnosis
    text = shown(diagnosis)
    assert f"|confidence|{100 * diagnosis['verdict']['confidence']:.0f} %: " in text
    assert f"|RMS error|{diagnosis['fit']['before']:.3g}" in text
    assert f"|held-out RMS error|{diagnosis['fit']['held_out_before']:.3g}" in text
    part = shown({**diagnosis, "held_out_by": "time block 21-30 s"})
    assert " N (time block 21-30 s)|" in part
    assert "(" not in text.split("held-out RMS error|")[1].split("|")[0]


def test_effects_have_their_parameters(kinds: dict[str, Any]) -> None:
    text = shown(kinds["two"].diagnosis)
    assert (
        "|friction loop (rate-independent hysteresis)|slip force 30.10 ± 0.60 N, load share 0.01990 ± 0.00080, "
        "reach 1.020 ± 0.040 mm|" in text
    )
    assert "|refitted law|" in text


def test_alternatives_and_the_next_test_are_shown_where_there_are_any(kinds: dict[str, Any]) -> None:
    text = shown(kinds["alternatives"].diagnosis)
    assert "|alternative models|viscous damping or relaxation and refitted law|" in text
    assert "|recommended next test|Drive triangles at three rates to 22 mm on flat ground.|" in text
    assert "alternative models" not in shown(kinds["one"].diagnosis)


def test_without_held_out_data_their_row_is_left_out(kinds: dict[str, Any]) -> None:
    diagnosis = kinds["one"].diagnosis
    fit = {**diagnosis["fit"], "held_out_before": None, "held_out_after": None}
    assert "held-out" not in shown({**diagnosis, "fit": fit})


def test_colours_are_left_to_the_notebook_light_or_dark(kinds: dict[str, Any]) -> None:
    table = verdict_table({"held_out_by": "", **kinds["one"].diagnosis})
    assert "color:inherit" in table
    assert not re.search(r"#[0-9a-f]{3}|(?<!-)color:(?!inherit)", table)
    assert set(re.findall(r"background:(\w+)", table)) == {"transparent"}


def test_a_sentence_cannot_become_markup(kinds: dict[str, Any]) -> None:
    diagnosis = kinds["alternatives"].diagnosis
    test = {**diagnosis["verdict"]["separating_test"], "sentence": "<img src=x onerror=alert(1)> & 'more'"}
    verdict = {**diagnosis["verdict"], "separating_test": test}
    table = verdict_table({"held_out_by": "", **diagnosis, "verdict": verdict})
    assert "<img" not in table
    assert "&lt;img src=x" in table
