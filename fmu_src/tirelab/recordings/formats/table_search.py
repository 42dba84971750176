"""Where the table stands in a text: the lines above it, its header, and its first row of numbers."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..units import QUANTITIES, are_apart, is_no_unit, is_unit, measures, split_header
from ..vocabulary import any_channel
from .clock import is_clock
from .number_style import style_of
from .table import BLANK_WORDS, is_comment

SEPARATORS = "\t;,|"

SEARCHED = 300
"""Lines that are searched at once for the beginning of the table."""

AGAIN = 20
"""Lines at the end of those that are searched again with the next ones: the names stand above the numbers."""

LONGEST_ROW = 8
"""A row between quotes that takes more lines than this is a quote left open above the table."""

CONFIRMED = 3
"""Fewest rows of numbers, one after another, that make a table; fewer are lines of text with numbers in them."""

_SETTING = re.compile(r"[^=(\[]+=")
"""How a row begins that sets something, UNIT = gf, and names no columns."""

_KNOWN = frozenset(
    {"time", "deflection", "displacement", "stroke", "force", "load", "radius", "travel", "pressure"}
)


@dataclass(frozen=True)
class TablePlace:
    """The separator of the columns, and the line of the header, from 0."""

    separator: str
    line: int


@dataclass(frozen=True)
class _Row:
    line: int
    cells: tuple[str, ...]
    numeric: bool


END_OF_HEADER = "***End_of_Header***"
"""Above it a LabVIEW measurement file has its settings, one for each channel: no names of columns."""


def find_table(lines: Sequence[str], start: int, separator: str | None) -> TablePlace | None:
    """Return where the table below any lines about the test begins; None where no line looks like a row of numbers.

    lines: of the text; start: the first that is no comment; separator: of the columns where the file declares it

    The longest run of rows of numbers of one width is the table. Its header is the row above it, of the same width and
    without numbers, in which most cells name a channel or state a unit; where none does, the nearest above the run. So
    is that one where it is a cell wider or narrower and names as many.
    """
    for searched in range(start, max(len(lines), start + 1), SEARCHED - AGAIN):
        best = _best_run(lines[searched : searched + SEARCHED], separator or SEPARATORS)
        if best is not None:
            start = searched
            break
    else:
        return None
    (length, _), rows, first, found = best
    width = len(rows[first].cells)
    texts = [row for row in rows[:first] if not row.numeric and any(row.cells) and not is_units(row.cells)]
    texts = [row for row in texts if _SETTING.match(row.cells[0]) is None]
    ends = [number for number, row in enumerate(texts) if row.cells[0].strip() == END_OF_HEADER]
    texts = texts[ends[-1] + 1 :] if ends else texts
    above = [row for row in texts if len(row.cells) == width]
    header = max(reversed(above), key=lambda row: named(row.cells), default=None)
    most = named(header.cells) if header is not None else 0
    near = next(iter(_nearly_as_wide(texts, rows, first)), None)
    if not most or (near is not None and named(near.cells) >= most):
        header = near or header
    elif header is not None:
        header = next(row for row in above if named(row.cells) == named(header.cells))
    if header is not None:
        return TablePlace(found, start + header.line)
    # without a header the numbers begin with the first row of that width, unless a run confirms a later one
    begin = first if length >= CONFIRMED else next(i for i, row in enumerate(rows) if row.numeric)
    while begin and rows[begin - 1].numeric and len(rows[begin - 1].cells) == width:
        begin -= 1
    return TablePlace(found, start + rows[begin].line)


_Run = tuple[tuple[int, bool], list[_Row], int, str]
"""How long a run of rows of numbers is and whether it has a row of text of its width above, all rows, the first of the
run, and the separator."""


def _best_run(lines: Sequence[str], separators: str) -> _Run | None:
    """Return the longest run of rows of numbers of one width among some lines; None where there is no such row."""
    best: _Run | None = None
    for candidate in separators:
        rows = list(_rows(lines, candidate))
        length, first = _longest_run(rows)
        # Of two that part as many rows, one may stand within a text: it does not part the header as it parts them.
        headed = any(not row.numeric and len(row.cells) == len(rows[first].cells) for row in rows[:first])
        if length and (best is None or (length, headed) > best[0]):
            best = ((length, headed), rows, first, candidate)
    return best


def _nearly_as_wide(texts: Sequence[_Row], rows: Sequence[_Row], first: int) -> list[_Row]:
    """Return the row of text nearest above the numbers if it is a cell wider or narrower, and shows that it names them.

    Some programs name a column for remarks that few rows have, or end each row of numbers with a separator. It names
    channels, or the row of numbers right below it has its remark, DAQ Start, so that it is as wide.
    """
    if not texts:
        return []
    numbers, below = rows[first], rows[rows.index(texts[-1]) + 1]
    names, width = [cell for cell in texts[-1].cells if cell.strip()], len(numbers.cells)
    trailed = not numbers.cells[-1].strip()
    fits = len(names) == width + 1 or (trailed and len(names) == width - 1)
    remarked = below.numeric and len(names) == len(below.cells) == width + 1
    return [texts[-1]] if fits and (remarked or named(names) > 1) else []


def is_value(cell: str) -> bool:
    """Whether a cell holds a number, a time or the word for flat ground."""
    text = cell.strip().lower()
    if is_clock(text):
        return True
    text = style_of([text]).ungrouped(text)
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return text not in BLANK_WORDS


def is_units(cells: Sequence[str]) -> bool:
    """Whether a row holds units, in brackets or not, and nothing else; some columns may have none.

    One of them at least is a channel's. Of the others, those in brackets may be anything (N/tex, %), since machines
    derive all sorts of columns; those without have to be known as units, and longer than a letter, since a, b and c are
    units too, unless they are volts or amperes.
    """
    filled = [(cell.strip(), bare_unit(cell)) for cell in cells if bare_unit(cell)]
    fits = [any(measures(unit, si) for si in QUANTITIES) for _, unit in filled]
    bare = [unit for (cell, unit), fit in zip(filled, fits, strict=True) if cell == unit and not fit]
    return any(fits) and all(is_unit(unit) and (len(unit) > 1 or unit in "VA%") for unit in bare)


def states_units(cells: Sequence[str]) -> bool:
    """Whether a row below the names holds units: as `is_units`, or units of two kinds of channels beside any words.

    Counters and derived columns have words in such a row that are no units of a channel: segments, J, cycles.
    """
    units = [bare_unit(cell) for cell in cells if bare_unit(cell)]
    return is_units(cells) or sum(any(measures(unit, si) for unit in units) for si in QUANTITIES) > 1


def unit_below(own: str | None, cell: str) -> str | None:
    """Return the unit of a column whose name states one of its own, or none, and which has this cell below it.

    Where the two are of one quantity and not of one size it is both, N or kN, which is none and is asked about. A
    word in brackets is no unit: X(Absolute).
    """
    unit = bare_unit(cell)
    if own and is_unit(unit) and is_no_unit(own, [si for si in QUANTITIES if measures(unit, si)]):
        return unit
    if own and unit and are_apart(own, unit):
        return f"{own} or {unit}"
    return own or unit or None


def bare_unit(cell: str) -> str:
    """Return a unit without the brackets or dashes around it."""
    text = cell.strip()
    bare = text[1:-1].strip() if text[:1] + text[-1:] in ("[]", "()") else text
    return bare.strip("-")


def _rows(lines: Sequence[str], separator: str) -> Iterator[_Row]:
    """Return the rows of some lines, each with its first line; a quote that is left open ends with its line."""
    line = 0
    while line < len(lines):
        cells, taken = _row(lines, line, separator)
        if cells and any(cell.strip() for cell in cells) and not is_comment(cells[0]):
            yield _Row(line, tuple(cells), _mostly_numeric(cells))
        line += taken


def _row(lines: Sequence[str], line: int, separator: str) -> tuple[list[str], int]:
    reader = csv.reader(lines[line : line + LONGEST_ROW], delimiter=separator)
    try:
        cells = next(reader)
    except (csv.Error, StopIteration):
        return [], 1
    if reader.line_num == 1:
        return cells, 1
    if reader.line_num >= min(LONGEST_ROW, len(lines) - line):
        return lines[line].split(separator), 1
    return cells, reader.line_num


def _mostly_numeric(cells: Sequence[str]) -> bool:
    """Whether half of the cells that hold something hold numbers, two at least; units behind numbers do not count."""
    filled = [cell for cell in cells if cell.strip().lower() not in BLANK_WORDS]
    numbers = [is_value(cell) for cell in filled]
    values = sum(numbers)
    if values < 2 or 2 * values >= len(filled):
        return values > 1
    behind = (text for before, text in zip(numbers, filled[1:], strict=False) if before)
    units = sum(any(measures(text.strip(), si) for si in QUANTITIES) for text in behind)
    return 2 * values >= len(filled) - units


def _longest_run(rows: Sequence[_Row]) -> tuple[int, int]:
    """Return the length of the longest run of rows of numbers of one width, and the index of its first row."""
    best, first, begin = 0, 0, 0
    for i, row in enumerate(rows):
        if not row.numeric:
            begin = i + 1
        elif i > begin and len(row.cells) != len(rows[begin].cells):
            begin = i
        if row.numeric and i - begin + 1 > best:
            best, first = i - begin + 1, begin
    return best, first


def named(cells: Sequence[str]) -> int:
    """Return how many cells name a channel or state a unit."""
    return sum(map(_names_something, cells))


def _names_something(cell: str) -> bool:
    name, unit = split_header(cell)
    if unit and any(measures(unit, si) for si in QUANTITIES):
        return True
    return bool(_KNOWN & set(name.lower().split())) or any_channel(name) is not None
