"""Profiles from files: CSV with units in its header, and the elevation of a GPX track.

A GPX elevation gives hills, not bumps: its points are metres apart and its heights uncertain by metres. It serves for
grades, to which `add_roughness` adds ground of a known roughness.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from ..errors import TirelabError
from ..recordings.units import Conversion, UnitError, conversion, split_header
from .curvature import smoothed_heights
from .gpx import track_points
from .profile import Floats, Profile, check_points

CSV_SMOOTHING_LENGTH = 0.05
"""Smoothing [m] of measured heights: half the shortest wave of ISO 8608, the width of the article's tire."""

GPX_SMOOTHING_LENGTH = 50.0
"""Smoothing [m] of satellite heights: 1 m of noise every 5 m becomes 0.03 of slope and a radius of 270 m."""

EARTH_RADIUS = 6371008.8
"""Mean radius [m] of the Earth (IUGG)."""

SAME_PLACE = 1.0
"""Points nearer than this [m] are one place to a satellite receiver, whatever its elevations say."""

DELIMITERS = ",;\t"


@dataclass(frozen=True)
class ProfileColumns:
    """Which columns of a file are s and z, where they have other names, and their units, over those of the header."""

    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)


def read_profile(path: str | Path, source: ProfileColumns = ProfileColumns()) -> Profile:
    """Return the profile of the file at `path`: GPX where its name ends in .gpx, otherwise CSV.

    source: which columns of a CSV file to read, and in which units
    """
    if Path(path).suffix.lower() != ".gpx":
        return read_profile_csv(path, source=source)
    if source != ProfileColumns():
        raise TirelabError(f"{path}: a GPX track has no columns to name; leave out --columns and --units")
    return read_gpx(path)


def read_profile_csv(
    path: str | Path,
    smoothing_length: float = CSV_SMOOTHING_LENGTH,
    source: ProfileColumns = ProfileColumns(),
) -> Profile:
    """Return the profile of a CSV file with columns s and z, units in brackets: `s [m],z [cm]`.

    Where neither column has a unit, both are read in metres and the profile's notes say so. Other columns, empty lines
    and lines that begin with # are skipped; the separator is the comma, the semicolon or the tab of the header. Raises
    TirelabError with the row and column of what cannot be read.
    """
    table = read_columns(path, ("s", "z"), source)
    s, z = table.values
    check_points(s, z, lambda i: f"{path}, row {table.rows[i] if i < len(table.rows) else 1}")
    return Profile(s, z, Path(path).name, smoothing_length, table.notes)


@dataclass(frozen=True)
class LengthColumns:
    """Columns of lengths: `values` [m] in the requested order, the file's row of each value, and notes for the user."""

    values: tuple[Floats, ...]
    rows: tuple[int, ...]
    notes: tuple[str, ...]


def read_columns(
    path: str | Path, symbols: tuple[str, ...], source: ProfileColumns = ProfileColumns()
) -> LengthColumns:
    """Return the columns `symbols` [m] of a CSV file, in that order."""
    lines = _text(Path(path)).splitlines()
    filled = [(n, line) for n, line in enumerate(lines, start=1) if line.strip() and not line.startswith("#")]
    if not filled:
        raise TirelabError(f"{path}: the file is empty; give columns {_wanted(symbols)}")
    delimiter = max(DELIMITERS, key=filled[0][1].count)
    reader = csv.reader((line for _, line in filled), delimiter=delimiter)
    try:
        rows = [(filled[reader.line_num - 1][0], row) for row in reader]
    except csv.Error as error:
        raise TirelabError(
            f"{path}, row {filled[reader.line_num - 1][0]}: {error}; save it as plain CSV"
        ) from None
    header, cells, numbers = rows[0][1], [row for _, row in rows[1:]], tuple(n for n, _ in rows[1:])
    places = [_place(path, header, symbol, symbols, source) for symbol in symbols]
    conversions, notes = _conversions(path, header, dict(zip(symbols, places, strict=True)), source)
    values = np.empty((len(symbols), len(cells)))
    for i, row in enumerate(cells):
        for j, column in enumerate(places):
            cell = row[column].strip() if column < len(row) else ""
            try:
                values[j, i] = float(cell)
            except ValueError:
                raise TirelabError(
                    f"{path}, row {numbers[i]}, column {symbols[j]}: '{cell[:40]}' is not a number; write one, with a "
                    "decimal point"
                ) from None
    converted = tuple(to_metres.to_si(v) for to_metres, v in zip(conversions, values, strict=True))
    return LengthColumns(converted, numbers, notes)


def read_gpx(path: str | Path, smoothing_length: float = GPX_SMOOTHING_LENGTH) -> Profile:
    """Return the elevation of a GPX track of one segment over its horizontal length (haversine, spherical Earth).

    Points within SAME_PLACE of the last place, where the rider stood still, are merged with it and their elevations
    averaged; the profile's notes say how many.
    """
    points = track_points(_bytes(Path(path)), str(path))
    place, s, first = points[0], [0.0], [1]
    group = np.zeros(len(points), dtype=np.int64)
    for i, point in enumerate(points):
        run = great_circle(place, point)
        if run >= SAME_PLACE:
            place = point
            s.append(s[-1] + run)
            first.append(i + 1)
        group[i] = len(s) - 1
    z = np.bincount(group, points[:, 2]) / np.bincount(group)
    merged = len(points) - len(s)
    notes = (
        f"{merged} of {len(points)} track points lay within {SAME_PLACE:g} m of the last place; elevations averaged",
    )
    distance = np.array(s)
    check_points(distance, z, lambda i: f"{path}, track point {first[i]}")
    return Profile(distance, z, Path(path).name, smoothing_length, notes if merged else ())


def great_circle(here: Floats, there: Floats) -> float:
    """Return the distance [m] between two places, each latitude and longitude [degree] first."""
    (lat1, lon1), (lat2, lon2) = np.radians(here[:2]).tolist(), np.radians(there[:2]).tolist()
    half = (
        math.sin(0.5 * (lat2 - lat1)) ** 2
        + math.cos(lat1) * math.cos(lat2) * math.sin(0.5 * (lon2 - lon1)) ** 2
    )
    return 2.0 * EARTH_RADIUS * math.asin(math.sqrt(min(half, 1.0)))


def add_roughness(hills: Profile, detail: Profile) -> Profile:
    """Return the smooth heights of `hills` with the heights of `detail` added, at the points of `detail`.

    Both begin together; the result is as long as the shorter of the two.
    """
    base = CubicSpline(
        hills.s - hills.s[0], smoothed_heights(hills.s, hills.z, hills.smoothing_length), extrapolate=False
    )
    offset = detail.s - detail.s[0]
    kept = offset <= min(hills.length, detail.length)
    z: Floats = base(offset[kept]) + detail.z[kept]
    notes = hills.notes + detail.notes
    if hills.smoothing_length > 0.0:
        notes += (f"{hills.name} smoothed over {hills.smoothing_length:g} m",)
    return Profile(
        hills.s[0] + offset[kept], z, f"{hills.name} + {detail.name}", detail.smoothing_length, notes
    )


def _wanted(symbols: tuple[str, ...]) -> str:
    return " and ".join(f"'{symbol} [m]'" for symbol in symbols)


def _place(
    path: str | Path, header: list[str], symbol: str, symbols: tuple[str, ...], source: ProfileColumns
) -> int:
    """Return where the column `symbol` stands: under the name that `source` gives it, or under its own."""
    named = source.columns.get(symbol)
    for i, cell in enumerate(header):
        name, _ = split_header(cell)
        if named is None and name.lower() == symbol:
            return i
        if named is not None and named.lower() in (name.lower(), cell.strip().lower()):
            return i
    among = ", ".join(repr(c.strip()) for c in header)[:200]
    if named is not None:
        raise TirelabError(
            f"{path}, header: no column {named!r} among {among}; correct --columns {symbol}=NAME"
        )
    raise TirelabError(
        f"{path}, header: no column '{symbol}' among {among}; name the columns {_wanted(symbols)}, or say which it is "
        f"with --columns {symbol}=NAME"
    )


def _conversions(
    path: str | Path, header: list[str], places: Mapping[str, int], source: ProfileColumns
) -> tuple[list[Conversion], tuple[str, ...]]:
    """Return how each column becomes metres, and the note where no column has a unit."""
    units = {
        symbol: source.units.get(symbol) or split_header(header[place])[1] for symbol, place in places.items()
    }
    notes: tuple[str, ...] = ()
    if not any(units.values()):
        units = dict.fromkeys(units, "m")
        notes = (f"columns {' and '.join(units)} of {Path(path).name} have no units: read in metres",)
    found = []
    for symbol, unit in units.items():
        cell = header[places[symbol]].strip()
        if unit is None:
            raise TirelabError(
                f"{path}, header: column '{cell}' has no unit; write it in brackets, '{symbol} [m]', or give "
                f"--units {symbol}=m"
            )
        try:
            found.append(conversion(unit, "m"))
        except UnitError as error:
            raise TirelabError(f"{path}, header: '{cell}': {error}") from None
    return found, notes


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise TirelabError(f"{path}: {error.strerror or error}; name a file that can be read") from None


def _text(path: Path) -> str:
    try:
        return _bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TirelabError(f"{path}: not UTF-8 text at byte {error.start}; save the file as UTF-8") from None
