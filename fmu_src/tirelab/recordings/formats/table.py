"""What every file format is turned into before it is interpreted: named columns of numbers."""

import re
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...errors import TirelabError
from ..origin import Origin

FloatArray = NDArray[np.float64]

BLANK_WORDS = frozenset(
    {
        *("", "nan", "-nan", "na", "n/a", "n.a.", "#n/a", "null", "none", "--", "---"),
        *("nan(ind)", "-nan(ind)", "1.#ind", "-1.#ind", "1.#qnan", "-1.#qnan", "1.#inf", "-1.#inf"),
        *("-", "?", "<na>", "nil", "#nv", "#n/d", "#n/b", "invalid", "err", "error"),
        *("ol", "ovl", "ovld", "ofl", "overload", "overflow", "overrange", "over range"),
    }
)
"""What a cell may hold, in lower case, to say that nothing was measured, or that it was beyond the range."""

TRUTH_WORDS = frozenset({"true", "false"})
"""What a cell may hold, in lower case, that is neither a number nor the name of a column: a switch."""


_EXCEL_ERRORS = ("#n/a", "#nv", "#n/d", "#n/b", "#div/0!", "#value!", "#ref!", "#name?", "#num!", "#null!")


class RecordingError(TirelabError):
    """A recording that cannot be read: the file, the place in it, what is wrong there, and the next step."""


@dataclass(frozen=True)
class Header:
    """One column as its file names it: its name, its unit if the file gives one, and the whole text.

    dated: whether it holds dates, clock times or durations, which become seconds
    cell_unit: what stands behind every number of it, "" for nothing
    unit_beside: whether the next column holds its unit, row by row
    """

    name: str
    unit: str | None
    text: str
    dated: bool = False
    cell_unit: str = ""
    unit_beside: bool = False


def with_cell_units(headers: Sequence[Header], units: Mapping[int, str]) -> tuple[Header, ...]:
    """Return the headers with the units that stand behind the numbers of some columns."""
    return tuple(
        replace(h, unit=units[i], cell_unit=units[i]) if i in units else h for i, h in enumerate(headers)
    )


def with_dates(headers: Sequence[Header], dated: Container[int]) -> tuple[Header, ...]:
    """Return the headers with seconds as the unit of the `dated` columns."""
    return tuple(Header(h.name, "s", h.text, dated=True) if i in dated else h for i, h in enumerate(headers))


@dataclass(frozen=True)
class Wanted:
    """One column to read, by its number in the file from 0, and the channel of ours that it becomes.

    needed: whether there is no recording without it
    """

    index: int
    channel: str
    needed: bool = True


@dataclass(frozen=True)
class Columns:
    """The columns wanted, in the file's own units and of one length; NaN where the file holds no value."""

    values: tuple[FloatArray, ...]
    place: Callable[[int], str]
    notes: tuple[str, ...] = ()


class Table(Protocol):
    """An opened file: its headers at once, its numbers when they are asked for."""

    @property
    def headers(self) -> Sequence[Header]:
        """The columns in the order of the file."""

    @property
    def time_axis(self) -> int | None:
        """The column that the format itself declares to be time, where it has one."""

    def bytes_needed(self, columns: int) -> int:
        """An estimate of the memory [B] that reading so many columns takes at its peak."""

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The numbers of the columns wanted, in that order."""


class SomeColumns:
    """The columns of a table from one on, so many, as a table of their own."""

    time_axis: int | None = None

    def __init__(self, table: Table, first: int, width: int) -> None:
        self.table = table
        self.first = first
        self.headers: Sequence[Header] = table.headers[first : first + width]

    def bytes_needed(self, columns: int) -> int:
        """What the whole table needs for so many."""
        return self.table.bytes_needed(columns)

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The numbers of the columns wanted."""
        return self.table.read([replace(want, index=self.first + want.index) for want in wanted])


def is_comment(cell: str) -> bool:
    """Whether a row that starts with this cell is a comment, and not with #N/A or another Excel error."""
    start = cell.lstrip().lower()
    return start.startswith("#") and not start.startswith(_EXCEL_ERRORS)


def quoted(text: object) -> str:
    """A text of the file as it may stand in a message: on one line, between quotes, not too long."""
    shown = str(text)
    return repr(shown if len(shown) <= 40 else shown[:37] + "...")


def listed(items: Sequence[str], most: int = 12) -> str:
    """The items one after another, the rest of a long list counted."""
    shown = ", ".join(items[:most])
    return shown if len(items) <= most else f"{shown} and {len(items) - most} more"


def sample_place(index: int) -> str:
    """Where a sample stands in a file without lines, counted from 1."""
    return f"sample {index + 1}"


def not_a_number(origin: object, place: str, header: str, value: object) -> RecordingError:
    """The error for text in a column of numbers."""
    clock = re.search(r"\d:\d\d|\d{4}-\d\d-\d\d", str(value))
    advice = "write times as numbers of seconds" if clock else "correct it, or delete the row"
    return RecordingError(
        f"{origin}, {place}, column {quoted(header)}: {quoted(value)} is not a number; {advice}"
    )


def numbers(origin: Origin, header: Header, values: NDArray[Any], channel: str) -> FloatArray:
    """A column that a library has read, as float64; date and time become seconds from the first sample.

    Errors: RecordingError for text, truth values, complex numbers, and dates in any channel but time.
    """
    column = np.asarray(values)
    if column.dtype.kind in "Mm" and channel == "time" and column.size:
        seconds = (column - column[np.argmin(np.isnat(column))]) / np.timedelta64(1, "s")
        return np.asarray(seconds, dtype=np.float64)
    if column.dtype.kind in "fiu":
        return column.astype(np.float64, copy=False)
    kinds = {"b": "true and false", "c": "complex numbers", "M": "dates", "m": "durations"}
    held = kinds.get(column.dtype.kind, "text")
    shown = next((value for value in column.flat if value is not None), None)
    first = f", {quoted(shown)} the first" if column.size and held == "text" else ""
    raise RecordingError(
        f"{origin}, column {quoted(header.text)}: holds {held}{first}, not numbers; "
        f"name another column with {origin.columns(**{channel: 'NAME'})}"
    )


def of_one_length(origin: Origin, wanted: Sequence[Header], values: Sequence[FloatArray]) -> None:
    """Refuse columns of unequal length: they were not recorded together."""
    lengths = [len(column) for column in values]
    if len(set(lengths)) > 1:
        lengths_shown = listed([f"{quoted(h.text)} {n}" for h, n in zip(wanted, lengths, strict=True)])
        raise RecordingError(
            f"{origin}: the columns have unequal numbers of samples ({lengths_shown}); "
            "resample them to one time, or name columns that were recorded together"
        )


def with_others_blank(
    headers: Sequence[Header], values: Sequence[FloatArray], apart: Mapping[int, str]
) -> tuple[tuple[FloatArray, ...], tuple[str, ...]]:
    """Return the columns with those that were recorded apart as blanks, and a note of each of these.

    apart: by the place of a column among them, what sets it apart
    """
    samples = next((len(column) for i, column in enumerate(values) if i not in apart), 0)
    blank = tuple(np.full(samples, np.nan) if i in apart else column for i, column in enumerate(values))
    return blank, tuple(f"{quoted(headers[i].text)} not read: it {said}" for i, said in apart.items())


def of_other_length(wanted: Sequence[Wanted], values: Sequence[FloatArray]) -> dict[int, str]:
    """Return which of the columns that a recording can do without have another number of samples, and what is said."""
    needed = [len(column) for want, column in zip(wanted, values, strict=True) if want.needed]
    samples = needed[0] if needed else 0
    return {
        i: f"has {len(column)} samples, the others {samples}"
        for i, (want, column) in enumerate(zip(wanted, values, strict=True))
        if needed and not want.needed and len(column) != samples
    }
