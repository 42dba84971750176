"""Files of measurements: one loader per format, each giving the same kind of table."""

import re
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from .delimited import DelimitedTable
from .excel import ExcelTable
from .hdf5 import Hdf5Table
from .json import JsonTable
from .matlab import matlab_table
from .mdf import MdfTable
from .parquet import ParquetTable
from .table import Columns, Header, RecordingError, Table, Wanted, listed, quoted
from .tdms import TdmsTable

__all__ = [
    "LOADERS",
    "TEXT_SUFFIXES",
    "WORKBOOK_SUFFIXES",
    "Columns",
    "Header",
    "RecordingError",
    "Table",
    "Wanted",
    "open_table",
]

LOADERS: dict[str, Callable[[Path], Table]] = {
    ".csv": DelimitedTable,
    ".tsv": DelimitedTable,
    ".txt": DelimitedTable,
    ".dat": DelimitedTable,
    ".asc": DelimitedTable,
    ".tra": DelimitedTable,
    ".lvm": DelimitedTable,
    ".log": DelimitedTable,
    ".prn": DelimitedTable,
    ".parquet": ParquetTable,
    ".pq": ParquetTable,
    ".json": JsonTable,
    ".jsonl": JsonTable,
    ".ndjson": JsonTable,
    ".mat": matlab_table,
    ".h5": Hdf5Table,
    ".hdf5": Hdf5Table,
    ".mf4": MdfTable,
    ".mdf": MdfTable,
    ".tdms": TdmsTable,
    ".xlsx": ExcelTable,
    ".xlsm": ExcelTable,
    ".xls": ExcelTable,
    ".xlsb": ExcelTable,
    ".ods": ExcelTable,
}
"""The file suffixes that can be read, in lower case."""

TEXT_SUFFIXES = tuple(suffix for suffix, loader in LOADERS.items() if loader is DelimitedTable)
"""Those of them that are text."""

WORKBOOK_SUFFIXES = tuple(suffix for suffix, loader in LOADERS.items() if loader is ExcelTable)
"""Those of them that are workbooks, of which a sheet can be named."""

SNIFFED = 4096
"""Bytes at the beginning of a file that tell what it is."""

_SIGNATURES = (
    (b"PAR1", "Parquet", ".parquet"),
    (b"MATLAB 5.0", "MATLAB", ".mat"),
    (b"MATLAB 7.3", "MATLAB", ".mat"),
    (b"MDF     ", "MDF", ".mf4"),
    (b"TDSm", "TDMS", ".tdms"),
    (b"\x89HDF", "HDF5", ".h5"),
    (b"PK\x03\x04", "a zip archive or Excel", ".xlsx"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook", ".xls"),
    (b"\x1f\x8b", "gzip", ""),
    (b"BZh", "bzip2", ""),
    (b"\xfd7zXZ", "xz", ""),
    (b"\x28\xb5\x2f\xfd", "Zstandard", ""),
    (b"|CF,", "imc Famos", "export"),
    (b"%PDF", "PDF", "export"),
    (b"\x89PNG", "a picture (PNG)", "export"),
    (b"\xff\xd8\xff", "a picture (JPEG)", "export"),
    (b"{\\rtf", "rich text (RTF)", "export"),
    (b"<html", "HTML", "save"),
    (b"<!doctype html", "HTML", "save"),
    (b"<table", "HTML", "save"),
    (b"<?xml", "XML", "save"),
)
"""First bytes of files that are no text: what they are, and the suffix under which they are read, where they are."""

_OF_WORKBOOKS = ("[Content_Types].xml", "xl/", "mimetype", "content.xml")
"""Members of the archive that a workbook is: .xlsx and .ods."""

_CONTROL = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")


def open_table(path: Path, skip_rows: int | None = None, sheet: str = "") -> Table:
    """The table in a file, its loader chosen by the suffix; where that is not known, by what the file holds.

    skip_rows: rows above the table of a text file; None: it is found
    sheet: of a workbook, "" where that with the recording is to be found
    Errors: RecordingError when there is no such file, it is empty, its suffix is not known and it holds no table of
    text, its content is of another kind than its suffix says, or the library for it is not installed.
    """
    try:
        with path.open("rb") as file:
            start = file.read(SNIFFED)
    except FileNotFoundError:
        raise RecordingError(f"{path}: there is no such file; check the path") from None
    except IsADirectoryError:
        raise RecordingError(f"{path} is a folder; name a file of measurements in it") from None
    except OSError as error:
        raise RecordingError(f"{path}: cannot be opened ({error.strerror}); check its permissions") from None
    if not start:
        raise RecordingError(f"{path.name} is empty (0 bytes); record again, or export the file anew")
    suffix = path.suffix.lower()
    kind, read_as = _kind(path, start)
    if kind and suffix in (*TEXT_SUFFIXES, *(WORKBOOK_SUFFIXES if read_as in ("", "save") else ())):
        what = "is no text table but" if suffix in TEXT_SUFFIXES else "cannot be read as a workbook: it is"
        raise RecordingError(f"{path.name} {what} {kind}; {_advice(read_as)}")
    known = suffix in LOADERS
    if not known and read_as in LOADERS:
        suffix = read_as
    if suffix in WORKBOOK_SUFFIXES and not kind:
        # Many instruments write a table of text for a spreadsheet to open.
        with suppress(RecordingError):
            return DelimitedTable(path, skip_rows)
    if suffix not in LOADERS:
        if kind or _CONTROL.search(start):
            raise _unknown(path, f"is {kind}; {_advice(read_as)}" if kind else "")
        suffix = ".txt"
    if skip_rows is not None and suffix not in TEXT_SUFFIXES:
        raise RecordingError(f"{path.name}: rows can be skipped in text files alone; leave out --skip-rows")
    if suffix in WORKBOOK_SUFFIXES:
        return ExcelTable(path, sheet)
    if suffix not in TEXT_SUFFIXES:
        return LOADERS[suffix](path)
    try:
        return DelimitedTable(path, skip_rows)
    except RecordingError as error:
        if known:
            raise
        raise _unknown(
            path, f"no table is found in its text ({str(error).removeprefix(path.name + ': ')})"
        ) from None


def _kind(path: Path, start: bytes) -> tuple[str, str]:
    """Return what a file that begins so is, if it is no text, and the suffix under which it is read, if it is."""
    begins = start.removeprefix(b"\xef\xbb\xbf").lstrip()[:20].lower()
    found = (
        (kind, end) for mark, kind, end in _SIGNATURES if start.startswith(mark) or begins.startswith(mark)
    )
    kind, read_as = next(found, ("", ""))
    if read_as == ".xlsx":
        with suppress(OSError, zipfile.BadZipFile), zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            if not any(name.startswith(_OF_WORKBOOKS) for name in names):
                return f"a zip archive of {listed(list(map(quoted, names)), most=3)}", ""
    return kind, read_as


def _advice(read_as: str) -> str:
    if read_as in LOADERS:
        return f"rename it to end in {read_as}"
    if read_as == "save":
        return "open it in a spreadsheet program and save it as .xlsx or CSV"
    return "export it as text" if read_as else "unpack it"


def _unknown(path: Path, what: str) -> RecordingError:
    if what:
        return RecordingError(f"{path.name}: {what}")
    return RecordingError(
        f"{path.name}: recordings ending in {quoted(path.suffix.lower())} cannot be read; "
        f"export it as one of {', '.join(LOADERS)}"
    )
