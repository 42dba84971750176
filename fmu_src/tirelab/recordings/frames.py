"""Arrays and data frames as tables, so that they are read like files. pandas is not imported: its objects are used."""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import ArrayLike, NDArray

from .channels import UNIT_OF, known_channel
from .formats.parquet import frame_headers, series_values
from .formats.table import Columns, Header, RecordingError, Wanted, numbers, of_one_length, sample_place
from .formats.text_column import headers_of_text
from .origin import Origin
from .units import QUANTITIES, measures, split_header

SI_UNITS: Mapping[str, str] = {"time": "s", "deflection": "m", "force": "N", "radius": "m"}
"""The units of arrays for which none is given."""


class ColumnTable:
    """Columns at hand: NumPy arrays, lists, and series of polars or pandas."""

    def __init__(
        self,
        origin: Origin,
        headers: Sequence[Header],
        columns: Sequence[Any],
        time_axis: int | None = None,
        notes: tuple[str, ...] = (),
    ) -> None:
        self.origin = origin
        self.headers = headers
        self.columns = columns
        self.time_axis = time_axis
        self.notes = notes

    def bytes_needed(self, columns: int) -> int:
        """The copies that are made of the columns."""
        return max((len(column) for column in self.columns), default=0) * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """Copies of the columns wanted.

        Errors: RecordingError for text, for more than one axis, and for unequal lengths.
        """
        headers = [self.headers[want.index] for want in wanted]
        values = []
        for want, header in zip(wanted, headers, strict=True):
            column = self.columns[want.index]
            if isinstance(column, pl.Series):
                read = series_values(self.origin, header, column, want.channel)
            else:
                read = numbers(self.origin, header, _array(column), want.channel)
            if read.ndim != 1:
                raise RecordingError(
                    f"{self.origin}, {header.text}: has the shape {read.shape}; give one value per sample"
                )
            # A copy: reading works in place, and the caller's numbers stay what they are.
            values.append(np.array(read, dtype=np.float64))
        of_one_length(self.origin, headers, values)
        return Columns(tuple(values), sample_place, self.notes)


def array_table(origin: Origin, arrays: Mapping[str, ArrayLike]) -> ColumnTable:
    """Return the table of arrays, each named like the channel that it is.

    Errors: RecordingError for what is one value, or gives its values one by one only, as a generator does.
    """
    for name, values in arrays.items():
        if np.ndim(values) == 0:
            raise RecordingError(
                f"{origin}, {name}: is {type(values).__name__}, not one value per sample; give an array or a list"
            )
    return ColumnTable(origin, [Header(name, None, name) for name in arrays], list(arrays.values()))


def array_units(origin: Origin, given: Mapping[str, str] | None, more: Iterable[str] = ()) -> dict[str, str]:
    """Return the unit of each array, as given or SI; the radius may be called surface_radius.

    more: names of the arrays beside those of SI_UNITS

    Errors: RecordingError for a channel that is not among the arrays.
    """
    named = {"radius" if name == "surface_radius" else name: unit for name, unit in (given or {}).items()}
    known = {**SI_UNITS, **{name: UNIT_OF[name] for name in more}}
    for name in named:
        known_channel(name, f"{origin}, units")
        if name not in known:
            raise RecordingError(f"{origin}, units: there is no array of {name}; leave its unit out")
    return {**known, **named}


def is_single(surface_radius: object) -> bool:
    """Whether a surface radius holds for all samples: a text or a number, not an array."""
    return isinstance(surface_radius, str) or np.ndim(surface_radius) == 0  # type: ignore[arg-type]


def single_radius(origin: Origin, surface_radius: object, unit: str) -> str | float:
    """Return a radius for all samples as `parse_radius` takes it: a text, or a number [m].

    Errors: RecordingError for None and what is neither.
    """
    if isinstance(surface_radius, str):
        return surface_radius
    if not isinstance(surface_radius, (Real, np.ndarray)):
        raise RecordingError(
            f"{origin}: the radius of the surface is not known; give {origin.radius('flat')}, another text "
            'such as "25.4 cm" or "-50.8 cm", a number in metres, or one value per sample'
        )
    length = float(surface_radius)
    return f"{length!r} {unit}" if np.isfinite(length) and unit != "m" else length


def frame_table(origin: Origin, frame: Any) -> ColumnTable:
    """Return the table of a data frame: of polars, of pandas or alike, or of what gives Arrow data.

    An index that has a name is a column; one of dates or durations without a name is the time.
    Errors: RecordingError for what is no data frame.
    """
    if isinstance(frame, pl.LazyFrame):
        frame = frame.collect()
    if hasattr(frame, "iloc") and hasattr(frame, "columns"):
        return _with_units(origin, _pandas_table(origin, frame))
    if hasattr(frame, "__arrow_c_stream__") and not isinstance(frame, (pl.DataFrame, pl.Series)):
        frame = pl.DataFrame(frame)
    if not isinstance(frame, pl.DataFrame):
        raise RecordingError(
            f"{origin}: {type(frame).__name__} is no data frame; give one of pandas or polars, an Arrow table, "
            "or arrays to Recording.from_arrays"
        )
    return _with_units(origin, ColumnTable(origin, frame_headers(frame.schema), frame.get_columns()))


def _with_units(origin: Origin, table: ColumnTable) -> ColumnTable:
    """Return a table with what its texts say of units and clock times, without a first row of units."""
    series = [column if isinstance(column, pl.Series) else None for column in table.columns]
    headers, above, notes = headers_of_text(table.headers, series)
    columns = [column[above:] for column in table.columns] if above else table.columns
    return ColumnTable(origin, headers, columns, table.time_axis, notes)


def _times(values: NDArray[Any], absent: NDArray[np.bool_]) -> NDArray[Any] | None:
    """Return objects that are dates, durations or times of day as NumPy has them; None where some are none of these."""
    present = values[~absent]
    if not present.size:
        return None
    for kind, dtype in ((datetime.datetime, "datetime64[us]"), (datetime.timedelta, "timedelta64[us]")):
        if all(isinstance(value, kind) for value in present):
            found = np.full(values.shape, "NaT", dtype=dtype)
            found[~absent] = present.astype(dtype)
            return found
    if all(isinstance(value, datetime.time) for value in present):
        midnight = datetime.datetime(2000, 1, 1)
        of_day = [datetime.datetime.combine(midnight, value.replace(tzinfo=None)) for value in present]
        found = np.full(values.shape, "NaT", dtype="timedelta64[us]")
        found[~absent] = np.array(of_day, dtype="datetime64[us]") - np.datetime64(midnight)
        return found
    return None


def _pandas_text(column: Any) -> Any:
    """Return a column of pandas that holds text as a series of polars, one of times as an array, any other as it is."""
    values = np.asarray(column.to_numpy(), dtype=object) if _may_hold_text(column) else None
    if values is None:
        return column
    absent = np.asarray(column.isna(), dtype=bool)
    times = _times(values, absent)
    if times is not None:
        return times
    if absent.all() or not all(isinstance(value, str) for value in values[~absent]):
        return column
    return pl.Series(
        [None if gone else value for value, gone in zip(values, absent, strict=True)], dtype=pl.String
    )


def _may_hold_text(column: Any) -> bool:
    return hasattr(column, "isna") and (
        getattr(column.dtype, "kind", "") == "O" or str(column.dtype) in ("str", "string")
    )


def _pandas_table(origin: Origin, frame: Any) -> ColumnTable:
    """Return the table of a pandas frame; columns are taken by position, as names may repeat."""
    columns = [_pandas_text(frame.iloc[:, number]) for number in range(len(frame.columns))]
    headers = [_pandas_header(text, column) for text, column in zip(frame.columns, columns, strict=True)]
    index = frame.index
    dated = getattr(index.dtype, "kind", "") in "Mm"
    if index.name is None and not dated:
        return ColumnTable(origin, headers, columns)
    # Series of an index have the same methods as those of a column.
    header = _pandas_header(index.name if index.name is not None else "time", index)
    time_axis = 0 if index.name is None else None
    return ColumnTable(origin, [header, *headers], [index, *columns], time_axis)


def _pandas_header(label: object, column: Any) -> Header:
    """Return the header of a column; a second level of the names may be its unit."""
    parts = [str(part).strip() for part in label] if isinstance(label, tuple) else [str(label)]
    if len(parts) == 2 and any(measures(parts[1], si) for si in QUANTITIES):
        parts = [f"{parts[0]} [{parts[1]}]"]
    text = " ".join(parts)
    name, unit = split_header(text)
    dated = getattr(column.dtype, "kind", "") in ("M", "m")
    return Header(name, "s" if dated else unit, text, dated)


def _array(column: Any) -> NDArray[Any]:
    """Return the values of an array, a list or a series of pandas as NumPy knows them; missing ones are NaN."""
    if isinstance(column, np.ma.MaskedArray):
        return np.ma.filled(column.astype(np.float64), np.nan)
    if getattr(getattr(column, "dtype", None), "kind", "") == "M" and hasattr(column, "to_numpy"):
        return np.asarray(column.to_numpy(dtype="datetime64[ns]"))
    values = np.asarray(column)
    if values.dtype.kind != "O":
        return values
    # Columns that lack a value come as objects: numbers, and None or pandas.NA.
    absent = column.isna() if hasattr(column, "isna") else [value is None for value in values]
    missing = np.asarray(absent, dtype=bool)
    present = values[~missing]
    if values.ndim == 1 and all(isinstance(v, (Real, Decimal)) and not isinstance(v, bool) for v in present):
        filled = np.full(values.shape, np.nan)
        filled[~missing] = present.astype(np.float64)
        return filled
    times = _times(values, missing) if values.ndim == 1 else None
    if times is not None:
        return times
    return values if not len(present) else present
