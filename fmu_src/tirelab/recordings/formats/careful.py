"""Text read row by row: slower than by columns, and exact about what stands where."""

import csv
import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TextIO

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ..units import FLAT_WORDS
from .cell_units import row_without_units, without_unit
from .clock import Clock, ClockError, is_clock
from .layout import SAMPLE, Layout
from .number_style import (
    DECIMAL_COMMA,
    MAYBE_THOUSANDS,
    NumberStyle,
    maybe_grouped,
    style_of,
    with_plain_marks,
)
from .spaced import with_tabs
from .table import BLANK_WORDS, FloatArray, RecordingError, Wanted, is_comment, not_a_number, quoted
from .table_search import is_value
from .text_rows import TextRows

LONGEST_LINE = 1_048_576
"""More characters than this in one line are not a row of numbers."""


@dataclass(frozen=True)
class Rows:
    """The columns wanted, and row by row the line of the file each came from, counted from 1."""

    values: tuple[FloatArray, ...]
    lines: NDArray[np.int64]
    next_line: int


class RowReader:
    """Reads the rows of one file, from any line on; the decimal mark it finds holds for the whole file.

    fault_from: the line from which on a number is that could not be read
    """

    def __init__(self, path: Path, layout: Layout, wanted: Sequence[Wanted]) -> None:
        self.path = path
        self.layout = layout
        self.wanted = wanted
        self.comments: list[int] = []
        self.fault_from = 0
        self.clocks = {want.index: Clock() for want in wanted if layout.headers[want.index].dated}
        self.cells = _Cells(path, layout)
        self.guarded = layout.counted and all(want.index for want in wanted)
        self.text_rows = TextRows(path.name, layout.headers, layout.spaced)

    def read(self, source: Iterable[str], first_line: int) -> Rows:
        """The rows in some lines of the file; a blank cell is NaN, an empty line a row of NaN unless it is beside a row
        of text, from which it parts the numbers.

        Errors: RecordingError naming row, column and value for text in a number, too many fields, two kinds
        of decimal mark, a quote left open.
        """
        columns: list[array[float] | list[str]] = [
            [] if want.index in self.clocks else array("d") for want in self.wanted
        ]
        lines = array("q")
        targets = [
            (want.index, self.layout.headers[want.index].text, want.channel == "radius")
            for want in self.wanted
        ]
        rows = csv.reader(source, delimiter=self.layout.separator)
        line = first_line
        blank_before, beside_text = 0, False
        try:
            for row in rows:
                start, line = line, first_line + rows.line_num
                if row and is_comment(row[0]):
                    self.comments.append(start)
                    continue
                try:
                    cells = self._cells_of(row, start, targets)
                except RecordingError as fault:
                    self.text_rows.take(start, row_without_units(row, self.layout.cell_units), fault)
                    for taken in (lines, *columns):
                        del taken[len(taken) - blank_before :]
                    blank_before, beside_text = 0, True
                    continue
                blank = len(row) < 2 and not any(map(str.strip, row))
                if blank and beside_text:
                    continue
                blank_before, beside_text = blank_before + 1 if blank else 0, False
                if (self.text_rows.open or not self.text_rows.begins) and any(map(str.strip, row)):
                    self.text_rows.numbers(start, len(row))
                lines.append(start)
                for column, cell in zip(columns, cells, strict=True):
                    column.append(cell)  # type: ignore[arg-type]  # clock times are texts, all else numbers
        except csv.Error as error:
            raise RecordingError(
                f"{self.path.name}, row {line}: {error}; a quote may be left open there: close it"
            ) from None
        values = [
            self._seconds(column, want, lines)
            if isinstance(column, list)
            else (np.frombuffer(column, dtype=np.float64) if column else np.empty(0))
            for column, want in zip(columns, self.wanted, strict=True)
        ]
        return Rows(tuple(values), np.array(lines, dtype=np.int64), first_line + rows.line_num)

    def _cells_of(
        self, row: Sequence[str], line: int, targets: Sequence[tuple[int, str, bool]]
    ) -> list[float | str]:
        """Return the cells wanted of a row, clock times as they are. Errors: RecordingError for any other text."""
        expected = len(self.layout.headers)
        if self.layout.spaced and len(row) != expected and any(map(str.strip, row)):
            raise self._other_width(line, row)
        if len(row) > expected:
            self._refuse_extra_fields(line, row)
        # a label in a column of numbers that nobody wants: a row of statistics
        label = row[0] if row and self.guarded else ""
        if 0 in self.layout.cell_units:
            label = without_unit(label, self.layout.cell_units[0])
        if label.strip().lower() not in BLANK_WORDS and not is_value(label):
            raise not_a_number(self.path.name, f"row {line}", self.layout.headers[0].text, label)
        cells: list[float | str] = []
        for index, header, flat in targets:
            cell = row[index] if index < len(row) else ""
            if index in self.layout.cell_units:
                cell = without_unit(cell, self.layout.cell_units[index])
            if self.layout.headers[index].unit_beside:
                self._refuse_another_unit(line, row, index)
            if index not in self.clocks:
                cells.append(self.cells.number(cell, line, header, flat))
            elif is_clock(cell) or cell.strip().lower() in BLANK_WORDS:
                cells.append(cell)
            else:
                raise not_a_time(self.path.name, line, header, cell)
        return cells

    def _refuse_another_unit(self, line: int, row: Sequence[str], index: int) -> None:
        """Refuse a number whose unit, in the column behind it, is not that of the first rows."""
        header = self.layout.headers[index]
        unit = row[index + 1].strip() if index + 1 < len(row) else ""
        if unit and unit != header.unit:
            raise RecordingError(
                f"{self.path.name}, row {line}, column {quoted(header.text)}: the unit is {quoted(unit)} here and "
                f"{quoted(header.unit)} above; read the rows of one unit, such as {self.path.name}@1:{line - 1}"
            )

    def _seconds(self, texts: Sequence[str], want: Wanted, lines: Sequence[int]) -> FloatArray:
        """The seconds that clock times say; RecordingError with the row of one that is none."""
        try:
            return self.clocks[want.index].seconds(pl.Series(texts, dtype=pl.String))
        except ClockError as fault:
            raise not_a_time(
                self.path.name,
                lines[fault.index],
                self.layout.headers[want.index].text,
                texts[fault.index],
            ) from None

    def read_file(self, rows: tuple[int, int] | None = None) -> Rows:
        """The rows of the whole file, whichever way its lines end; rows: the first and the last of those read."""
        encoding = self.layout.encoding
        errors = "surrogateescape" if encoding.startswith("utf-8") else "replace"
        with self.path.open(encoding=encoding, errors=errors, newline="") as file:
            lines = self._bounded_lines(file)
            first = self.layout.lines_before_data + 1
            if rows is not None:
                first = max(first, rows[0])
                return self.read(islice(lines, first - 1, max(first - 1, rows[1])), first)
            return self.read(islice(lines, first - 1, None), first)

    def refuse_other_table(self, first: int, last: int) -> None:
        """Refuse rows from one to another that stand in a table of other names or units than the first of the file."""
        other = self.text_rows.other_table(self._numbered_rows(self.layout.lines_before_data, first - 1))
        if other:
            raise RecordingError(
                f"{self.path.name}@{first}:{last}, row {first}: stands in a table of other names or units, which "
                f"begins at row {other}; say so with --skip-rows {other - 1}"
            )

    def header_after(self, line: int) -> int:
        """Return the row below a line in which the names of the columns are written again; 0 where they are not."""
        rows = self._numbered_rows(line)
        return next((number for number, row in rows if self.text_rows.is_header(row)), 0)

    def _numbered_rows(self, above: int, last: int | None = None) -> Iterator[tuple[int, list[str]]]:
        """Return the rows of the file below a line, up to the last one, with their numbers."""
        with self.path.open(encoding=self.layout.encoding, errors="replace", newline="") as file:
            lines = islice(self._bounded_lines(file), above, None if last is None else max(last, above))
            for number, line in enumerate(lines, above + 1):
                try:
                    yield number, next(csv.reader([line.rstrip("\r\n")], delimiter=self.layout.separator), [])
                except csv.Error:
                    continue

    def later_style(self) -> NumberStyle | None:
        """Return how numbers are written where a row beyond the head of the file is the first to show it: 1,000.5.

        None where no number leaves no doubt, or the first rows speak against it.
        """
        if self.layout.style.thousands:
            return None
        indices = {want.index for want in self.wanted}
        grouped = maybe_grouped(self.layout.separator)
        first: list[str] = []
        with self.path.open(encoding=self.layout.encoding, errors="replace", newline="") as file:
            lines = islice(self._bounded_lines(file), self.layout.lines_before_data, None)
            for number, line in enumerate(lines):
                beyond = number + self.layout.lines_before_data + 1 >= self.fault_from
                if number >= SAMPLE and not (beyond and grouped.search(line)):
                    continue
                try:
                    row = next(csv.reader([line], delimiter=self.layout.separator), [])
                except csv.Error:
                    continue
                cells = [cell for index, cell in enumerate(row) if index in indices]
                if number < SAMPLE:
                    first += cells
                style = style_of(cells)
                if style.thousands:
                    return style if style.explains(first) else None
        return None

    def _bounded_lines(self, file: TextIO) -> Iterator[str]:
        number = 0
        while line := file.readline(LONGEST_LINE):
            number += 1
            if len(line) == LONGEST_LINE:
                raise RecordingError(
                    f"{self.path.name}, row {number}: the line does not end in {LONGEST_LINE} characters; "
                    "the file is damaged there: export it anew"
                )
            plain = with_plain_marks(line)
            yield with_tabs(plain, len(self.layout.headers)) if self.layout.spaced else plain

    def _other_width(self, line: int, row: Sequence[str]) -> RecordingError:
        cells = sum(len(cell.split()) for cell in row)
        return RecordingError(
            f"{self.path.name}, row {line}: has {cells} cells where the table has {len(self.layout.headers)} columns "
            "between spaces, so nobody can tell which is which; correct the row or delete it"
        )

    def _refuse_extra_fields(self, line: int, row: Sequence[str]) -> None:
        expected = len(self.layout.headers)
        if not any(cell.strip() for cell in row[expected:]):
            return
        advice = (
            "if these are decimal commas, separate the columns by semicolons"
            if self.layout.separator == ","
            else "correct the row or delete it"
        )
        raise RecordingError(
            f"{self.path.name}, row {line}: has {len(row)} fields where the header has {expected} "
            f"({quoted(row[expected])} is one too many); {advice}"
        )


def not_a_time(origin: str, line: int, header: str, text: str) -> RecordingError:
    """The error for a text among clock times."""
    if re.fullmatch(r"\d{1,3}:\d\d", text.strip()):
        return RecordingError(
            f"{origin}, row {line}, column {quoted(header)}: {quoted(text)} may be hours and minutes or minutes and "
            f"seconds; write it with both, 00:{text.strip()} or {text.strip()}:00"
        )
    return RecordingError(
        f"{origin}, row {line}, column {quoted(header)}: {quoted(text)} is not a time like those before it; "
        "correct it, or delete the row"
    )


class _Cells:
    """The cells of one file, held to one decimal mark."""

    def __init__(self, path: Path, layout: Layout) -> None:
        self.path = path
        self.commas = layout.separator != "," or layout.style.decimal_comma
        self.style = layout.style
        self.mark = ""
        self.mark_line = 0
        self.certain = layout.style.decimal_comma
        self.doubtful: RecordingError | None = None

    def number(self, text: str, line: int, header: str, flat: bool) -> float:
        if self.style.thousands:
            text = self.style.ungrouped(text)
        if "," in text:
            return self._with_comma(text, line, header)
        # float() also takes 1_000 and the digits of other scripts; a recording means neither.
        if text.isascii() and "_" not in text:
            try:
                value = float(text)
            except ValueError:
                pass
            else:
                if "." in text:
                    self.hold_to(".", line, header, text)
                return value
        word = text.strip().lower()
        if word in BLANK_WORDS:
            return float("nan")
        if flat and word in FLAT_WORDS:
            return float("inf")
        raise not_a_number(self.path.name, f"row {line}", header, text)

    def _with_comma(self, text: str, line: int, header: str) -> float:
        maybe = MAYBE_THOUSANDS.fullmatch(text) is not None
        if maybe and not self.commas:
            raise self._either(text, line, header)
        if not (self.commas and DECIMAL_COMMA.fullmatch(text)):
            raise not_a_number(self.path.name, f"row {line}", header, text)
        self.hold_to(",", line, header, text)
        if not self.certain and not maybe:
            self.certain = True
        elif not self.certain and self.doubtful is None:
            self.doubtful = self._either(text, line, header)
        return float(text.replace(",", "."))

    def _either(self, text: str, line: int, header: str) -> RecordingError:
        number = "" if self.commas else "is not a number where commas separate the columns: it "
        return RecordingError(
            f"{self.path.name}, row {line}, column {quoted(header)}: {quoted(text)} {number}may have a decimal "
            "comma or a thousands mark, and no number here tells which; write decimal points"
        )

    def hold_to(self, mark: str, line: int, header: str = "", text: str = "") -> None:
        """Note the decimal mark of the file; a second kind of mark is refused."""
        if not self.mark:
            self.mark, self.mark_line = mark, line
        elif mark != self.mark:
            raise RecordingError(
                f"{self.path.name}, row {line}, column {quoted(header)}: {quoted(text)} has the decimal mark "
                f"{mark!r} and row {self.mark_line} has {self.mark!r}; write all numbers with one mark, without marks "
                "between thousands"
            )

    def decimal_mark(self) -> str:
        """The decimal mark of the file; an error if its commas might as well be thousands marks."""
        if self.doubtful is not None and not self.certain:
            raise self.doubtful
        return self.mark
