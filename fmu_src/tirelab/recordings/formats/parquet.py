"""Parquet files, read with polars; units stand in the column names, as in a CSV header."""

from collections.abc import Sequence
from pathlib import Path

import polars as pl

from ..units import split_header
from .libraries import told_by
from .table import Columns, FloatArray, Header, RecordingError, Wanted, numbers, sample_place


class ParquetTable:
    """A Parquet file; nulls are blanks."""

    time_axis: int | None = None

    def __init__(self, path: Path) -> None:
        self.path = path
        with told_by(path, "Parquet"):
            self.schema = pl.read_parquet_schema(path)
            self.rows = int(pl.scan_parquet(path).select(pl.len()).collect().item())

    @property
    def headers(self) -> Sequence[Header]:
        """The columns in the order of the file; a column of dates is counted in seconds."""
        made = []
        for text, kind in self.schema.items():
            name, unit = split_header(text)
            made.append(Header(name, "s" if kind.is_temporal() else unit, text))
        return made

    def bytes_needed(self, columns: int) -> int:
        """The columns as stored and as float64."""
        return self.rows * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The columns wanted, and no others, from the file."""
        headers = self.headers
        values: list[FloatArray] = []
        for want in wanted:
            header = headers[want.index]
            with told_by(self.path, "Parquet"):
                series = pl.read_parquet(self.path, columns=[header.text]).to_series()
                if series.dtype.is_numeric():
                    series = series.cast(pl.Float64).fill_null(float("nan"))
                elif series.dtype.is_nested():
                    raise RecordingError(
                        f"{self.path.name}, column {header.text!r}: holds lists, not numbers; "
                        f"name another column with --columns {want.channel}=NAME"
                    )
                values.append(numbers(self.path, header, series.to_numpy(), want.channel))
        return Columns(values, sample_place)
