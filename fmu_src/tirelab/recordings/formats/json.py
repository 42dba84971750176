"""JSON files: a list of samples, {"time": 0.0, "force": 1.5} or [0.0, 1.5], one below the other or in brackets, or a
list for each channel, {"time": [...], "force": [...]}, also inside other objects, {"test": {"time": [...], ...}}; units
stand in the names, as in a CSV header, or beside the list, {"name": "force", "unit": "N", "values": [...]}. An object
whose keys count its values is a list, as pandas writes one: {"0": 0.0, "1": 1.5}.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import polars as pl

from ..origin import Origin
from ..units import split_header
from .libraries import reading_with
from .pandas_json import frame_of_pandas
from .parquet import frame_headers, series_values
from .table import Columns, Header, RecordingError, Wanted, sample_place
from .text_column import LOOKED_AT, headers_of_text

LINES = (".jsonl", ".ndjson")
"""Suffixes of files with one sample in each line."""

NAMES, UNITS, VALUES = ("name", "channel", "label"), ("unit", "units"), ("values", "data", "samples")
"""Keys of the name, the unit and the list of a channel in an object of its own."""


class JsonTable:
    """A JSON file; what a sample does not have is blank."""

    time_axis: int | None = None

    def __init__(self, path: Path) -> None:
        self.path = path
        with reading_with(path, "JSON"):
            self.frame = _frame(path)
        self.rows = self.frame.height
        named = frame_headers(self.frame.schema)
        self.headers: Sequence[Header]
        self.headers, self.above, self.notes = headers_of_text(
            named, self.frame.head(LOOKED_AT).get_columns()
        )

    def bytes_needed(self, columns: int) -> int:
        """The columns as float64; the file is in memory already."""
        return self.rows * columns * 8

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The columns wanted."""
        origin, found = Origin(self.path.name), [(self.headers[want.index], want.channel) for want in wanted]
        values = tuple(
            series_values(origin, header, self.frame[header.text][self.above :], channel)
            for header, channel in found
        )
        return Columns(values, sample_place, self.notes)


def _frame(path: Path) -> pl.DataFrame:
    if path.suffix.lower() in LINES:
        return pl.read_ndjson(path, infer_schema_length=None)
    held = json.loads(path.read_bytes())
    framed = frame_of_pandas(held)
    if framed is not None:
        return framed
    held = _plain(held)
    lists = dict(_lists(held))
    channels = {k: v for k, v in lists.items() if k and not any(isinstance(x, (dict, list)) for x in v)}
    longest, many = max(Counter(map(len, channels.values())).items(), default=(0, 0))
    # A list of sources or of settings beside the channels is shorter than they are.
    least = longest if many > 1 else 0
    tables = [v for v in lists.values() if _is_rows(v) and len(v) >= least]
    if len(tables) == 1 and isinstance(tables[0][0], dict):
        return pl.from_dicts(tables[0], infer_schema_length=None, strict=False)
    if len(tables) == 1:
        return _frame_of_lists(tables[0])
    if tables or longest < 2:
        raise RecordingError(
            f"{path.name}: {f'holds {len(tables)} tables' if tables else 'no table is found in it'}; write one list of "
            'samples, [{"time": 0.0, "deflection": 0.1, "force": 1.5}, ...], or one list for each channel'
        )
    chosen = {keys: v for keys, v in channels.items() if len(v) == longest}
    own = Counter(keys[-1] for keys in chosen)
    names = {keys: keys[-1] if own[keys[-1]] == 1 else ".".join(keys) for keys in chosen}
    return pl.DataFrame({names[keys]: v for keys, v in chosen.items()}, strict=False)


def _plain(held: Any) -> Any:
    """Return what a file holds with a list for an object that numbers its values, and for one that describes a channel
    an object with its list alone, under its name and unit.
    """
    if isinstance(held, dict):
        inner = {key: _plain(value) for key, value in held.items()}
        numbers = [int(key) for key in inner if key.isdecimal()]
        if len(numbers) == len(inner) > 1 and numbers == [numbers[0] + n for n in range(len(inner))]:
            return list(inner.values())
        return {key: _channel(value, key) or value for key, value in inner.items()}
    if not isinstance(held, list) or not held or not _channel(held[0]):
        return held
    channels = {str(number): _channel(one) for number, one in enumerate(held, 1)}
    return channels if all(channels.values()) else held


def _channel(held: Any, key: str = "") -> dict[str, list[Any]]:
    """Return the list of an object that describes one channel, under its name and unit; nothing for any other.

    key: under which the object stands, if any; then it names the channel, and the object has its unit at least
    """
    if not isinstance(held, dict):
        return {}
    name, unit, values = (
        next((held[k] for k in keys if isinstance(held.get(k), kind)), None)
        for keys, kind in ((NAMES, str), (UNITS, str), (VALUES, list))
    )
    if values is None or (unit if key else name) is None:
        return {}
    text = " ".join(filter(None, (key, name)))
    return {f"{text} [{unit.strip()}]" if unit and not split_header(text)[1] else text: values}


def _lists(held: Any, keys: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], list[Any]]]:
    """Yield the lists of a file with the keys of the objects that they stand in; the file itself may be one."""
    if isinstance(held, list):
        yield keys, held
    elif isinstance(held, dict):
        for key, value in held.items():
            yield from _lists(value, (*keys, key))


def _frame_of_lists(rows: Sequence[Sequence[Any]]) -> pl.DataFrame:
    """Return rows of one length as a table; the names stand in the first one, if it is all text, or are numbers."""
    names = [f"column {number}" for number in range(1, len(rows[0]) + 1)]
    named = all(isinstance(cell, str) for cell in rows[0]) and len({*rows[0]}) == len(names)
    columns = zip(*rows[int(named) :], strict=True)
    return pl.DataFrame(dict(zip(rows[0] if named else names, columns, strict=True)), strict=False)


def _is_rows(held: Any) -> bool:
    """Whether this is a list of samples: each with names, or each a list as long as the others."""
    if not isinstance(held, list) or len(held) < 2:
        return False
    if all(isinstance(row, dict) for row in held):
        return True
    return all(isinstance(row, list) for row in held) and len(held[0]) > 1 and len({*map(len, held)}) == 1
