"""The summary of a batch as CSV, page and table, from verdicts written by hand."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import pytest
from browser import CONTRAST, Watched, browser
from rich.console import Console
from tirelab.batch.summary import (
    BatchResult,
    Item,
    Row,
    summary_csv,
    summary_html,
    summary_table,
    verdict_text,
)
from tirelab.diagnosis.diagnosis_file import Stated, StatedPlace

OUT = Path("out")


def verdict(names: str, confidence: float, **more: Any) -> Stated:
    return Stated(
        names=frozenset(names.split()),
        alternatives=tuple(frozenset(other.split()) for other in more.get("alternatives", ())),
        confidence=confidence,
        unexplained="unknown" in names.split(),
        summary="",
        places=more.get("places", ()),
        separating_test=None,
        fit=more.get("fit", {}),
        tire=None,
        corrected_fmu=None,
        report=more.get("report"),
        probabilities={},
        remainder=None,
    )


def row(name: str, found: Stated | None, error: str | None = None) -> Row:
    return Row(Item(name, (Path(f"{name}.csv"),)), found, error)


RESULT = BatchResult(
    (
        row("day/one", verdict("force_lag", 0.9, report=OUT / "verdicts" / "day~one" / "report.html")),
        row("two", verdict("force_lag unknown", 0.6, alternatives=["inertia", "none"])),
        row("three", verdict("none", 0.8)),
        row("four", None, "four.csv: has no force"),
    ),
    (Path("notes.md"),),
)


def lines_of_csv(result: BatchResult) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(summary_csv(result, OUT), newline="")))


def test_effects_are_counted_with_the_mean_confidence_and_the_most_frequent_first() -> None:
    counts = [(c.name, c.times, c.confidence, c.where) for c in RESULT.counts]
    assert counts == [
        ("force_lag", 2, pytest.approx(0.75), ("day/one", "two")),
        ("none", 1, 0.8, ("three",)),
        ("unknown", 1, 0.6, ("two",)),
    ]
    assert [r.item.name for r in RESULT.failures] == ["four"]


def test_the_csv_has_a_line_for_every_item() -> None:
    one, two, three, four = lines_of_csv(RESULT)
    assert (one["missing"], one["confidence"], one["unexplained"]) == ("force lag", "0.900", "no")
    assert one["report"] == "verdicts/day~one/report.html"
    assert (two["missing"], two["unexplained"]) == ("force lag + unknown", "yes")
    assert two["alternatives"] == "inertia; nothing"
    assert two["report"] == ""
    assert three["missing"] == "nothing"
    assert (four["missing"], four["confidence"], four["error"]) == ("", "", "four.csv: has no force")
    assert four["recordings"] == "four.csv"


@pytest.mark.parametrize(
    ("region", "text"),
    [
        (StatedPlace("time", 1.0, 2.5, "s", 0.4, "a.csv"), "time 1 to 2.5 s (40 %)"),
        (StatedPlace("deflection", 0.01, None, "m", 1.0, None), "deflection from 0.01 m (100 %)"),
        (StatedPlace("rate", None, -0.02, "m/s", 0.5, None), "rate up to -0.02 m/s (50 %)"),
        (StatedPlace("time", None, None, "s", 0.5, None), "time everywhere (50 %)"),
        (StatedPlace("direction", -1.0, -1.0, "1", 0.7, None, "unloading"), "direction unloading (70 %)"),
        (StatedPlace("direction", "a", "b", "1", 0.7, None), "direction a to b (70 %)"),
    ],
)
def test_the_first_region_is_told_with_its_unit_and_share(region: StatedPlace, text: str) -> None:
    later = StatedPlace("force", 0.0, 1.0, "N", 0.1, None)
    found = BatchResult((row("r", verdict("inertia", 0.5, places=(region, later))),), ())
    assert lines_of_csv(found)[0]["largest part in"] == text


def test_a_verdict_without_the_errors_of_its_fit_does_not_break_the_page() -> None:
    assert "<td>inertia</td>" in summary_html(BatchResult((row("r", verdict("inertia", 0.5)),), ()), OUT)


def test_where_nothing_is_missing_no_region_is_told() -> None:
    region = StatedPlace("time", 1.0, 2.5, "s", 0.4, None)
    found = BatchResult((row("r", verdict("none", 0.5, places=(region,))),), ())
    assert lines_of_csv(found)[0]["largest part in"] == ""


def test_errors_have_six_digits_and_are_empty_where_not_known() -> None:
    fit = {"noise": 5.1234567, "before": 100.0, "after": None}
    (line,) = lines_of_csv(BatchResult((row("r", verdict("inertia", 0.5, fit=fit)),), ()))
    assert (line["noise [N]"], line["before [N]"], line["after [N]"]) == ("5.12346", "100", "")


@pytest.mark.parametrize("name", ["=1+1", "+1", "-1", "@sum"])
def test_a_name_that_a_spreadsheet_would_compute_is_quoted(name: str) -> None:
    assert lines_of_csv(BatchResult((row(name, None, "broken"),), ()))[0]["name"] == f"'{name}"


def test_the_page_shows_counts_failures_and_skipped_files() -> None:
    text = summary_html(RESULT, OUT)
    assert "<td>force lag</td>\n<td>2 of 4</td>" in text
    assert "75 %" in text
    assert '<tr class="failed"><td>no verdict</td><td>1 of 4</td>' in text
    assert "notes.md" in text
    assert 'href="verdicts/day~one/report.html"' in text
    assert "<td>three</td>" in text, "without a report its name is no link"
    assert "four.csv: has no force" in text


def test_a_page_without_failures_says_nothing_of_them() -> None:
    text = summary_html(BatchResult(RESULT.rows[:1], ()), OUT)
    assert "no verdict" not in text
    assert "Skipped" not in text


def test_the_page_tells_three_alternatives_as_differences() -> None:
    others = ["inertia force_lag", "series_compliance", "none", "force_drift", "force_offset"]
    text = summary_html(BatchResult((row("r", verdict("inertia", 0.5, alternatives=others)),), ()), OUT)
    assert ">+ force lag; series spring instead of inertia; nothing missing; 2 more</td>" in text
    assert "rate-independent hysteresis" in summary_html(
        BatchResult((row("r", verdict("rate_independent_hysteresis", 0.5)),), ()), OUT
    )


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_fits_a_phone_in_light_and_dark(scheme: str, tmp_path: Path) -> None:
    """With a name and an error that are long, and cells of every kind."""
    rows = (*RESULT.rows, row("long_name_" * 12, None, f"{'long_name_' * 12}.csv: has no force"))
    (tmp_path / "summary.html").write_text(summary_html(BatchResult(rows, ()), OUT), encoding="utf-8")
    with browser() as chromium:
        shown = Watched(chromium, viewport={"width": 390, "height": 844}, color_scheme=scheme)
        shown.page.goto((tmp_path / "summary.html").as_uri())
        assert shown.page.evaluate("() => document.documentElement.scrollWidth") <= 390
        assert shown.page.evaluate(CONTRAST) == []
        assert shown.said == []
        dark = (
            shown.page.evaluate("() => getComputedStyle(document.body).backgroundColor")
            != "rgb(255, 255, 255)"
        )
        assert dark == (scheme == "dark")


def test_the_page_escapes_names_and_errors() -> None:
    text = summary_html(BatchResult((row("<b>x", None, "<i>broken</i>"),), ()), OUT)
    assert "<b>x" not in text
    assert "&lt;i&gt;broken&lt;/i&gt;" in text


@pytest.mark.parametrize(("rows", "failed"), [(RESULT.rows, True), (RESULT.rows[:3], False)])
def test_the_table_has_a_line_for_every_effect_and_one_for_the_failures(
    rows: tuple[Row, ...], failed: bool
) -> None:
    text = io.StringIO()
    Console(file=text, width=100, color_system=None).print(summary_table(BatchResult(rows, ())))
    lines = text.getvalue().splitlines()
    assert lines[0].startswith(f"{len(rows)} recordings or folders")
    (lag,) = [line for line in lines if "force lag" in line]
    assert f"2 of {len(rows)}" in lag
    assert "75 %" in lag
    assert any("nothing" in line for line in lines)
    assert any("no verdict" in line for line in lines) == failed


def test_a_verdict_in_one_line() -> None:
    assert verdict_text(verdict("inertia force_lag", 0.876)) == "force lag + inertia, confidence 88 %"
    assert verdict_text(verdict("none", 1.0)) == "nothing, confidence 100 %"
