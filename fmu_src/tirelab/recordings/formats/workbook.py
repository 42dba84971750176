"""A workbook opened, and kept open for the next test in it."""

import io
import threading
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..memory import readable_size
from .libraries import load_library
from .table import RecordingError

MOST_KEPT = 64 * 2**20
"""A workbook of up to this size [B] is kept open for the next test in it."""

MOST_PACKED, PACKED_FROM = 100, 256 * 2**20
"""A workbook that unpacks to so many times its size is refused, from that content [B] on.

A cell of a measured number, with its markup, unpacks to 5 to 30 times its size; what says the same again and again, to
up to 1000 times.
"""

OTHERS = (".xls", ".xlsb", ".ods")
"""The workbooks that openpyxl cannot read, and calamine can."""


class OpenpyxlBook:
    """A workbook that openpyxl opened."""

    def __init__(self, book: Any) -> None:
        self.book = book
        self.titles = [sheet.title for sheet in book.worksheets]
        self.hidden = frozenset(sheet.title for sheet in book.worksheets if sheet.sheet_state != "visible")

    def rows(self, title: str) -> Iterator[Sequence[Any]]:
        """The rows of a sheet from the first on."""
        yield from self.book[title].iter_rows(values_only=True)

    def cells(self, title: str, row: int) -> Sequence[Any]:
        """The cells of one row of a sheet, counted from 1, with what is known of them."""
        return next(iter(self.book[title].iter_rows(min_row=row, max_row=row)), ())


class CalamineBook:
    """A workbook that calamine opened."""

    def __init__(self, book: Any) -> None:
        self.book = book
        self.titles = list(book.sheet_names)
        self.hidden = frozenset(
            sheet.name for sheet in book.sheets_metadata if not str(sheet.visible).endswith(".Visible")
        )

    def rows(self, title: str) -> Iterator[Sequence[Any]]:
        """The rows of a sheet from the first on."""
        yield from self.book.get_sheet_by_name(title).to_python(skip_empty_area=False)


@dataclass(frozen=True)
class Version:
    """A file as it is now, for one thread: what was read of it holds until it is written again."""

    path: Path
    written: int
    size: int
    thread: int

    @classmethod
    def of(cls, path: Path) -> "Version":
        """Return the file's version of this moment."""
        stat = path.stat()
        return cls(path.absolute(), stat.st_mtime_ns, stat.st_size, threading.get_ident())


def opened(version: Version) -> OpenpyxlBook | CalamineBook:
    """Return a workbook, opened once for all the tests in it unless it is too large to be kept."""
    return _kept(version) if version.size <= MOST_KEPT else _loaded(version.path)


@lru_cache(maxsize=1)
def _kept(version: Version) -> OpenpyxlBook | CalamineBook:
    return _loaded(version.path)


def never_worked_out(version: Version, title: str, row: int, column: int) -> str:
    """Return the name of a cell, C10, whose formula has no result; "" for any other. row: from 1; column: from 0

    Programs that write workbooks without being able to reckon leave results out. Of .xls, .xlsb and .ods it is not
    known.
    """
    book = opened(version)
    if isinstance(book, CalamineBook):
        return ""
    formulas = _loaded(version.path, results=False)
    assert isinstance(formulas, OpenpyxlBook)
    pairs = list(zip(book.cells(title, row), formulas.cells(title, row), strict=False))
    for result, formula in pairs[column : column + 1]:
        # the result of a formula that is an empty text has its type
        if formula.data_type == "f" and result.value is None and result.data_type == "n":
            return str(formula.coordinate)
    return ""


def _loaded(path: Path, results: bool = True) -> OpenpyxlBook | CalamineBook:
    """Return a workbook that does not hold its file open; results: of formulas, and not their text."""
    stream = io.BytesIO(path.read_bytes())
    _check_size(path, stream)
    if path.suffix.lower() in OTHERS:
        calamine = load_library(path, "python_calamine", "python-calamine")
        return CalamineBook(calamine.CalamineWorkbook.from_filelike(stream))
    openpyxl = load_library(path, "openpyxl", "openpyxl")
    return OpenpyxlBook(openpyxl.load_workbook(stream, read_only=True, data_only=results))


def _check_size(path: Path, stream: io.BytesIO) -> None:
    """Raise RecordingError for an archive that would fill the memory, before it is unpacked."""
    packed_in_zip = zipfile.is_zipfile(stream)
    stream.seek(0)
    if not packed_in_zip:  # .xls, or what the library refuses
        return
    with zipfile.ZipFile(stream) as members:
        content = sum(member.file_size for member in members.infolist())
    packed = stream.getbuffer().nbytes
    if content > PACKED_FROM and content > MOST_PACKED * packed:
        raise RecordingError(
            f"{path.name}: unpacks from {readable_size(packed)} to {readable_size(content)}, which no table of "
            "measured numbers does; do not use it, or export its sheet as CSV"
        )
    stream.seek(0)
