"""How a text file is laid out: its encoding, its separator, its header and where its numbers start."""

import codecs
import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..units import QUANTITIES, measures, split_header
from .table import BLANK_WORDS, Header, RecordingError, is_comment, quoted

HEAD = 65_536
"""How much of the file [B] is looked at to find its layout."""

SAMPLE = 500
"""How many of its lines are looked at for decimal commas."""

_SEPARATORS = "\t;,"
_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*", re.ASCII)
MAYBE_THOUSANDS = re.compile(r"\s*[+-]?[1-9]\d{0,2},\d{3}\s*", re.ASCII)


@dataclass(frozen=True)
class Layout:
    """What the head of a text file says about the whole."""

    encoding: str
    separator: str
    headers: tuple[Header, ...]
    lines_before_data: int
    decimal_comma: bool
    bytes_per_row: float
    plain: bool
    """Whether lines end as they usually do, so that a parser by columns may be tried."""
    notes: tuple[str, ...]


def find_layout(path: Path) -> Layout:
    """The layout of a CSV or TSV file, from its first 64 KiB.

    Comment lines (#) and empty lines before the header are passed over, `sep=;` is obeyed, a second row of
    units is understood. Errors: RecordingError for a file that is not text, has one column, or no header.
    """
    with path.open("rb") as file:
        raw = file.read(HEAD)
    encoding, notes = _encoding(path, raw)
    lines = _whole_lines(path, raw, encoding)
    start, separator = _preamble(lines)
    if start == len(lines):
        raise RecordingError(
            f"{path.name}: holds no header and no numbers; record again, or export the file anew"
        )
    separator = separator or _separator(path, lines[start:])
    rows = csv.reader(lines[start : start + SAMPLE], delimiter=separator)
    try:
        header = next(rows)
        data_line = rows.line_num
        body = [row for row in rows if row and not is_comment(row[0])]
    except csv.Error as error:
        raise RecordingError(
            f"{path.name}, row {start + 1}: {error}; correct the quotes of the header"
        ) from None
    plain = data_line == 1 and all(line.endswith("\n") for line in lines[: start + 1])
    bytes_per_row = len(raw) / max(len(lines) - start, 1)
    cells = [cell for row in (header, *body) for cell in row]
    decimal_comma = separator != "," and any(map(_is_decimal_comma, cells))
    if _is_numeric(header):
        names = _commented_names(lines[:start], separator)
        if len(names) == len(header):
            notes = (*notes, f"column names taken from the comment in row {start}")
        else:
            names = [""] * len(header)
            notes = (*notes, "the file has no header row: its columns are known by number only")
        headers = tuple(_header(cell, number) for number, cell in enumerate(names, 1))
        return Layout(encoding, separator, headers, start, decimal_comma, bytes_per_row, plain, notes)
    headers = tuple(_header(cell, number) for number, cell in enumerate(header, 1))
    if body and _is_units(body[0], len(header)):
        headers = tuple(_with_unit(h, cell) for h, cell in zip(headers, body[0], strict=True))
        notes = (*notes, f"units taken from row {start + data_line + 1}, below the names")
        data_line += 1
    return Layout(encoding, separator, headers, start + data_line, decimal_comma, bytes_per_row, plain, notes)


def _encoding(path: Path, raw: bytes) -> tuple[str, tuple[str, ...]]:
    for mark, name in _BYTE_ORDER_MARKS:
        if raw.startswith(mark):
            return name, ()
    if b"\x00" in raw:
        for name, empty, filled in (("utf-16-le", raw[1::2], raw[::2]), ("utf-16-be", raw[::2], raw[1::2])):
            if empty.count(0) > 0.9 * len(empty) and b"\x00" not in filled:
                return name, ("read as UTF-16 without a byte order mark",)
        raise RecordingError(
            f"{path.name}: is not text (it holds zero bytes); export it as CSV, Parquet, .mat, MDF4 or TDMS"
        )
    try:
        codecs.getincrementaldecoder("utf-8")().decode(raw, final=len(raw) < HEAD)
    except UnicodeDecodeError as error:
        byte = raw[error.start]
        return "latin-1", (f"not UTF-8 (byte 0x{byte:02x} at {error.start}): read as Latin-1",)
    return "utf-8", ()


def _whole_lines(path: Path, raw: bytes, encoding: str) -> list[str]:
    text = codecs.getincrementaldecoder(encoding)(errors="replace").decode(raw)
    lines = list(io.StringIO(text, newline=""))
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
        declared = re.fullmatch(r"sep=([\t;,])", line.strip("\r\n"))
        if declared:
            separator = declared[1]
        elif line.strip() and not is_comment(line):
            return number, separator
    return len(lines), separator


def _separator(path: Path, lines: Sequence[str]) -> str:
    sample = [line for line in lines[:50] if line.strip()]
    likely: list[tuple[bool, int, str]] = []
    for candidate in _SEPARATORS:
        try:
            fields = [len(row) for row in csv.reader(sample, delimiter=candidate)]
        except csv.Error:
            continue
        if fields[0] > 1:
            agreeing = sum(count == fields[0] for count in fields[1:])
            likely.append((2 * agreeing >= len(fields) - 1, fields[0], candidate))
    if not likely:
        spaced = len(sample[0].split()) > 1
        seen = (
            "its columns seem to stand between spaces"
            if spaced
            else f"its first line is {quoted(sample[0].strip())}"
        )
        raise RecordingError(
            f"{path.name}: no comma, semicolon or tab separates columns ({seen}); export it as CSV"
        )
    # A separator that the rows confirm comes first; then tab before semicolon before comma.
    return next((mark for agreed, _, mark in likely if agreed), max(likely, key=lambda found: found[1])[2])


def _commented_names(preamble: Sequence[str], separator: str) -> list[str]:
    """The cells of a comment right above the numbers, where some programs put the header."""
    if not preamble or not is_comment(preamble[-1]):
        return []
    text = preamble[-1].strip().lstrip("# ")
    return next(csv.reader([text], delimiter=separator), [])


def _is_numeric(cells: Sequence[str]) -> bool:
    values = [cell.strip() for cell in cells if cell.strip().lower() not in BLANK_WORDS]
    return bool(values) and all(_reads_as_number(cell) for cell in values)


def _reads_as_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


def _is_decimal_comma(cell: str) -> bool:
    return bool(DECIMAL_COMMA.fullmatch(cell)) and not MAYBE_THOUSANDS.fullmatch(cell)


def _is_units(cells: Sequence[str], columns: int) -> bool:
    units = [unit for unit in map(_bare_unit, cells) if unit]
    if len(cells) != columns or not units or any(_reads_as_number(cell) for cell in cells):
        return False
    return all(any(measures(unit, si) for si in QUANTITIES) for unit in units)


def _bare_unit(cell: str) -> str:
    text = cell.strip()
    bare = text[1:-1].strip() if text[:1] + text[-1:] in ("[]", "()") else text
    return bare.strip("-")


def _header(cell: str, number: int) -> Header:
    name, unit = split_header(cell)
    return Header(name or f"#{number}", unit, " ".join(cell.split()) or f"#{number}")


def _with_unit(header: Header, cell: str) -> Header:
    return Header(header.name, header.unit or _bare_unit(cell) or None, header.text)
