"""Units that stand behind the numbers of a column, 1.20 N, are taken off, and are the unit of the column."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from ..units import is_unit
from .table import BLANK_WORDS, is_comment, listed
from .table_search import CONFIRMED, SEARCHED, SEPARATORS, is_value

NEARLY = 0.9
"""The share of the numbers of a column that have one unit: it is that of the column."""

_WITH_UNIT = re.compile(r"\s*(?P<number>[+-]?[\d.,]*\d(?:[eE][+-]?\d+)?)\s*(?P<unit>[^\d\s.,+-]\S*)\s*")


def units_in_cells(lines: Sequence[str], separator: str | None) -> tuple[str, Mapping[int, str]] | None:
    """Return the separator and the unit of each column whose numbers have one; None where no column has.

    lines: from the first on that is no comment; separator: of the columns where the file declares it. The longest run
    of rows of one width in which every cell is a number, with a unit or without, tells.
    """
    best: tuple[int, str, dict[int, str]] | None = None
    for mark in separator or SEPARATORS:
        rows = [_cells(line, mark) for line in lines[:SEARCHED]]
        if not any(_WITH_UNIT.fullmatch(cell) for row in rows for cell in row):
            continue
        run: list[list[str]] = []
        for row in [*rows, []]:
            if len(row) > 1 and _is_row(row) and (not run or len(run[-1]) == len(row)):
                run.append(row)
                continue
            units = _common(run)
            if units and len(run) >= CONFIRMED and (best is None or len(run) > best[0]):
                best = len(run), mark, units
            run = []
    return None if best is None else best[1:]


def column_unit(cells: Sequence[str]) -> str:
    """Return the unit that nearly every number of a column has behind it, "" where there is none."""
    filled = [cell for cell in cells if cell.strip().lower() not in BLANK_WORDS]
    matches = [_WITH_UNIT.fullmatch(cell) for cell in filled if not is_value(cell)]
    units = Counter(match["unit"] for match in matches if match)
    unit, count = units.most_common(1)[0] if units else ("", 0)
    return unit if count > NEARLY * len(filled) and is_unit(unit) else ""


def taken_from_cells(units: Iterable[str]) -> str:
    """Return the note of units that stand in the cells."""
    return f"units taken from the cells: {listed(list(units))}"


def without_unit(cell: str, unit: str) -> str:
    """Return a cell without its unit; one that has none or another stays as it is, and is no number then."""
    text = cell.strip()
    other = text[: -len(unit)][-1:].isalpha()  # kN, where the unit is N
    if text.lower() in BLANK_WORDS or not text.endswith(unit) or other:
        return cell if text.lower() in BLANK_WORDS else f"{cell} (without {unit})"
    return text[: -len(unit)].rstrip()


def row_without_units(row: Sequence[str], units: Mapping[int, str]) -> list[str]:
    """Return a row with its numbers without their units; whatever else stands in it stays."""
    cells = list(row)
    for index, unit in units.items():
        if index < len(cells) and (found := _WITH_UNIT.fullmatch(cells[index])) and found["unit"] == unit:
            cells[index] = found["number"]
    return cells


def lines_without_units(lines: Sequence[str], separator: str, units: Mapping[int, str]) -> list[str]:
    """Return the lines with the numbers of these columns without their units; lines of text stay as they are."""
    changed = []
    for line in lines:
        row = _cells(line, separator)
        if len(row) <= max(units) or not _is_row(row) or is_comment(line):
            changed.append(line)
            continue
        text = io.StringIO()
        csv.writer(text, delimiter=separator, lineterminator="\n").writerow(row_without_units(row, units))
        changed.append(text.getvalue())
    return changed


def _cells(line: str, separator: str) -> list[str]:
    try:
        return next(csv.reader([line.rstrip("\r\n")], delimiter=separator), [])
    except csv.Error:
        return []


def _is_row(row: Sequence[str]) -> bool:
    filled = [cell for cell in row if cell.strip().lower() not in BLANK_WORDS]
    return bool(filled) and all(_WITH_UNIT.fullmatch(cell) or is_value(cell) for cell in filled)


def _common(rows: Sequence[Sequence[str]]) -> dict[int, str]:
    """Return the unit of each column that nearly every number has; one without it is refused with its row then."""
    columns = [column_unit([row[index] for row in rows]) for index in range(len(rows[0]) if rows else 0)]
    return {index: unit for index, unit in enumerate(columns) if unit}
