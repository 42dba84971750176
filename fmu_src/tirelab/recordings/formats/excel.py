"""Workbooks (.xlsx, .xls, .xlsb, .ods): the values that are stored, never a formula worked out.

The table of a sheet is found as that of a text: below lines about the test, with units below the names. Sheets with the
same columns, as testing machines write one for each specimen, are tests side by side.
"""

import datetime
import shlex
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..units import FLAT_WORDS, measures
from ..vocabulary import any_channel
from .cell_units import row_without_units, without_unit
from .libraries import reading_with
from .sheet import DATES, Sheet, cell_text, holds_any, length, stored_as_text, tables_of
from .table import (
    BLANK_WORDS,
    Columns,
    FloatArray,
    Header,
    RecordingError,
    Wanted,
    listed,
    not_a_number,
    quoted,
)
from .table_search import is_value
from .text_rows import TextRows
from .workbook import Version, never_worked_out, opened

MOST_ROWS = 1_048_576
"""The rows of a sheet (Excel's own limit)."""

MOST_UNWORKED = 0.1
"""The share of rows without a value from which on a formula without a result is refused, and not noted."""

_NEEDED = (
    ("deflection", "m", {"deflection", "displacement", "stroke", "travel", "compression"}),
    ("force", "N", {"force", "load"}),
)
"""Of the two channels that are needed: the SI unit, and English words of their names."""


class ExcelTable:
    """The columns of the first sheet that holds a recording, and beside them those of the sheets that are like it.

    Where a sheet is named, its columns alone.
    """

    time_axis: int | None = None

    def __init__(self, path: Path, sheet: str = "") -> None:
        self.path = path
        self.one = sheet
        version = Version.of(path)
        with reading_with(path, "a workbook"):
            holding = tables_of(version, sheet)
        found = [table for table in holding if sheet or not table.hidden]
        self.hidden = tuple(table.title for table in holding if table not in found)
        self._refuse_hidden(found, [table for table in holding if table not in found])
        if not found:
            what = f", sheet {quoted(sheet)}" if sheet else ""
            raise RecordingError(
                f"{path.name}{what}: holds no header and no numbers; export the workbook anew"
            )
        with reading_with(path, "a workbook"):
            names = _names(_chosen(found, version))
        alike = [sheet for sheet in found if _names(sheet) == names]
        # columns without a name behind the last one that has one: of these sheets, some may have them, others not
        width = min(len(sheet.headers) for sheet in alike)
        self.sheets = [replace(sheet, headers=sheet.headers[:width]) for sheet in alike]
        self.headers: Sequence[Header] = [header for sheet in self.sheets for header in sheet.headers]
        self.others = tuple(sheet.title for sheet in found if sheet not in alike)

    def _refuse_hidden(self, shown: Sequence[Sheet], hidden: Sequence[Sheet]) -> None:
        """Refuse a workbook of which a hidden sheet alone has a deflection and a force."""
        whole = [sheet for sheet in hidden if _channels(sheet.headers) == len(_NEEDED)]
        if not whole or any(_channels(sheet.headers) == len(_NEEDED) for sheet in shown):
            return
        sheets = listed([quoted(sheet.title) for sheet in whole])
        ways = [f"{self.path.name}@{sheet.title}" for sheet in (*whole[:1], *shown[:1])]
        instead = f"; one that is shown: {shlex.quote(ways[1])}" if len(ways) > 1 else ""
        raise RecordingError(
            f"{self.path.name}: the sheets that it shows have no columns for deflection and force, and {sheets} "
            f"{'is' if len(whole) == 1 else 'are'} hidden; one is read by its name, as {shlex.quote(ways[0])}{instead}"
        )

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
        # Text in a first column of numbers that is not wanted is the label of a row of statistics.
        guarded = sheet.counted and all(want.index % width for want in wanted)
        columns = [array("d") for _ in wanted]
        lines = array("q")
        empty: list[int] = []
        with reading_with(self.path, "a workbook"):
            for line, row in self._rows_below_names(sheet):
                if not holds_any(row):
                    empty.append(line)
                    continue
                texts = row_without_units(
                    [cell_text(cell) for cell in (*row, *[None] * width)[:width]],
                    sheet.cell_units,
                )
                try:
                    numbers = [self._number(_at(row, want.index % width), line, want) for want in wanted]
                    if guarded and texts[0] and not is_value(texts[0]):
                        raise not_a_number(self.path.name, f"row {line}", sheet.headers[0].text, texts[0])
                except RecordingError as fault:
                    text_rows.take(line, texts, fault)
                    continue
                text_rows.numbers(line, len(texts))
                # Empty rows at the very end are no rows; those before a row are.
                for skipped in [*empty, line]:
                    lines.append(skipped)
                empty.clear()
                for column, number in zip(columns, numbers, strict=True):
                    column.extend([np.nan] * (len(lines) - len(column) - 1))
                    column.append(number)
        values = [np.array(column, dtype=np.float64) for column in columns]
        unworked = self._unworked(sheet, wanted, values, lines)
        for want, seconds in zip(wanted, values, strict=True):
            if self.headers[want.index].dated and seconds.size:
                seconds -= seconds[np.argmin(np.isnan(seconds))]
        notes = (*sheet.notes, *self._which_sheet(sheet), *unworked, *text_rows.notes())
        return Columns(tuple(values), lambda i: f"row {lines[i]}", notes)

    def _unworked(
        self, sheet: Sheet, wanted: Sequence[Wanted], values: Sequence[FloatArray], lines: Sequence[int]
    ) -> tuple[str, ...]:
        """Return the note of a formula without a result where a column has its first blank.

        Errors: RecordingError where the column has so many blanks that it cannot be read.
        """
        for want, column in zip(wanted, values, strict=True):
            blank = np.flatnonzero(np.isnan(column))
            if column.size and not blank.size:
                continue
            row = lines[blank[0]] if blank.size else sheet.first_row
            place = want.index % len(sheet.headers)
            cell = never_worked_out(Version.of(self.path), sheet.title, row, place)
            if not cell:
                continue
            said = (
                f"sheet {quoted(sheet.title)}, cell {cell}: its formula was never worked out; open the workbook in a "
                "spreadsheet program and save it"
            )
            if blank.size >= MOST_UNWORKED * column.size:
                raise RecordingError(f"{self.path.name}, {said}")
            return (said,)
        return ()

    def _rows_below_names(self, sheet: Sheet) -> Iterator[tuple[int, Sequence[Any]]]:
        """Return the number of each row below the names, and its cells in the columns of the table."""
        for line, row in enumerate(opened(Version.of(self.path)).rows(sheet.title), 1):
            if line > MOST_ROWS:
                raise RecordingError(f"{self.path.name}: has more than {MOST_ROWS} rows; export it as CSV")
            if line >= sheet.first_row:
                yield line, row[: len(sheet.headers)]

    def _which_sheet(self, sheet: Sheet) -> tuple[str, ...]:
        """Return the note of the sheet that was read, where there is a choice."""
        if not (self.one or self.others or self.hidden or len(self.sheets) > 1):
            return ()
        return (f"read from sheet {quoted(sheet.title)}{self._others_text()}{self._hidden_text()}",)

    def _others_text(self) -> str:
        """Return which sheets have other columns, and how one of them is read."""
        if not self.others:
            return ""
        how = shlex.quote(f"{self.path.name}@{self.others[0]}")
        others = listed(list(map(quoted, self.others)))
        return f"; sheets of other columns: {others}; one is read by its name, as {how}"

    def _hidden_text(self) -> str:
        """Return which sheets are hidden, and how one of them is read."""
        if not self.hidden:
            return ""
        how = shlex.quote(f"{self.path.name}@{self.hidden[0]}")
        return f"; hidden and not read: {listed(list(map(quoted, self.hidden)))}; one is read as {how}"

    def _number(self, cell: object, line: int, want: Wanted) -> float:
        header = self.headers[want.index]
        if cell is None:
            return float("nan")
        if header.cell_unit:
            cell = without_unit(cell_text(cell), header.cell_unit)
        if isinstance(cell, DATES) and want.channel == "time" and header.dated:
            return _seconds(cell)
        if isinstance(cell, (int, float)) and not isinstance(cell, bool) and not header.dated:
            return float(cell)
        word = str(cell).strip().lower()
        if word in BLANK_WORDS:
            return float("nan")
        if want.channel == "radius" and word in FLAT_WORDS:
            return float("inf")
        style = self.sheet_of(want.index).style
        number = None if style is None else stored_as_text(cell, style)
        if number is not None:
            return number
        raise not_a_number(self.path.name, f"row {line}", header.text, cell)


def _chosen(found: Sequence[Sheet], version: Version) -> Sheet:
    """Return the sheet that holds the recording; of several with its channels the longest.

    One of results has a row for each specimen, or a single one; one of a preload has fewer than the test.
    """
    best = max((sheet.rows > 1, _channels(sheet.headers)) for sheet in found)
    same = [sheet for sheet in found if (sheet.rows > 1, _channels(sheet.headers)) == best]
    if all(_names(sheet) == _names(same[0]) for sheet in same):
        return same[0]
    return max(same, key=lambda sheet: length(version, sheet.title))


def _names(sheet: Sheet) -> list[str]:
    """Return what the columns of a sheet are called, to the last one that has a name."""
    texts = [header.text for header in sheet.headers]
    named = [n for n, header in enumerate(sheet.headers, 1) if header.name != f"#{n}"]
    return texts[: named[-1]] if named else texts


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


def _at(row: Sequence[Any], place: int) -> Any:
    return row[place] if place < len(row) else None


def _seconds(cell: object) -> float:
    if isinstance(cell, datetime.datetime):
        return (cell.replace(tzinfo=None) - datetime.datetime(1900, 1, 1)).total_seconds()
    if isinstance(cell, datetime.time):
        return cell.hour * 3600.0 + cell.minute * 60.0 + cell.second + cell.microsecond * 1e-6
    assert isinstance(cell, datetime.timedelta)
    return cell.total_seconds()
