"""Workbooks (.xlsx, .xls, .xlsb, .ods): the values that are stored, never a formula worked out.

The table of a sheet is found as that of a text: below lines about the test, with units below the names. Sheets with the
same columns, as testing machines write one for each specimen, are tests side by side.
"""

import datetime
import io
import re
import shlex
import threading
from array import array
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ..units import FLAT_WORDS, measures, split_header
from ..vocabulary import any_channel
from .cell_units import lines_without_units, row_without_units, taken_from_cells, units_in_cells, without_unit
from .layout import below_names, column_counted
from .libraries import load_library, reading_with
from .number_style import NumberStyle, style_of, with_plain_minus
from .table import BLANK_WORDS, Columns, Header, RecordingError, Wanted, listed, not_a_number, quoted
from .table_search import SEARCHED, find_table, is_value
from .text_rows import TextRows

MOST_ROWS = 1_048_576
"""The rows of a sheet (Excel's own limit)."""

MOST_SHEETS = 200
"""So many sheets of a workbook are looked at."""

KEPT = 4
"""Of so many workbooks the tables are remembered."""

MOST_KEPT = 64 * 2**20
"""A workbook of up to this size [B] is kept open for the next test in it."""

OTHERS = (".xls", ".xlsb", ".ods")
"""The workbooks that openpyxl cannot read, and calamine can."""

_NEEDED = (
    ("deflection", "m", {"deflection", "displacement", "stroke", "travel", "compression"}),
    ("force", "N", {"force", "load"}),
)
"""Of the two channels that are needed: the SI unit, and English words of their names."""

_NUMBER = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?", re.ASCII)

_DATES = (datetime.datetime, datetime.timedelta, datetime.time)


@dataclass(frozen=True)
class Sheet:
    """The table of one sheet: its title, its row of names and its first row of numbers from 1, its columns.

    style: of numbers that are stored as text, where most rows hold one; rows: how many were seen below the names;
    counted: whether its first column holds no text; provenance: the rows above the names
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

    @property
    def cell_units(self) -> Mapping[int, str]:
        """The units of the columns in which every number has its unit behind it."""
        return {index: header.cell_unit for index, header in enumerate(self.headers) if header.cell_unit}


class ExcelTable:
    """The columns of the first sheet that holds a recording, and beside them those of the sheets that are like it.

    Where a sheet is named, its columns alone.
    """

    time_axis: int | None = None

    def __init__(self, path: Path, sheet: str = "") -> None:
        self.path = path
        self.one = sheet
        with reading_with(path, "a workbook"):
            found = _tables(_Version.of(path), sheet)
        if not found:
            what = f", sheet {quoted(sheet)}" if sheet else ""
            raise RecordingError(
                f"{path.name}{what}: holds no header and no numbers; export the workbook anew"
            )
        # of sheets with the same channels the longest: one of results has a row for each specimen, or a single one
        chosen = max(found, key=lambda sheet: (sheet.rows > 1, _channels(sheet.headers), sheet.rows))
        if not chosen.header_row:
            raise RecordingError(
                f"{path.name}, row {chosen.first_row} is no header; put a row above the numbers that names "
                "the columns and their units, such as force [N]"
            )
        names = [header.text for header in chosen.headers]
        self.sheets = [sheet for sheet in found if [header.text for header in sheet.headers] == names]
        self.headers: Sequence[Header] = [header for sheet in self.sheets for header in sheet.headers]
        self.others = tuple(sheet.title for sheet in found if sheet not in self.sheets)

    def sheet_of(self, index: int) -> Sheet:
        """The sheet on which a column stands."""
        return self.sheets[index // len(self.sheets[0].headers)]

    def bytes_needed(self, columns: int) -> int:
        """The rows of a full sheet."""
        return MOST_ROWS * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The columns wanted, of one sheet; an empty cell is NaN, text or an error value such as #DIV/0! is refused.

        A time column of dates, durations or times of day becomes seconds from its first row.
        """
        width = len(self.sheets[0].headers)
        chosen = {want.index // width for want in wanted}
        if len(chosen) > 1:
            raise RecordingError(
                f"{self.path.name}: the columns named are on several sheets; name those of one of them"
            )
        sheet = self.sheets[min(chosen, default=0)]
        text_rows = TextRows(self.path.name, sheet.headers)
        guarded = sheet.counted and all(want.index % width for want in wanted)
        columns = [array("d") for _ in wanted]
        lines = array("q")
        empty: list[int] = []
        with reading_with(self.path, "a workbook"):
            for line, row in enumerate(_opened(_Version.of(self.path)).rows(sheet.title), 1):
                if line > MOST_ROWS:
                    raise RecordingError(
                        f"{self.path.name}: has more than {MOST_ROWS} rows; export it as CSV"
                    )
                if line < sheet.first_row:
                    continue
                row = row[:width]
                if not _holds_any(row):
                    empty.append(line)
                    continue
                texts = row_without_units(
                    [_text(cell) for cell in (*row, *[None] * width)[:width]],
                    sheet.cell_units,
                )
                try:
                    numbers = [self._number(_at(row, want.index % width), line, want) for want in wanted]
                    if guarded and texts[0] and not is_value(texts[0]):
                        raise not_a_number(self.path.name, f"row {line}", sheet.headers[0].text, texts[0])
                except RecordingError as fault:
                    text_rows.take(line, texts, fault)
                    continue
                text_rows.numbers(line)
                # Empty rows at the very end are no rows; those before a row are.
                for skipped in [*empty, line]:
                    lines.append(skipped)
                empty.clear()
                for column, number in zip(columns, numbers, strict=True):
                    column.extend([np.nan] * (len(lines) - len(column) - 1))
                    column.append(number)
        values = [np.array(column, dtype=np.float64) for column in columns]
        for want, seconds in zip(wanted, values, strict=True):
            if self.headers[want.index].dated and seconds.size:
                seconds -= seconds[np.argmin(np.isnan(seconds))]
        notes = [*sheet.notes]
        if self.one or self.others or len(self.sheets) > 1:
            notes.append(f"read from sheet {quoted(sheet.title)}{self._others_text()}")
        return Columns(tuple(values), lambda i: f"row {lines[i]}", (*notes, *text_rows.notes()))

    def _others_text(self) -> str:
        """Return which sheets have other columns, and how one of them is read."""
        if not self.others:
            return ""
        how = shlex.quote(f"{self.path.name}@{self.others[0]}")
        others = listed(list(map(quoted, self.others)))
        return f"; sheets of other columns: {others}; one is read by its name, as {how}"

    def _number(self, cell: object, line: int, want: Wanted) -> float:
        header = self.headers[want.index]
        if cell is None:
            return float("nan")
        if header.cell_unit:
            cell = without_unit(_text(cell), header.cell_unit)
        if isinstance(cell, _DATES) and want.channel == "time" and header.dated:
            return _seconds(cell)
        if isinstance(cell, (int, float)) and not isinstance(cell, bool) and not header.dated:
            return float(cell)
        word = str(cell).strip().lower()
        if word in BLANK_WORDS:
            return float("nan")
        if want.channel == "radius" and word in FLAT_WORDS:
            return float("inf")
        number = self._as_text(cell, self.sheet_of(want.index).style)
        if number is not None:
            return number
        raise not_a_number(self.path.name, f"row {line}", header.text, cell)

    @staticmethod
    def _as_text(cell: object, style: NumberStyle | None) -> float | None:
        """Return a number that is stored as text, written as others of its sheet are; None for any other cell."""
        if style is None or not isinstance(cell, str):
            return None
        text = style.ungrouped(with_plain_minus(cell.strip()))
        if style.decimal_comma:
            text = "" if "." in text else text.replace(",", ".")
        if _NUMBER.fullmatch(text) is None:
            return None
        return float(text)


class _OfOpenpyxl:
    """A workbook that openpyxl opened."""

    def __init__(self, book: Any) -> None:
        self.book = book
        self.titles = [sheet.title for sheet in book.worksheets]

    def rows(self, title: str) -> Iterator[Sequence[Any]]:
        """The rows of a sheet from the first on."""
        yield from self.book[title].iter_rows(values_only=True)


class _OfCalamine:
    """A workbook that calamine opened."""

    def __init__(self, book: Any) -> None:
        self.book = book
        self.titles = list(book.sheet_names)

    def rows(self, title: str) -> Iterator[Sequence[Any]]:
        """The rows of a sheet from the first on."""
        yield from self.book.get_sheet_by_name(title).to_python(skip_empty_area=False)


@dataclass(frozen=True)
class _Version:
    """A file as it is now, for one thread: what was read of it holds until it is written again."""

    path: Path
    written: int
    size: int
    thread: int

    @classmethod
    def of(cls, path: Path) -> "_Version":
        """Return the file's version of this moment."""
        stat = path.stat()
        return cls(path.absolute(), stat.st_mtime_ns, stat.st_size, threading.get_ident())


def _opened(version: _Version) -> _OfOpenpyxl | _OfCalamine:
    """Return a workbook, opened once for all the tests in it unless it is too large to be kept."""
    return _kept(version) if version.size <= MOST_KEPT else _loaded(version.path)


@lru_cache(maxsize=1)
def _kept(version: _Version) -> _OfOpenpyxl | _OfCalamine:
    return _loaded(version.path)


def _loaded(path: Path) -> _OfOpenpyxl | _OfCalamine:
    """Return a workbook that does not hold its file open."""
    stream = io.BytesIO(path.read_bytes())
    if path.suffix.lower() in OTHERS:
        calamine = load_library(path, "python_calamine", "python-calamine")
        return _OfCalamine(calamine.CalamineWorkbook.from_filelike(stream))
    openpyxl = load_library(path, "openpyxl", "openpyxl")
    return _OfOpenpyxl(openpyxl.load_workbook(stream, read_only=True, data_only=True))


@lru_cache(maxsize=KEPT)
def _tables(version: _Version, sheet: str) -> tuple[Sheet, ...]:
    """Return the tables of the sheets of a workbook that hold anything, or of the one that is named."""
    book = _opened(version)
    titles = [_titled(version.path, book.titles, sheet)] if sheet else book.titles[:MOST_SHEETS]
    heads = {title: [list(row) for row in islice(book.rows(title), SEARCHED)] for title in titles}
    return tuple(_sheet(title, head) for title, head in heads.items() if any(map(_holds_any, head)))


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
    lines = ["\t".join(map(_text, [*row, *[None] * width][:width])) + "\n" for row in head]
    first = next(i for i, row in enumerate(head) if _holds_any(row))
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
    if not any(isinstance(cell, str) and cell.strip() for cell in names):
        return Sheet(title, 0, start + 1, (), ())
    headers = tuple(_header(cell, n) for n, cell in enumerate(names, 1))
    headers, below, notes = below_names(lines, start + 1, headers, "\t")
    values = next((row for row in head[start + 1 + below :] if _holds_any(row)), ())
    dated = {n for n, cell in enumerate(values) if isinstance(cell, _DATES)}
    headers = tuple(
        Header(h.name, "s", h.text, dated=True) if n in dated else h for n, h in enumerate(headers)
    )
    if cell_units:
        headers = tuple(
            replace(h, unit=cell_units[n], cell_unit=cell_units[n]) if n in cell_units else h
            for n, h in enumerate(headers)
        )
        notes = (*notes, taken_from_cells(cell_units.values()))
    if start > first:
        notes = (*notes, f"table found at row {start + 1}: the rows above it are kept as its provenance")
    body = head[start + 1 + below :]
    style = None
    if 2 * sum(any(map(_is_text_number, row)) for row in body) > len(body):
        style = style_of(cell for row in body for cell in row if isinstance(cell, str))
        marks = "commas" if style.decimal_comma else "points"
        notes = (*notes, f"numbers that are stored as text read with decimal {marks}")
    counted = column_counted([[_text(cell) for cell in row] for row in body])
    above = tuple("; ".join(filter(None, map(_text, row))) for row in head[:start] if _holds_any(row))
    return Sheet(title, start + 1, start + below + 2, headers, notes, style, len(body), counted, above)


def _named_width(names: Sequence[Any]) -> int:
    """Return how many columns a row of names has: it ends before numbers, which are of a table beside it."""
    texts = [n for n, cell in enumerate(names, 1) if isinstance(cell, str) and cell.strip()]
    beside = texts and any(isinstance(cell, (int, float)) for cell in names[texts[-1] :])
    return texts[-1] if beside else len(names)


def _channels(headers: Sequence[Header]) -> int:
    """Return how many of the two columns that a recording needs are named, or have their unit: deflection and force."""
    found = 0
    for channel, si, words in _NEEDED:
        found += any(
            measures(h.unit or "", si)
            or any_channel(h.name) == channel
            or words & set(h.name.lower().split())
            for h in headers
        )
    return found


def _without_units(row: Sequence[Any], units: Mapping[int, str]) -> list[Any]:
    """Return a row with its texts without the units behind their numbers."""
    bare = row_without_units([_text(cell) for cell in row], units)
    return [text if isinstance(cell, str) else cell for cell, text in zip(row, bare, strict=True)]


def _trimmed(row: Sequence[Any]) -> Sequence[Any]:
    filled = [n for n, cell in enumerate(row, 1) if _holds_any((cell,))]
    return row[: filled[-1]] if filled else ()


def _is_text_number(cell: object) -> bool:
    return isinstance(cell, str) and _NUMBER.fullmatch(with_plain_minus(cell.strip())) is not None


def _at(row: Sequence[Any], place: int) -> Any:
    return row[place] if place < len(row) else None


def _text(cell: object) -> str:
    """Return a cell as it would stand in a text with tabs between columns."""
    if cell is None:
        return ""
    if isinstance(cell, datetime.datetime):
        return cell.isoformat()
    if isinstance(cell, datetime.timedelta):
        return repr(cell.total_seconds())
    return with_plain_minus(" ".join(str(cell).split()).replace('"', "'"))


def _holds_any(row: Sequence[Any]) -> bool:
    return any(cell is not None and str(cell).strip() for cell in row)


def _header(cell: object, number: int) -> Header:
    text = "" if cell is None else " ".join(str(cell).split())
    name, unit = split_header(text)
    return Header(name or f"#{number}", unit, text or f"#{number}")


def _seconds(cell: object) -> float:
    if isinstance(cell, datetime.datetime):
        return (cell.replace(tzinfo=None) - datetime.datetime(1900, 1, 1)).total_seconds()
    if isinstance(cell, datetime.time):
        return cell.hour * 3600.0 + cell.minute * 60.0 + cell.second + cell.microsecond * 1e-6
    assert isinstance(cell, datetime.timedelta)
    return cell.total_seconds()
