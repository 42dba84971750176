"""Rows of text among the rows of numbers: remarks, headers that are written again, and what stands below the table.

Machines name the steps of a test between its rows, begin each block of an acquisition with the header again, and put
statistics below. Such rows are left out, and it is said which. A row is left out only where no number is lost by it: a
row with numbers in it has to stand above a repeated header or below the table, and its label must not be a number that
was damaged. Anything else is refused as it was.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..units import is_no_unit
from .table import BLANK_WORDS, Header, RecordingError, listed, quoted
from .table_search import bare_unit, is_value, named, states_units

MOST_ASIDE = 60
"""Most rows of text below the table, or between a block of it and its next header."""


@dataclass(frozen=True)
class _Aside:
    """A row that was set aside: its line, its first cell, whether that is all it holds, and the fault found in it.

    names: how many cells it has, if several and most of them are no number; else 0
    """

    line: int
    text: str
    remark: bool
    names: int
    fault: RecordingError

    def __str__(self) -> str:
        return f"{self.line} ({quoted(self.text)})"


def _mostly_digits(cell: str) -> bool:
    """Whether a cell is rather a damaged number, 39.9x, than the label of a row of statistics, Mean or Peak 1."""
    return 2 * sum(character.isdigit() for character in cell) >= len(cell)


class AnotherTable(RecordingError):
    """Another table that begins at a line; above: how the one above it is named.

    again: the row further down in which the names of the first one stand again, 0 for none
    """

    def __init__(self, file: str, line: int, above: str, again: int = 0) -> None:
        other = f"the one below row {again}" if again else "this one"
        super().__init__(
            f"{file}, row {line}: another table begins here; read the one above it, {above}, or "
            f"{other}, --skip-rows {(again or line) - 1}"
        )
        self.told = file, line, above


class TextRows:
    """Judges the rows of one file that cannot be read as numbers, in the order of the file."""

    def __init__(self, file: str, headers: Sequence[Header], spaced: bool = False) -> None:
        self.file = file
        self.headers = headers
        self.spaced = spaced
        self.remarks: list[str] = []
        self.repeated: list[str] = []
        self.begins = 0
        self._aside: list[_Aside] = []
        self._after_header = False
        self._another = 0

    @property
    def open(self) -> bool:
        """Whether what follows decides over rows that were set aside."""
        return bool(self._aside) or self._after_header

    def take(self, line: int, row: Sequence[str], fault: RecordingError) -> None:
        """Set a row aside, or raise the fault that was found in it."""
        cells = " ".join(row).split() if self.spaced else row
        filled = [cell.strip() for cell in cells if cell.strip().lower() not in BLANK_WORDS]
        if self.is_header(row):
            self.repeated.append(str(line))
            self._aside.clear()
            self._after_header, self._another = True, 0
            return
        if self._is_unit_row(row):
            return
        if self._after_header and states_units(row):
            self._check_units(line, row)
            return
        if not filled or is_value(filled[0]):
            raise self._wider_or_narrower(len(row)) or fault
        if len(self._aside) >= MOST_ASIDE:
            raise self._aside[0].fault
        values = [is_value(cell) for cell in filled]
        if len(filled) == len(self.headers) > 1 and all(values[1:]) and _mostly_digits(filled[0]):
            raise fault
        numbers = any(values)
        if len(filled) > 1 and not numbers and len(row) == len(self.headers):
            self._another = self._another or line
        alone = sum(map(bool, map(str.strip, row))) == 1
        names = len(row) if len(filled) > 1 and 2 * sum(values) < len(filled) else 0
        self._aside.append(_Aside(line, filled[0], alone, names, fault))

    def numbers(self, line: int, cells: int) -> None:
        """Note a row of numbers of so many cells: what was set aside above it has to be remarks alone.

        Errors: RecordingError.
        """
        self.begins = self.begins or line
        self._after_header = False
        for row in self._aside:
            if row.remark:
                self.remarks.append(str(row))
            elif self._another:
                raise self._another_table(self._another)
            else:
                raise self._wider_or_narrower(cells) or row.fault
        self._aside.clear()

    def _wider_or_narrower(self, cells: int) -> RecordingError | None:
        """The error for another table, of as many columns as its names, where a row has so many cells; None else."""
        names = [row.line for row in self._aside if row.names == cells != len(self.headers)]
        return self._another_table(names[-1]) if names else None

    def _another_table(self, line: int) -> RecordingError:
        return AnotherTable(self.file, line, f"{self.file}@{self.begins}:{self._aside[0].line - 1}")

    def notes(self) -> list[str]:
        """Return what was left out, at the end of the file."""
        said = []
        if self.remarks:
            said.append(f"rows of text among the numbers left out: row {listed(self.remarks)}")
        if self.repeated:
            said.append(f"header written again, its rows read on: row {listed(self.repeated)}")
        if self._aside:
            said.append(f"rows below the table left out: row {listed(list(map(str, self._aside)))}")
        return said

    def other_table(self, rows: Iterable[tuple[int, Sequence[str]]]) -> int:
        """Return the row that begins a table of other names or units than the first, the last of these rows being in
        it; 0 where they are in a table of the same. rows: each with its number in the file
        """
        header = other = 0
        for number, row in rows:
            filled = [cell for cell in row if cell.strip().lower() not in BLANK_WORDS]
            if self.is_header(row):
                header, other = number, 0
            elif len(filled) < 2 or any(map(is_value, filled)) or self._is_unit_row(row):
                continue
            elif states_units(row) or named(row) > 1:
                other = other if 0 < other == number - 1 else header if 0 < header == number - 1 else number
        return other

    def is_header(self, row: Sequence[str]) -> bool:
        """Whether a row names the same columns in the same order; a number among the names is that of a specimen."""
        texts = [" ".join(cell.split()) for cell in row]
        names = [header.text for header in self.headers]
        while texts and not texts[-1]:
            texts.pop()
        while names and names[-1].startswith("#"):
            names.pop()
        if len(texts) < 2 or len(texts) != len(names):
            return False
        pairs = [pair for pair in zip(texts, names, strict=True) if not all(map(str.isdecimal, pair))]
        return bool(pairs) and all(text == name for text, name in pairs)

    def _is_unit_row(self, row: Sequence[str]) -> bool:
        """Whether a row holds the units of the columns, words that are no units among them: sec, segments, mm."""
        cells = [*map(bare_unit, row), *[""] * (len(self.headers) - len(row))]
        stated = [
            (cell, header.unit or "")
            for cell, header in zip(cells, self.headers, strict=False)
            if not header.dated and (cell or header.unit)
        ]
        beyond = any(cells[len(self.headers) :])
        return len(stated) > 1 and not beyond and all(cell == unit for cell, unit in stated)

    def _check_units(self, line: int, row: Sequence[str]) -> None:
        """Refuse units below a repeated header that are not those of the first."""
        for header, cell in zip(self.headers, row, strict=False):
            unit = bare_unit(cell)
            if (
                unit
                and header.unit
                and not header.dated
                and unit != header.unit
                and not is_no_unit(header.unit)
            ):
                raise RecordingError(
                    f"{self.file}, row {line}, column {quoted(header.text)}: the unit is {quoted(unit)} here and "
                    f"{quoted(header.unit)} above; read the blocks one by one: {self.file}@{self.begins}:{line - 2}"
                )
