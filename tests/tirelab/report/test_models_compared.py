"""The table of sets that were compared."""

from __future__ import annotations

from tirelab.report.models_compared import MOST_SETS, models_compared


def test_columns_that_no_row_has_are_left_out() -> None:
    rows = [
        {"effects": ["inertia"], "log_evidence": 0.0, "rmse": 6.012, "remark": "the verdict"},
        {"effects": [], "log_evidence": -12.34, "rmse": None},
    ]
    table = models_compared(rows)
    assert [key for key, _ in table["columns"]] == ["log_evidence", "rmse", "remark"]
    assert table["rows"] == [
        ("inertia", ["0", "6.01", "the verdict"]),
        ("nothing missing", ["−12.3", "–", ""]),
    ]


def test_rows_that_are_not_shown_are_counted() -> None:
    table = models_compared([{"effects": [], "log_evidence": -1.0}] * (MOST_SETS + 3))
    assert (len(table["rows"]), table["more"]) == (MOST_SETS, 3)
    assert models_compared([]) == {"columns": [], "rows": [], "more": 0}
