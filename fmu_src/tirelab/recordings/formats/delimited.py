"""Text tables (CSV, TSV): by columns with polars when they are clean, row by row when they are not."""

import io
import re
import warnings
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .careful import LONGEST_LINE, RowReader, Rows
from .clock import ClockError
from .cut_short import cut_cell
from .encoding import BY_BYTES, LOCAL
from .layout import Layout, find_layout
from .number_style import BYTE_ORDER_MARK, EXPONENTS, FORMULA, NumberStyle, with_plain_marks
from .spaced import block_with_tabs
from .table import Columns, FloatArray, Header, RecordingError, Wanted, listed, quoted
from .text_rows import AnotherTable

BLOCK = 2 * 2**20
"""How much of a file [B] is parsed at once: enough to keep every core busy, little beside the recording."""

MINUS = "\N{MINUS SIGN}".encode()
"""The minus of typography, which some programs write before numbers."""


ZEROS = re.compile(rb"^\x00+(?=\r?$)", re.MULTILINE)
"""A line of zero bytes, as a card leaves them whose power was lost."""


class DelimitedTable:
    """A CSV or TSV file whose layout is known."""

    time_axis: int | None = None

    def __init__(self, path: Path, skip_rows: int | None = None) -> None:
        self.path = path
        self.layout = find_layout(path, skip_rows)
        self.provenance = self.layout.provenance
        self.rows: tuple[int, int] | None = None

    @property
    def headers(self) -> Sequence[Header]:
        """The columns in the order of the file."""
        return self.layout.headers

    def bytes_needed(self, columns: int) -> int:
        """Twice the columns (1.5 times were seen with 80 million rows), and the blocks being parsed."""
        rows = self.path.stat().st_size / self.layout.bytes_per_row
        return int(rows * columns * 8 * 2) + 32 * BLOCK

    def read_rows(self, wanted: Sequence[Wanted], first: int, last: int) -> Columns:
        """The columns wanted of these rows of the file alone, whatever the others hold."""
        RowReader(self.path, self.layout, wanted).refuse_other_table(first, last)
        self.rows = (first, last)
        try:
            return self.read(wanted)
        finally:
            self.rows = None

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The columns wanted, block by block: by columns where that works, row by row where it does not."""
        try:
            pieces, reader = self._pieces(wanted)
        except AnotherTable as other:
            again = RowReader(self.path, self.layout, wanted).header_after(other.told[1])
            raise AnotherTable(*other.told, again) from None
        notes = [*self.layout.notes, *(note for clock in reader.clocks.values() for note in clock.notes)]
        if reader.cells.decimal_mark() == ",":
            notes.append("commas read as decimal commas")
        if self.layout.style.thousands:
            notes.append(f"{self.layout.style.thousands!r} read as the mark between thousands")
        if reader.comments:
            lines = listed([str(line) for line in reader.comments])
            notes.append(f"comment lines (#) skipped: row {lines}")
        notes += reader.text_rows.notes()
        values = pieces.joined()
        cut = None if self.rows else cut_cell(self.path, self.layout)
        if cut is not None and cut[0] in {want.index for want in wanted} and len(values[0]):
            notes.append(
                f"{pieces.place(len(values[0]) - 1)} left out: the file ends in it, and {quoted(cut[1])} has fewer "
                "digits than its column has elsewhere"
            )
            values = [column[:-1] for column in values]
        return Columns(tuple(values), pieces.place, tuple(notes))

    def _pieces(self, wanted: Sequence[Wanted]) -> tuple["_Pieces", RowReader]:
        """The columns wanted in pieces, and their reader, which knows what was said of them."""
        pieces, reader = _Pieces(len(wanted)), RowReader(self.path, self.layout, wanted)
        if not self.rows and self.layout.plain and _read_blocks(pieces, reader):
            return pieces, reader
        # The head of the file need not hold a number beyond 1,000: its mark may show in any row.
        style = reader.later_style()
        if style is not None:
            self.layout = replace(self.layout, style=style)
            return self._pieces(wanted)
        # What cannot be cut into blocks, or is wrong, is judged by one reading from the first row.
        pieces, reader = _Pieces(len(wanted)), RowReader(self.path, self.layout, wanted)
        pieces.add_rows(reader.read_file(self.rows))
        return pieces, reader


class _Pieces:
    """Columns in pieces, and the lines they came from."""

    def __init__(self, columns: int) -> None:
        self.columns: list[list[FloatArray]] = [[] for _ in range(columns)]
        self.starts: list[int] = []
        self.lines: list[NDArray[np.int64] | int] = []
        self.samples = 0

    def add_rows(self, rows: Rows) -> None:
        """Rows that each know their line."""
        for column, values in zip(self.columns, rows.values, strict=True):
            column.append(values)
        self._count(len(rows.lines), rows.lines)

    def add_frame(self, frame: pl.DataFrame, reader: RowReader, first_line: int) -> None:
        """Rows that follow line by line: views of what polars parsed, copied once when all are there."""
        # all clock times are read before anything is kept, since one that is none ends the reading by columns
        clocks = {i: clock.seconds(frame[_named(i)]) for i, clock in reader.clocks.items()}
        for column, want in zip(self.columns, reader.wanted, strict=True):
            if want.index in clocks:
                column.append(clocks[want.index])
            else:
                column.extend(chunk.to_numpy() for chunk in frame[_named(want.index)].get_chunks())
        self._count(frame.height, first_line)

    def _count(self, samples: int, lines: NDArray[np.int64] | int) -> None:
        self.starts.append(self.samples)
        self.lines.append(lines)
        self.samples += samples

    def place(self, index: int) -> str:
        """The row of the file, its first line being 1, where a sample stands."""
        piece = bisect_right(self.starts, index) - 1
        lines, within = self.lines[piece], index - self.starts[piece]
        return f"row {lines + within if isinstance(lines, int) else lines[within]}"

    def joined(self) -> list[FloatArray]:
        """The columns whole; the pieces are given up one column at a time."""
        whole = []
        for column in self.columns:
            whole.append(np.concatenate([*column, np.empty(0)]))
            column.clear()
        return whole


def _read_blocks(pieces: _Pieces, reader: RowReader) -> bool:
    """Read a file in blocks; False where only a reading from the first row to the last can judge it."""
    path, layout = reader.path, reader.layout
    line = layout.lines_before_data + 1
    codec = layout.encoding if layout.encoding in ("latin-1", *LOCAL) else "utf-8"
    wanted = [want.index for want in reader.wanted]
    if reader.guarded:
        wanted.append(0)
    try:
        for block in _blocks(path, layout):
            if reader.text_rows.open:
                reader.fault_from = 0
                return False
            if codec == "utf-8":
                block = block.replace(MINUS, b"-").replace(BYTE_ORDER_MARK.encode(), b"")
            if b"\0" in block:
                block = ZEROS.sub(b"", block)
            if any(mark.encode() in block for mark in (*EXPONENTS, FORMULA)):
                block = with_plain_marks(block.decode(codec, "surrogateescape")).encode(
                    codec, "surrogateescape"
                )
            quotes = block.count(b'"') if b'"' in block else 0
            if quotes % 2:
                return False
            frame = _parsed(block, layout, wanted)
            if frame is not None and frame.height == block.count(b"\n") + (block[-1:] != b"\n"):
                pieces.add_frame(frame, reader, line)
                line += frame.height
                comma = layout.style.decimal_comma
                if comma or b"." in block:
                    reader.cells.hold_to("," if comma else ".", line)
            else:
                reader.fault_from = line
                text = io.StringIO(block.decode(codec, "surrogateescape"), newline="")
                rows = reader.read(text, line)
                pieces.add_rows(rows)
                line = rows.next_line
    except (RecordingError, UnicodeError, ClockError):
        return False
    return True


def _named(index: int) -> str:
    return f"column_{index}"


def _parsed(block: bytes, layout: Layout, wanted: Sequence[int]) -> pl.DataFrame | None:
    """The columns of a block, or None where it holds anything but rows of numbers and clock times."""
    comma, thousands = layout.style.decimal_comma, layout.style.thousands
    clocks = {i for i in wanted if layout.headers[i].dated}
    as_text = bool(thousands) or (comma and bool(clocks))
    # A comment may pass for a row, a point for a decimal comma; polars 1 skips empty lines at the start.
    if b"#" in block or block[:1] in b"\r\n" or (comma and not as_text and b"." in block):
        return None
    numbers = pl.String if as_text else pl.Float64
    kinds = {i: pl.String if i in clocks else numbers for i in range(len(layout.headers))}
    try:
        with warnings.catch_warnings():
            # polars prints what is raised in its threads; rows that it lost are counted by who called
            warnings.simplefilter("ignore")
            frame = pl.read_csv(
                block if layout.encoding not in LOCAL else block.decode(layout.encoding).encode(),
                has_header=False,
                schema={_named(i): kind for i, kind in kinds.items()},
                columns=[_named(i) for i in wanted],
                separator=layout.separator,
                decimal_comma=comma,
                ignore_errors=True,
            )
            if as_text:
                frame = frame.with_columns(
                    _ungrouped(pl.col(_named(i)), layout.style).alias(_named(i))
                    for i in wanted
                    if i not in clocks
                )
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException):
        return None
    return None if any(frame[_named(i)].null_count() for i in wanted) else frame


def _ungrouped(text: pl.Expr, style: NumberStyle) -> pl.Expr:
    """Numbers from texts with marks between thousands; null where a text is no number or has the other mark."""
    bare_text = text
    if style.thousands:
        bare = pl.when(text.str.contains(style.pattern))
        bare_text = bare.then(text.str.replace_all(style.thousands, "", literal=True)).otherwise(text)
    if not style.decimal_comma:
        return bare_text.cast(pl.Float64, strict=False)
    plain = pl.when(bare_text.str.contains(".", literal=True)).then(None).otherwise(bare_text)
    return plain.str.replace(",", ".", literal=True).cast(pl.Float64, strict=False)


def _blocks(path: Path, layout: Layout) -> Iterator[bytes]:
    """The rows of the file as UTF-8, in blocks that end with a line; the last without its line end."""
    blocks = _byte_blocks if layout.encoding in BY_BYTES else _decoded_blocks
    previous = b""
    for block in blocks(path, layout):
        if layout.spaced:
            block = block_with_tabs(block, len(layout.headers))
        if previous:
            yield previous
        previous = block
    if previous := previous.rstrip(b"\r\n"):
        yield previous


def _byte_blocks(path: Path, layout: Layout) -> Iterator[bytes]:
    with path.open("rb") as file:
        for _ in range(layout.lines_before_data):
            file.readline()
        start = file.tell()
    with path.open("rb", buffering=0) as file:
        file.seek(start)
        # Going back to the last line's start is cheaper than joining its halves: 3 ms against 20 for 28 MB.
        while piece := file.read(BLOCK):
            whole = piece.rfind(b"\n") + 1
            if not whole and len(piece) > LONGEST_LINE:
                raise UnicodeError("a line without end")
            start += whole or len(piece)
            yield piece[:whole] if whole else piece
            file.seek(start)


def _decoded_blocks(path: Path, layout: Layout) -> Iterator[bytes]:
    with path.open(encoding=layout.encoding, newline="") as file:
        for _ in range(layout.lines_before_data):
            file.readline()
        while characters := file.read(BLOCK):
            yield (characters + file.readline(LONGEST_LINE)).encode()
