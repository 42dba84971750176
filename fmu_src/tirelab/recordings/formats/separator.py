"""The character between the columns of a text table in which no block of numbers was found."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

from .table import RecordingError, quoted
from .table_search import SEPARATORS


def find_separator(path: Path, lines: Sequence[str]) -> str:
    """Return the separator of the first lines of a table.

    Errors: RecordingError where there is none; rows that are quoted as one cell each are told apart.
    """
    sample = [line for line in lines[:50] if line.strip()]
    likely: list[tuple[bool, int, str]] = []
    for candidate in SEPARATORS:
        try:
            fields = [len(row) for row in csv.reader(sample, delimiter=candidate)]
        except csv.Error:
            continue
        if fields[0] > 1:
            agreeing = sum(count == fields[0] for count in fields[1:])
            likely.append((2 * agreeing >= len(fields) - 1, fields[0], candidate))
    if not likely:
        _refuse_rows_of_one_cell(path, sample)
        raise RecordingError(
            f"{path.name}: no comma, semicolon, tab, | or spaces separate columns of numbers (its first line is "
            f"{quoted(sample[0].strip())}); export it as CSV"
        )
    # A separator that the rows confirm comes first; then tab before semicolon before comma.
    return next((mark for agreed, _, mark in likely if agreed), max(likely, key=lambda found: found[1])[2])


def _refuse_rows_of_one_cell(path: Path, sample: Sequence[str]) -> None:
    """Refuse rows with quotes around all of their columns, of a CSV that a spreadsheet did not split."""
    try:
        cells = [row[0] for row in csv.reader(sample) if len(row) == 1 and "," in row[0]]
    except csv.Error:
        return
    if 2 * len(cells) > len(sample):
        raise RecordingError(
            f"{path.name}: each row is quoted as one cell ({quoted(cells[-1])}), as a spreadsheet writes a table that "
            "it did not split at its commas; give the file from before, or split the column there (Text to Columns) "
            "and export it again"
        )
