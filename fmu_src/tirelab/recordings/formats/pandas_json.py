"""Data frames as pandas writes them with their names apart: `to_json(orient="split")` and `to_json(orient="table")`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import polars as pl

DURATION = (
    r"^(?P<sign>-?)P(?:(?P<days>\d+)D)?T?(?:(?P<hours>\d+)H)?(?:(?P<minutes>\d+)M)?(?:(?P<seconds>[\d.]+)S)?$"
)
"""A duration of ISO 8601, in which weeks, months and years are not used."""


def frame_of_pandas(held: Any) -> pl.DataFrame | None:
    """Return the frame that a JSON document holds in one of the two forms, None for any other document."""
    if not isinstance(held, Mapping):
        return None
    columns, index, data = (held.get(key) for key in ("columns", "index", "data"))
    if isinstance(columns, list) and isinstance(data, list) and _are_rows(data, len(columns)):
        names = [_name(column) for column in columns]
        rows = [list(row) for row in data]
        if isinstance(index, list) and len(index) == len(rows) and index != list(range(len(rows))):
            names, rows = ["index value", *names], [[at, *row] for at, row in zip(index, rows, strict=True)]
        return _framed(names, rows)
    schema = held.get("schema")
    fields = schema.get("fields") if isinstance(schema, Mapping) else None
    if not isinstance(fields, list) or not isinstance(data, list) or not data:
        return None
    if not all(isinstance(row, Mapping) for row in data):
        return None
    kinds = {str(field.get("name")): str(field.get("type")) for field in fields if isinstance(field, Mapping)}
    counted = [row.get("index") for row in data] == list(range(len(data)))
    names = [name for name in kinds if not (name == "index" and counted)]
    frame = _framed(names, [[row.get(name) for name in names] for row in data])
    return frame.with_columns(
        _duration(name) for name in names if kinds[name] == "duration" and frame.schema[name] == pl.String
    )


def _are_rows(data: Sequence[Any], width: int) -> bool:
    """Whether these are rows of so many values."""
    return (
        isinstance(data, list) and bool(data) and all(isinstance(r, list) and len(r) == width for r in data)
    )


def _name(column: Any) -> str:
    """Return the name of a column; one of several levels comes as a list."""
    return " ".join(map(str, column)) if isinstance(column, list) else str(column)


def _framed(names: Sequence[str], rows: Sequence[Sequence[Any]]) -> pl.DataFrame:
    """Return rows as a frame; of a name that is there again the later one is numbered."""
    again: dict[str, int] = {}
    own = []
    for name in names:
        again[name] = again.get(name, 0) + 1
        own.append(name if again[name] == 1 else f"{name}.{again[name] - 1}")
    return pl.DataFrame(dict(zip(own, zip(*rows, strict=True), strict=True)), strict=False)


def _duration(name: str) -> pl.Expr:
    """Return the durations of a column that are written as P0DT0H0M0.05S."""
    parts = pl.col(name).str.extract_groups(DURATION)
    sizes = {"days": 86_400e6, "hours": 3_600e6, "minutes": 60e6, "seconds": 1e6}
    size = pl.sum_horizontal(
        parts.struct.field(part).cast(pl.Float64).fill_null(0.0) * factor for part, factor in sizes.items()
    )
    turned = pl.when(parts.struct.field("sign") == "-").then(-size).otherwise(size)
    return turned.round().cast(pl.Int64).cast(pl.Duration("us")).alias(name)
