"""Parquet files, read with polars; units stand in the column names, as in a CSV header."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import polars as pl

from ..origin import Origin
from ..units import split_header
from .libraries import reading_with
from .table import Columns, FloatArray, Header, RecordingError, Wanted, numbers, quoted, sample_place
from .text_column import LOOKED_AT, TextFault, headers_of_text, numbers_of_text


class ParquetTable:
    """A Parquet file; nulls are blanks."""

    time_axis: int | None = None

    def __init__(self, path: Path) -> None:
        self.path = path
        with reading_with(path, "Parquet"):
            self.schema = pl.read_parquet_schema(path)
            self.rows = int(pl.scan_parquet(path).select(pl.len()).collect().item())
            texts = pl.String in self.schema.values()
            head = pl.read_parquet(path, n_rows=LOOKED_AT) if texts else pl.DataFrame(schema=self.schema)
        named = frame_headers(self.schema)
        self.headers: Sequence[Header]
        self.headers, self.above, self.notes = headers_of_text(named, head.get_columns())

    def bytes_needed(self, columns: int) -> int:
        """The columns as stored and as float64."""
        return self.rows * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The columns wanted, and no others, from the file."""
        headers = self.headers
        values: list[FloatArray] = []
        for want in wanted:
            header = headers[want.index]
            with reading_with(self.path, "Parquet"):
                series = pl.read_parquet(self.path, columns=[header.text]).to_series()[self.above :]
                values.append(series_values(Origin(self.path.name), header, series, want.channel))
        return Columns(tuple(values), sample_place, self.notes)


def frame_headers(schema: Mapping[str, pl.DataType]) -> tuple[Header, ...]:
    """The columns of a frame; a column of dates is counted in seconds."""
    made = []
    for text, kind in schema.items():
        name, unit = split_header(text)
        dated = kind.is_temporal()
        made.append(Header(name, "s" if dated else unit, text, dated))
    return tuple(made)


def series_values(origin: Origin, header: Header, series: pl.Series, channel: str) -> FloatArray:
    """A column of a frame as float64, nulls as NaN; text that holds numbers is read, lists are refused."""
    if series.dtype.is_nested():
        raise RecordingError(
            f"{origin}, column {header.text!r}: holds lists, not numbers; "
            f"name another column with {origin.columns(**{channel: 'NAME'})}"
        )
    if series.dtype == pl.String:
        try:
            read = numbers_of_text(series, channel, header.cell_unit)
        except TextFault as fault:
            place = f"{sample_place(fault.index)}, column {quoted(header.text)}"
            kind = f"{fault.kind} in {header.cell_unit}" if header.cell_unit else fault.kind
            raise RecordingError(
                f"{origin}, {place}: {quoted(series[fault.index])} is not a {kind} like the others; correct it, or "
                "delete the row"
            ) from None
        if read is not None:
            return read
    if series.dtype.is_numeric():
        series = series.cast(pl.Float64).fill_null(float("nan"))
    return numbers(origin, header, series.to_numpy(), channel)
