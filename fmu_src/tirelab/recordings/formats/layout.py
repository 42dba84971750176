"""How a text file is laid out: its encoding, its separator, its header and where its numbers start."""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ..units import split_header
from .cell_units import lines_without_units, taken_from_cells, units_in_cells
from .clock import is_clock
from .encoding import find_encoding
from .header_units import BELOW_NAMES, above_names, below_names, over_time, units_beside
from .not_a_table import refuse_labels, refuse_serial_monitor, refuse_split_numbers
from .number_style import NumberStyle, style_of, with_plain_marks
from .separator import find_separator
from .spaced import TAB, spaced_columns, with_tabs
from .table import (
    BLANK_WORDS,
    TRUTH_WORDS,
    Header,
    RecordingError,
    is_comment,
    quoted,
    with_cell_units,
    with_dates,
)
from .table_search import bare_unit, find_table, is_units, is_value

HEAD = 65_536
"""How much of the file [B] is looked at to find its layout."""

SAMPLE = 500
"""How many of its lines are looked at for decimal commas and clock times."""

_LABELLED = re.compile(r"#\s*(columns|channels|fields|units)\s*[:=]\s*(.+)", re.IGNORECASE)

_MARKED = re.compile(r"^\s*(?:[%!;*>]+|//+)\s*(?=\w)")
"""What programs write before a line that holds no numbers, as others write #."""


@dataclass(frozen=True)
class Layout:
    """What the head of a text file says about the whole.

    table_line: of the header, from 1, or of the first numbers where there is no header; provenance: the lines above it
    plain: whether lines end as they usually do and units stand in the header alone, so that a parser by columns may be
    tried; spaced: whether its columns stand between spaces, which are read as tabs; counted: whether the first column
    holds no text, as far as was looked
    """

    encoding: str
    separator: str
    headers: tuple[Header, ...]
    lines_before_data: int
    style: NumberStyle
    bytes_per_row: float
    plain: bool
    notes: tuple[str, ...]
    table_line: int = 1
    provenance: tuple[str, ...] = ()
    spaced: bool = False
    counted: bool = False

    @cached_property
    def cell_units(self) -> Mapping[int, str]:
        """The units of the columns in which every number has its unit behind it."""
        return {index: header.cell_unit for index, header in enumerate(self.headers) if header.cell_unit}


def find_layout(path: Path, skip_rows: int | None = None) -> Layout:
    """The layout of a CSV or TSV file, from its first 64 KiB.

    The table is found below lines about the test, comments (#) and empty lines; `sep=;` is obeyed, a row of units below
    the names is understood. skip_rows: the number of lines above the table, where it is given instead
    Errors: RecordingError for a file that is not text, has one column, or no header.
    """
    with path.open("rb") as file:
        raw = file.read(HEAD)
    encoding, notes = find_encoding(path, raw, len(raw) < HEAD)
    lines = _whole_lines(path, raw, encoding)
    first, declared = _preamble(lines)
    if skip_rows is not None:
        first = skip_rows + _preamble(lines[skip_rows:])[0]
    refuse_serial_monitor(path, lines[first:])
    refuse_labels(path, lines[first:])
    spaced = 0 if declared else spaced_columns(lines[first:])
    if spaced:
        lines = [with_tabs(line, spaced) for line in lines]
        declared = TAB
        notes = (*notes, "columns read between spaces")
    within = units_in_cells(lines[first:], declared)
    cell_units: Mapping[int, str] = {}
    if within is not None:
        declared, cell_units = within
        lines = lines_without_units(lines, declared, cell_units)
        notes = (*notes, taken_from_cells(cell_units.values()))
    if first >= len(lines):
        raise RecordingError(_no_table(path, skip_rows))
    place = find_table(lines, first, declared) if skip_rows is None else None
    start = first if place is None else place.line
    separator = declared or (place.separator if place else find_separator(path, lines[start:]))
    refuse_split_numbers(path, lines[:start], lines[start:], separator)
    header, header_lines, body = _first_rows(path, lines, start, separator)
    names, in_table, said = _names(lines, start, header, separator)
    widest = max((len(row) for row in body[:SAMPLE]), default=0)
    if len(names) == widest - 1 and all(not row[-1].strip() for row in body if len(row) == widest):
        names = [*names, ""]  # rows of numbers that end with a separator
    headers = tuple(_header(cell, number) for number, cell in enumerate(names, 1))
    before = 0
    if in_table:
        headers, below, more = below_names(lines, start + header_lines, headers, separator)
        before, said = header_lines + below, (*said, *more)
    headers, above = above_names(lines[first:start], headers, separator)
    headers, dimension = over_time(lines[first:start], headers)
    said = (*said, *above, *dimension)
    if start > first:
        said = (*said, f"table found at row {start + 1}: the lines above it are kept as its provenance")
    headers, beside = units_beside(headers, body)
    said = (*said, *beside)
    headers = with_dates(with_cell_units(headers, cell_units), _clock_columns(body))
    usual_ends = header_lines == 1 and all(line.endswith("\n") for line in lines[: start + 1])
    return Layout(
        encoding=encoding,
        separator=separator,
        headers=headers,
        lines_before_data=start + before,
        style=style_of(cell for row in (header, *body) for cell in row),
        bytes_per_row=len(raw) / max(len(lines) - start, 1),
        plain=usual_ends and not (cell_units or beside),
        notes=(*notes, *said),
        table_line=start + 1,
        provenance=_provenance(lines[:start], separator, declared),
        spaced=spaced > 0,
        counted=column_counted(body),
    )


def _first_rows(
    path: Path, lines: Sequence[str], start: int, separator: str
) -> tuple[list[str], int, list[list[str]]]:
    """Return the first row of the table, how many lines it takes, and the rows below it, without comments."""
    rows = csv.reader(lines[start : start + SAMPLE], delimiter=separator)
    try:
        header = next(rows)
        header_lines = rows.line_num
        return header, header_lines, [row for row in rows if row and not is_comment(row[0])]
    except csv.Error as error:
        raise RecordingError(
            f"{path.name}, row {start + 1}: {error}; correct the quotes of the header"
        ) from None


def column_counted(body: Sequence[Sequence[str]]) -> bool:
    """Return whether the cells of the first column are numbers, times or blank, but for some rows about the table.

    Where it holds no number, texts beside rows full of numbers name the steps of a test: these rows are of the table.
    """
    rows = [row for row in body if sum(map(bool, map(str.strip, row))) > 1]
    filled = [row for row in rows if row[0].strip().lower() not in BLANK_WORDS]
    texts = [row for row in filled if not is_value(row[0])]
    used = [i for i in range(1, max(map(len, rows), default=0)) if any(map(str.strip, _cells(rows, i)))]
    if texts and len(texts) == len(filled) and all(is_value(c) for i in used for c in _cells(texts, i)):
        return False
    return bool(rows) and len(texts) <= max(BELOW_NAMES, 0.1 * len(rows))


def _cells(rows: Sequence[Sequence[str]], column: int) -> list[str]:
    """Return the cells of one column, blank in rows that are shorter."""
    return [row[column] if column < len(row) else "" for row in rows]


def _no_table(path: Path, skip_rows: int | None) -> str:
    if skip_rows:
        return f"{path.name}: has no table below its first {skip_rows} rows; give a smaller --skip-rows"
    return f"{path.name}: holds no header and no numbers; record again, or export the file anew"


def _names(
    lines: Sequence[str], start: int, header: Sequence[str], separator: str
) -> tuple[Sequence[str], bool, tuple[str, ...]]:
    """Return the names of the columns, whether they stand in the row `start` itself, and a note where they do not."""
    if not _all_numeric(header):
        return header, True, ()
    names = _commented_names(lines[:start], separator)
    if len(names) == len(header):
        return names, False, (f"column names taken from the comment in row {start}",)
    if labelled := _labelled_names(lines[:start], separator, len(header)):
        return labelled, False, ("column names taken from the comments above the numbers",)
    above = _words_above(lines[:start], separator)
    if len(above) > len(header):
        unheld = " and ".join(map(quoted, above[len(header) :]))
        return (
            above[: len(header)],
            False,
            (f"row {start} names {unheld} too, of which the rows hold nothing",),
        )
    if len(above) == len(header) and is_units(above):
        named = [f"column {n} [{bare_unit(unit)}]" for n, unit in enumerate(above, 1)]
        return named, False, (f"the row of units above the numbers, row {start}, names no columns",)
    if len(above) > 1:
        unnamed = (
            f"row {start} names {len(above)} columns and the rows hold {len(header)}: its names are not taken"
        )
        return [""] * len(header), False, (unnamed,)
    return [""] * len(header), False, ("the file has no header row: its columns are known by number only",)


def _clock_columns(body: Sequence[Sequence[str]]) -> frozenset[int]:
    """Return the columns that hold clock times: nine of ten of the cells that hold something, in the first rows."""
    found = []
    width = max((len(row) for row in body), default=0)
    for i in range(width):
        cells = [row[i] for row in body[:60] if i < len(row) and row[i].strip()]
        clocks = sum(map(is_clock, cells))
        if clocks > 1 and clocks >= 0.9 * (len(cells) - BELOW_NAMES):
            found.append(i)
    return frozenset(found)


def _provenance(lines: Sequence[str], separator: str, declared: str | None) -> tuple[str, ...]:
    """Return the lines above the table as texts: without # and without separators that end a line."""
    texts = []
    for line in lines:
        text = line.strip().lstrip("#").rstrip(separator + " ").strip()
        if text and not (declared and line.startswith("sep=")):
            texts.append(text.replace("\t", " "))
    return tuple(texts)


def _whole_lines(path: Path, raw: bytes, encoding: str) -> list[str]:
    text = codecs.getincrementaldecoder(encoding)(errors="replace").decode(raw)
    lines = list(io.StringIO(with_plain_marks(text), newline=""))
    if len(raw) < HEAD:
        return lines
    if len(lines) < 2:
        raise RecordingError(
            f"{path.name}: no line ends in its first 64 KiB; export it as CSV with one row per line"
        )
    return lines[:-1]


def _preamble(lines: Sequence[str]) -> tuple[int, str | None]:
    separator = None
    for number, line in enumerate(lines):
        declared = re.fullmatch(r"sep=([\t;,|])", line.strip("\r\n"))
        if declared:
            separator = declared[1]
        elif line.strip() and not is_comment(line):
            return number, separator
    return len(lines), separator


def _commented_names(preamble: Sequence[str], separator: str) -> list[str]:
    """The cells of a comment right above the numbers, where some programs put the header; of two, names and units."""
    comments = [line.strip().lstrip("# \t") for line in preamble[-2:] if is_comment(line)]
    if not comments or not is_comment(preamble[-1]):
        return []
    *above, cells = (next(csv.reader([text], delimiter=separator), []) for text in comments)
    if above and len(above[0]) == len(cells) and is_units(cells):
        return [f"{name.strip()} [{bare_unit(unit)}]" for name, unit in zip(above[0], cells, strict=True)]
    return cells


def _labelled_names(preamble: Sequence[str], separator: str, width: int) -> list[str]:
    """The names of so many columns, with their units, in comments that say so: `# columns: a b`, `# units: m N`."""
    told: dict[bool, list[str]] = {}
    for found in filter(None, (_LABELLED.match(line.strip()) for line in preamble)):
        cells = found[2].split(separator) if separator in found[2] else found[2].split()
        if len(cells) == width:
            told.setdefault(found[1].lower() == "units", [cell.strip() for cell in cells])
    names, units = told.get(False, []), told.get(True, [""] * width)
    return [f"{name} [{bare_unit(unit)}]" if unit else name for name, unit in zip(names, units, strict=False)]


def _words_above(preamble: Sequence[str], separator: str) -> list[str]:
    """The cells of the line right above the numbers, where each of them is a word; none else."""
    cells = next(csv.reader([preamble[-1].strip()], delimiter=separator), []) if preamble else []
    words = [cell.strip() for cell in cells]
    return words if all(words) and not any(map(is_value, words)) else []


def _all_numeric(cells: Sequence[str]) -> bool:
    """Whether a row holds numbers and no name; switches beside them are none."""
    values = [cell.strip() for cell in cells if cell.strip().lower() not in BLANK_WORDS | TRUTH_WORDS]
    return bool(values) and all(is_value(cell) for cell in values)


def _header(cell: str, number: int) -> Header:
    cell = _MARKED.sub("", cell) if number == 1 else cell
    name, unit = split_header(cell)
    return Header(name or f"#{number}", unit, " ".join(cell.split()) or f"#{number}")
