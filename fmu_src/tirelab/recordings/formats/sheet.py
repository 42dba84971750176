"""The sheets of a workbook: the table of each, found as that of a text, below lines about the test."""

import datetime
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any

from ..units import split_header
from .cell_units import lines_without_units, row_without_units, taken_from_cells, units_in_cells
from .header_units import below_names
from .layout import column_counted
from .number_style import NumberStyle, style_of, with_plain_marks
from .table import Header, RecordingError, listed, quoted, with_cell_units, with_dates
from .table_search import SEARCHED, find_table
from .workbook import Version, opened

MOST_SHEETS = 200
"""Most sheets of a workbook that are searched."""

KEPT = 4
"""Number of workbooks whose tables are remembered."""

NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
"""A number that is stored as text, without marks between thousands and with a decimal point."""

DATES = (datetime.datetime, datetime.timedelta, datetime.time)
"""What the libraries make of cells that hold a date, a duration or a time of day."""


@dataclass(frozen=True)
class Sheet:
    """The table of one sheet: its title, its row of names (0: none) and its first row of numbers from 1, its columns.

    style: of numbers that are stored as text, where most cells of a column hold one; rows: how many were seen below the
    names; counted: whether its first column holds no text; provenance: the rows above the names; hidden: whether the
    workbook does not show it
    """

    title: str
    header_row: int
    first_row: int
    headers: tuple[Header, ...]
    notes: tuple[str, ...]
    style: NumberStyle | None = None
    rows: int = 0
    counted: bool = False
    provenance: tuple[str, ...] = ()
    hidden: bool = False

    @property
    def cell_units(self) -> Mapping[int, str]:
        """The units of the columns in which every number has its unit behind it."""
        return {index: header.cell_unit for index, header in enumerate(self.headers) if header.cell_unit}


@lru_cache(maxsize=KEPT)
def tables_of(version: Version, sheet: str) -> tuple[Sheet, ...]:
    """Return the tables of the sheets of a workbook that hold anything, or of the one that is named."""
    book = opened(version)
    titles = [_titled(version.path, book.titles, sheet)] if sheet else book.titles[:MOST_SHEETS]
    heads = {title: [list(row) for row in islice(book.rows(title), SEARCHED)] for title in titles}
    return tuple(
        replace(_sheet(title, head), hidden=title in book.hidden)
        for title, head in heads.items()
        if any(map(holds_any, head))
    )


@lru_cache(maxsize=MOST_SHEETS)
def length(version: Version, title: str) -> int:
    """Return how many rows of a sheet hold anything; the whole sheet is read."""
    return sum(map(holds_any, opened(version).rows(title)))


def _titled(path: Path, titles: Sequence[str], name: str) -> str:
    """Return the title of the sheet that is named, whatever its case. Errors: RecordingError where there is none."""
    for same in (
        [title for title in titles if title.strip() == name],
        [title for title in titles if title.strip().casefold() == name.casefold()],
    ):
        if same:
            return same[0]
    sheets = listed(list(map(quoted, titles)))
    raise RecordingError(
        f"{path.name}: has no sheet {quoted(name)}; its sheets are {sheets}, and a part of one is written 10s:20s "
        "(time), 100:2000 (rows) or trial2"
    )


def _sheet(title: str, head: Sequence[Sequence[Any]]) -> Sheet:
    """Return the table of a sheet that holds anything, from its first rows."""
    width = max(len(_trimmed(row)) for row in head)
    lines = ["\t".join(map(cell_text, [*row, *[None] * width][:width])) + "\n" for row in head]
    first = next(i for i, row in enumerate(head) if holds_any(row))
    _, cell_units = units_in_cells(lines, "\t") or ("", {})
    if cell_units:
        lines = lines_without_units(lines, "\t", cell_units)
        head = [_without_units(row, cell_units) for row in head]
    place = find_table(lines, first, "\t")
    start = first if place is None else place.line
    names = [*head[start], *[None] * width][:width]
    width = _named_width(names)
    if width < len(names):
        names, head = names[:width], [row[:width] for row in head]
        lines = ["\t".join(line.rstrip("\n").split("\t")[:width]) + "\n" for line in lines]
    if any(isinstance(cell, str) and cell.strip() for cell in names):
        headers = tuple(_header(cell, n) for n, cell in enumerate(names, 1))
        headers, below, notes = below_names(lines, start + 1, headers, "\t")
        header_row, first_row = start + 1, start + below + 2
    else:
        headers = tuple(_header(None, n) for n in range(1, len(_trimmed(names)) + 1))
        notes = ("the sheet has no header row: its columns are known by number only",)
        header_row, first_row = 0, start + 1
    body = head[first_row - 1 :]
    values = next((row for row in body if holds_any(row)), ())
    dated = {n for n, cell in enumerate(values) if isinstance(cell, DATES)}
    headers = with_cell_units(with_dates(headers, dated), cell_units)
    if cell_units:
        notes = (*notes, taken_from_cells(cell_units.values()))
    if start > first:
        notes = (*notes, f"table found at row {start + 1}: the rows above it are kept as its provenance")
    style = _style_of_texts(body)
    if style is not None:
        marks = "commas" if style.decimal_comma else "points"
        notes = (*notes, f"numbers that are stored as text read with decimal {marks}")
    counted = column_counted([[cell_text(cell) for cell in row] for row in body])
    above = tuple("; ".join(filter(None, map(cell_text, row))) for row in head[:start] if holds_any(row))
    return Sheet(title, header_row, first_row, headers, notes, style, len(body), counted, above)


def _style_of_texts(body: Sequence[Sequence[Any]]) -> NumberStyle | None:
    """Return how numbers that are stored as text are written; None where no column holds mostly such."""
    style = style_of(cell for row in body for cell in row if isinstance(cell, str))
    held: Counter[int] = Counter(n for row in body for n, cell in enumerate(row) if holds_any((cell,)))
    texts = Counter(
        n for row in body for n, cell in enumerate(row) if stored_as_text(cell, style) is not None
    )
    return style if any(2 * count > held[n] for n, count in texts.items()) else None


def stored_as_text(cell: object, style: NumberStyle) -> float | None:
    """Return a number that is stored as text and written in a style; None for any other cell."""
    if not isinstance(cell, str):
        return None
    text = style.ungrouped(with_plain_marks(cell.strip()))
    if style.decimal_comma:
        text = "" if "." in text else text.replace(",", ".")
    return float(text) if NUMBER.fullmatch(text) else None


def _named_width(names: Sequence[Any]) -> int:
    """Return how many columns a row of names has: it ends before numbers, which are of a table beside it."""
    texts = [n for n, cell in enumerate(names, 1) if isinstance(cell, str) and cell.strip()]
    beside = texts and any(isinstance(cell, (int, float)) for cell in names[texts[-1] :])
    return texts[-1] if beside else len(names)


def _without_units(row: Sequence[Any], units: Mapping[int, str]) -> list[Any]:
    """Return a row with its texts without the units behind their numbers."""
    bare = row_without_units([cell_text(cell) for cell in row], units)
    return [text if isinstance(cell, str) else cell for cell, text in zip(row, bare, strict=True)]


def _trimmed(row: Sequence[Any]) -> Sequence[Any]:
    filled = [n for n, cell in enumerate(row, 1) if holds_any((cell,))]
    return row[: filled[-1]] if filled else ()


def cell_text(cell: object) -> str:
    """Return a cell as it would stand in a text with tabs between columns."""
    if cell is None:
        return ""
    if isinstance(cell, datetime.datetime):
        return cell.isoformat()
    if isinstance(cell, datetime.timedelta):
        return repr(cell.total_seconds())
    return with_plain_marks(" ".join(str(cell).split()).replace('"', "'"))


def holds_any(row: Sequence[Any]) -> bool:
    """Whether a row has a cell that is not blank."""
    return any(cell is not None and str(cell).strip() for cell in row)


def _header(cell: object, number: int) -> Header:
    text = "" if cell is None else " ".join(str(cell).split())
    name, unit = split_header(text)
    return Header(name or f"#{number}", unit, text or f"#{number}")
