"""Units of columns that a text states in rows of their own, below or above the names, or in columns beside."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import replace

from ..units import is_unit
from .table import BLANK_WORDS, Header, is_comment, quoted
from .table_search import is_units, is_value, states_units, unit_below

_UNITS_CALLED = re.compile(r'\s*"?(?:[xy]_)?(?:unit|einheit|unité|unidad)', re.IGNORECASE)

_OVER_TIME = re.compile(r"X_Dimension(?:[\s,;]+Time)+[\s,;]*", re.IGNORECASE)
_NO_ABSCISSA = re.compile(r"X_Columns[\s,;]+No\b", re.IGNORECASE)
_ABSCISSA = "X_Value"
"""How a LabVIEW measurement file says that its first column, of this name, is the time [s], unless it is left blank
(NI, "Specification for the LabVIEW Measurement File (.lvm)")."""

BELOW_NAMES = 3
"""Most rows of text between the names of the columns and the numbers: units, addresses, remarks."""


def below_names(
    lines: Sequence[str], line: int, headers: tuple[Header, ...], separator: str
) -> tuple[tuple[Header, ...], int, tuple[str, ...]]:
    """Return the headers with the units of a row below them, how many lines stand above the numbers, and notes.

    A row of text that is not of units is skipped too, with a note, where rows of numbers follow it.
    """
    texts, numbers_follow = _rows_of_text(lines, line, separator)
    units = next(
        (row for row in texts[:BELOW_NAMES] if len(row[1]) == len(headers) and states_units(row[1])), None
    )
    if units is None and not texts:
        return headers, 0, ()
    whole = numbers_follow and len(texts) <= BELOW_NAMES and all(len(row) == len(headers) for _, row in texts)
    if not whole and (units is None or units is not texts[0]):
        return headers, 0, ()
    notes = []
    if units is not None:
        headers = tuple(_with_unit(h, cell) for h, cell in zip(headers, units[1], strict=True))
        notes.append(f"units taken from row {units[0]}, below the names")
    others = [str(row) for row, _ in texts if units is None or row != units[0]] if whole else []
    if others:
        notes.append(f"text between the names and the numbers skipped: row {', '.join(others)}")
    last = texts[-1][0] if whole else (units or texts[0])[0]
    return headers, last - line, tuple(notes)


def above_names(
    lines: Sequence[str], headers: tuple[Header, ...], separator: str
) -> tuple[tuple[Header, ...], tuple[str, ...]]:
    """Return the headers with the units of the last row above them that calls itself one of units, and a note.

    Such a row begins with a word for units, Y_Unit_Label or Einheit, and holds a unit for each of the other columns; or
    it sets it to the units of all: UNIT = gf,mm.
    """
    if any(header.unit for header in headers):
        return headers, ()
    right_above = next(csv.reader(lines[-1:], delimiter=separator), [])
    if len(right_above) == len(headers) > 1 and all(map(str.strip, right_above)) and is_units(right_above):
        named = tuple(_with_unit(h, cell) for h, cell in zip(headers, right_above, strict=True))
        return named, ("units taken from the row above the names",)
    for line in reversed(lines):
        if _UNITS_CALLED.match(line) is None:
            continue
        row = next(csv.reader([line], delimiter=separator), [])
        label, _, first = row[0].partition("=")
        cells = [first.strip(), *row[1:]]
        filled = [cell.strip() for cell in cells if cell.strip()]
        if len(filled) > 1 and (is_units(cells) or all(is_unit(c) or is_unit(c.lower()) for c in filled)):
            units = [*cells, *[""] * len(headers)]
            named = tuple(_with_unit(h, cell) for h, cell in zip(headers, units, strict=False))
            return named, (
                f"units taken from the row above the names that begins with {quoted(label.strip())}",
            )
    return headers, ()


def over_time(
    lines: Sequence[str], headers: tuple[Header, ...]
) -> tuple[tuple[Header, ...], tuple[str, ...]]:
    """Return the headers with the time as the first one where the lines above say so (`_OVER_TIME`), and a note."""
    first = headers[0]
    blank = any(map(_NO_ABSCISSA.match, lines))
    if blank or first.name != _ABSCISSA or not any(map(_OVER_TIME.fullmatch, lines)):
        return headers, ()
    return (replace(first, name="time", unit="s"), *headers[1:]), (
        f"{_ABSCISSA} is the time, as X_Dimension says",
    )


def units_beside(
    headers: tuple[Header, ...], body: Sequence[Sequence[str]]
) -> tuple[tuple[Header, ...], tuple[str, ...]]:
    """Return the headers with the units that stand in the columns behind theirs, in every row, and a note."""
    found = {}
    for index in range(1, len(headers)):
        cells = [row[index].strip() for row in body if index < len(row) and row[index].strip()]
        called = _UNITS_CALLED.match(headers[index].name) is not None
        if called and headers[index - 1].unit is None and cells and all(map(is_unit, set(cells))):
            found[index - 1] = cells[0]
    if not found:
        return headers, ()
    with_units = tuple(
        replace(h, unit=found[i], unit_beside=True) if i in found else h for i, h in enumerate(headers)
    )
    return with_units, (f"units taken from the columns beside: {', '.join(found.values())}",)


def _rows_of_text(
    lines: Sequence[str], line: int, separator: str
) -> tuple[list[tuple[int, list[str]]], bool]:
    """Return the rows below the names that hold no number, with their rows in the file, and whether numbers follow."""
    texts: list[tuple[int, list[str]]] = []
    reader = csv.reader(lines[line : line + 4 * BELOW_NAMES], delimiter=separator)
    try:
        for row in reader:
            filled = [cell for cell in row if cell.strip().lower() not in BLANK_WORDS]
            if filled and is_comment(row[0]):
                break
            if any(is_value(cell) for cell in filled):
                return texts, len(filled) > 1 and all(is_value(cell) for cell in filled)
            if filled:
                texts.append((line + reader.line_num, row))
    except csv.Error:
        pass
    return texts, False


def _with_unit(header: Header, cell: str) -> Header:
    """Return a header with the unit of a cell below it."""
    return Header(header.name, unit_below(header.unit, cell), header.text)
