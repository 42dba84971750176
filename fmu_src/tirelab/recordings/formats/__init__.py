"""Files of measurements: one loader per format, each giving the same kind of table."""

from collections.abc import Callable
from pathlib import Path

from .delimited import DelimitedTable
from .excel import ExcelTable
from .matlab import MatlabTable
from .mdf import MdfTable
from .parquet import ParquetTable
from .table import Columns, Header, RecordingError, Table, Wanted, quoted
from .tdms import TdmsTable

__all__ = ["LOADERS", "TEXT_SUFFIXES", "Columns", "Header", "RecordingError", "Table", "Wanted", "open_table"]

LOADERS: dict[str, Callable[[Path], Table]] = {
    ".csv": DelimitedTable,
    ".tsv": DelimitedTable,
    ".txt": DelimitedTable,
    ".dat": DelimitedTable,
    ".asc": DelimitedTable,
    ".parquet": ParquetTable,
    ".pq": ParquetTable,
    ".mat": MatlabTable,
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

_SIGNATURES = (
    (b"PAR1", "Parquet", "rename it to .parquet"),
    (b"MATLAB 5.0", "MATLAB", "rename it to .mat"),
    (b"MDF     ", "MDF", "rename it to .mf4"),
    (b"TDSm", "TDMS", "rename it to .tdms"),
    (b"\x89HDF", "HDF5", "export it as CSV"),
    (b"PK\x03\x04", "a zip archive or Excel", "unpack it, or rename it to .xlsx"),
    (b"\x1f\x8b", "gzip", "unpack it"),
    (b"BZh", "bzip2", "unpack it"),
    (b"\xfd7zXZ", "xz", "unpack it"),
    (b"\x28\xb5\x2f\xfd", "Zstandard", "unpack it"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook", "rename it to .xls"),
)


def open_table(path: Path, skip_rows: int | None = None) -> Table:
    """The table in a file, its loader chosen by the suffix.

    skip_rows: rows above the table of a text file; None: it is found
    Errors: RecordingError when there is no such file, it is empty, its suffix is not known, its content is of
    another kind than its suffix says, or the library for it is not installed.
    """
    try:
        with path.open("rb") as file:
            start = file.read(16)
    except FileNotFoundError:
        raise RecordingError(f"{path}: there is no such file; check the path") from None
    except IsADirectoryError:
        raise RecordingError(f"{path}: is a folder; name a file of measurements in it") from None
    except OSError as error:
        raise RecordingError(f"{path}: cannot be opened ({error.strerror}); check its permissions") from None
    if not start:
        raise RecordingError(f"{path.name}: is empty (0 bytes); record again, or export the file anew")
    suffix = path.suffix.lower()
    if suffix in TEXT_SUFFIXES:
        for signature, kind, advice in _SIGNATURES:
            if start.startswith(signature):
                raise RecordingError(f"{path.name}: is no text table but {kind}; {advice}")
    if suffix not in LOADERS:
        raise RecordingError(
            f"{path.name}: recordings ending in {quoted(suffix)} cannot be read; "
            f"export it as one of {', '.join(LOADERS)}"
        )
    if skip_rows is None:
        return LOADERS[suffix](path)
    if suffix not in TEXT_SUFFIXES:
        raise RecordingError(f"{path.name}: rows can be skipped in text files alone; leave out --skip-rows")
    return DelimitedTable(path, skip_rows)
