"""Excel workbooks (.xlsx), read with openpyxl: the values that Excel stored, never a formula worked out."""

import datetime
from array import array
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ..units import FLAT_WORDS, split_header
from .libraries import load_library, reading_with
from .table import BLANK_WORDS, Columns, Header, RecordingError, Wanted, not_a_number, quoted

MOST_ROWS = 1_048_576
"""The rows of a sheet (Excel's own limit)."""

_DATES = (datetime.datetime, datetime.timedelta, datetime.time)


class ExcelTable:
    """The first sheet of a workbook that holds anything: a header row, and rows of numbers below it."""

    time_axis: int | None = None

    def __init__(self, path: Path) -> None:
        self.path = path
        self.library = load_library(path, "openpyxl", "openpyxl")
        self.notes: tuple[str, ...] = ()
        self.sheet = ""
        self.header_row = 0
        header: Sequence[Any] = ()
        first: Sequence[Any] = ()
        with reading_with(path, "an Excel workbook"), self._open() as book:
            for sheet in book.worksheets:
                rows = enumerate(sheet.iter_rows(values_only=True), 1)
                start = list(islice(((n, row) for n, row in rows if _holds_any(row)), 2))
                if start and not self.sheet:
                    self.sheet = sheet.title
                    self.header_row, header = start[0]
                    first = start[1][1] if len(start) > 1 else ()
                elif start:
                    self.notes = (f"read from sheet {quoted(self.sheet)}; the workbook has others",)
        if not self.sheet:
            raise RecordingError(f"{path.name}: holds no header and no numbers; export the workbook anew")
        if not any(isinstance(cell, str) for cell in header):
            raise RecordingError(
                f"{path.name}, row {self.header_row}: is no header; put a row above the numbers that names "
                "the columns and their units, such as force [N]"
            )
        self.dated = {number for number, cell in enumerate(first) if isinstance(cell, _DATES)}
        self.headers = [_header(cell, n + 1, n in self.dated) for n, cell in enumerate(header)]

    @contextmanager
    def _open(self) -> Iterator[Any]:
        with self.path.open("rb") as stream:
            book = self.library.load_workbook(stream, read_only=True, data_only=True)
            try:
                yield book
            finally:
                book.close()

    def bytes_needed(self, columns: int) -> int:
        """The rows of a full sheet."""
        return MOST_ROWS * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The columns wanted; an empty cell is NaN, text or an error value such as #DIV/0! is refused.

        A time column of dates, durations or times of day becomes seconds from its first row.
        """
        columns = [array("d") for _ in wanted]
        lines = array("q")
        empty: list[int] = []
        with reading_with(self.path, "an Excel workbook"), self._open() as book:
            for line, row in enumerate(book[self.sheet].iter_rows(values_only=True), 1):
                if line > MOST_ROWS:
                    raise RecordingError(
                        f"{self.path.name}: has more than {MOST_ROWS} rows; export it as CSV"
                    )
                if line <= self.header_row:
                    continue
                if not _holds_any(row):
                    empty.append(line)
                    continue
                # Empty rows at the very end are no rows; those before a row are.
                for skipped in [*empty, line]:
                    lines.append(skipped)
                empty.clear()
                for column, want in zip(columns, wanted, strict=True):
                    column.extend([np.nan] * (len(lines) - len(column) - 1))
                    cell = row[want.index] if want.index < len(row) else None
                    column.append(self._number(cell, line, want))
        values = [np.array(column, dtype=np.float64) for column in columns]
        for want, seconds in zip(wanted, values, strict=True):
            if want.index in self.dated and seconds.size:
                seconds -= seconds[np.argmin(np.isnan(seconds))]
        return Columns(tuple(values), lambda i: f"row {lines[i]}", self.notes)

    def _number(self, cell: object, line: int, want: Wanted) -> float:
        if cell is None:
            return float("nan")
        dated = isinstance(cell, _DATES)
        if dated and want.channel == "time" and want.index in self.dated:
            return _seconds(cell)
        if isinstance(cell, (int, float)) and not isinstance(cell, bool) and want.index not in self.dated:
            return float(cell)
        word = str(cell).strip().lower()
        if word in BLANK_WORDS:
            return float("nan")
        if want.channel == "radius" and word in FLAT_WORDS:
            return float("inf")
        raise not_a_number(self.path.name, f"row {line}", self.headers[want.index].text, cell)


def _holds_any(row: Sequence[Any]) -> bool:
    return any(cell is not None and str(cell).strip() for cell in row)


def _header(cell: object, number: int, dated: bool) -> Header:
    text = "" if cell is None else " ".join(str(cell).split())
    name, unit = split_header(text)
    return Header(name or f"#{number}", "s" if dated else unit, text or f"#{number}", dated)


def _seconds(cell: object) -> float:
    if isinstance(cell, datetime.datetime):
        return (cell.replace(tzinfo=None) - datetime.datetime(1900, 1, 1)).total_seconds()
    if isinstance(cell, datetime.time):
        return cell.hour * 3600.0 + cell.minute * 60.0 + cell.second + cell.microsecond * 1e-6
    assert isinstance(cell, datetime.timedelta)
    return cell.total_seconds()
