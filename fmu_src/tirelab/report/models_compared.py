"""The sets of effects that were fitted completely, with their evidence and errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import titles, words

MOST_SETS = 15
"""Rows of the table of sets that were compared."""


COLUMNS = (  # keys of `evidence` (see `page.write_report`) with their titles
    ("log_evidence", "Log evidence, less the verdict's"),
    ("misfit", "Residual / noise"),
    ("rmse", "RMS error [N]"),
    ("held_out_rmse", "Held-out RMS error [N]"),
    ("remark", "Remark"),
)


def models_compared(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the columns that any row has, the first MOST_SETS rows, and how many more there are."""
    columns = [(key, title) for key, title in COLUMNS if any(row.get(key) is not None for row in rows)]
    shown = [
        (
            titles.set_title(row["effects"]),
            [row.get(key) or "" if key == "remark" else words.number(row.get(key), 3) for key, _ in columns],
        )
        for row in rows[:MOST_SETS]
    ]
    return {"columns": columns, "rows": shown, "more": max(len(rows) - MOST_SETS, 0)}
