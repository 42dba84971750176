"""The columns of a table as channels in SI: which is which, in which unit, and which way the rig counts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .channels import UNIT_OF, Match, known_channel, match_channels, says_absolute, unit_of_column
from .formats import Columns, Header, RecordingError, Table, Wanted
from .formats.table import quoted
from .metadata import Settings
from .origin import Origin
from .rows import Rows, complete_rows
from .samples import gap_notes
from .sign_convention import compressive_signs
from .units import STANDARD_ATMOSPHERE, Conversion, UnitError, conversion, parse_radius

FloatArray = NDArray[np.float64]

DEEPEST = 1.0
"""A compression [m] beyond the diameter of any bicycle wheel: its unit is wrong."""

EXAMPLE_UNITS: Mapping[str, str] = {
    "time": "s",
    "deflection": "mm",
    "radius": "cm",
    "force": "N",
    "pressure": "kPa",
    "temperature": "degC",
    "speed": "m/s",
}
"""The unit of each channel that advice names."""


@dataclass(frozen=True)
class Plan:
    """What is to be read from a table: columns by channel, their units, and the radius if no column gives it."""

    origin: Origin
    matches: Mapping[str, Match]
    headers: Mapping[str, Header]
    conversions: Mapping[str, Conversion]
    radius: float | None
    notes: tuple[str, ...]

    @property
    def wanted(self) -> tuple[Wanted, ...]:
        """The columns to read, in the order of `headers`."""
        return tuple(Wanted(match.index, name) for name, match in self.matches.items())


@dataclass(frozen=True)
class Interpreted:
    """Channels in SI with compression positive, by name, and the rows that they came from.

    doubt: why the signs could not be determined, "" where they could
    """

    values: Mapping[str, FloatArray]
    rows: Rows
    notes: tuple[str, ...]
    doubt: str

    def check_loading(self) -> None:
        """Refuse a deflection that never changes or is deeper than a wheel, and signs that are in doubt."""
        deflection = self.values["deflection"]
        if deflection.min() == deflection.max():
            still = f"is {deflection[0]:.6g} m in every row"
            naming = self.rows.origin.columns(deflection="NAME")
            raise self.rows.error(0, "deflection", f"{still}; name the column that moves with {naming}")
        if self.doubt:
            naming = self.rows.origin.columns(deflection="-NAME", force="+NAME")
            raise RecordingError(
                f"{self.rows.origin}: which way the rig counts cannot be determined ({self.doubt}); say it with "
                f"a sign before each column, + to keep and - to turn it: {naming}"
            )
        deepest = int(np.argmax(deflection))
        if deflection[deepest] > DEEPEST:
            what = f"{deflection[deepest]:.6g} m is deeper than a wheel; correct its unit"
            raise self.rows.error(deepest, "deflection", what)


def plan_reading(origin: Origin, table: Table, settings: Settings) -> Plan:
    """Return which columns of a table become which channels, in which units, on which surface.

    Errors: RecordingError where a channel has no column or several, a unit or the radius is not known.
    """
    matches = match_channels(origin, table.headers, table.time_axis, settings.columns)
    radius, notes = _given_radius(origin, table, matches, settings)
    if radius is not None:
        matches.pop("radius", None)
    headers = {name: table.headers[match.index] for name, match in matches.items()}
    conversions = _conversions(origin, headers, settings.units)
    return Plan(origin, matches, headers, conversions, radius, tuple(notes))


def interpret(plan: Plan, read: Columns, sources: tuple[str, ...] = ()) -> Interpreted:
    """Return the columns read as channels in SI, rows without a value skipped, clearly wrong signs turned.

    sources: names of the files from which settings were read
    Errors: RecordingError where too many rows lack a value.
    """
    rows = complete_rows(plan.origin, plan.headers, read)
    values = {name: _in_si(column, plan.conversions[name]) for name, column in rows.values.items()}
    if plan.radius is not None:
        values["radius"] = np.full(len(values["time"]), plan.radius)
    notes = [*read.notes, *rows.notes, *plan.notes]
    notes += [f"settings read from {source}" for source in sources]
    notes += _unit_notes(plan.conversions, plan.headers)
    doubt = _turn_signs(values, plan.matches, notes)
    notes += gap_notes(values["time"])
    return Interpreted(values, rows, tuple(notes), doubt)


def _given_radius(
    origin: Origin, table: Table, matches: Mapping[str, Match], settings: Settings
) -> tuple[float | None, list[str]]:
    """Return the radius of every row and the note of where it is from; None where a column gives it."""
    column = quoted(table.headers[matches["radius"].index].text) if "radius" in matches else ""
    source = settings.radius_source
    try:
        if settings.radius is not None:
            length = parse_radius(settings.radius)
            over = column or (settings.radius_in_file and source)
            instead = f", not taken from {over}" if over else ""
            return length, [f"surface radius {_radius_text(length)} as given{instead}"]
        if column:
            unused = [f"radius of {source} not used: column {column} gives it"]
            return None, unused if settings.radius_in_file else []
        if settings.radius_in_file:
            length = parse_radius(settings.radius_in_file)
            return length, [f"surface radius {_radius_text(length)} from {source}"]
    except UnitError as error:
        raise RecordingError(f"{source if settings.radius is None else origin}: {error}") from None
    in_file = "" if origin.kind != "file" else ', or write radius = "flat" into recording.toml beside it'
    raise RecordingError(
        f"{origin}: the radius of the surface is not known; add a column such as radius [cm] (inf: flat), "
        f"or give {origin.radius('flat')} (25.4cm, -50.8cm){in_file}"
    )


def _radius_text(radius: float) -> str:
    return "flat" if np.isinf(radius) else f"{radius:.6g} m"


def _conversions(
    origin: Origin, headers: Mapping[str, Header], units: Mapping[str, str]
) -> dict[str, Conversion]:
    found = {}
    for name in units:
        known_channel(name, f"{origin}, units")
    for name, header in headers.items():
        place = f"{origin}, column {quoted(header.text)}"
        unit = units.get(name) or unit_of_column(header, name)
        if not unit:
            example = EXAMPLE_UNITS[name]
            raise RecordingError(
                f"{place}: has no unit; write it into the header, such as {name} [{example}], "
                f"or give it: {origin.units(**{name: example})}"
            )
        try:
            found[name] = conversion(unit, UNIT_OF[name])
            if name == "pressure" and not found[name].absolute_pressure and says_absolute(header):
                found[name] = conversion(f"{unit} abs", UNIT_OF[name])
        except UnitError as error:
            giving = origin.units(**{name: "UNIT"})
            raise RecordingError(f"{place}: {error} (or give it: {giving})") from None
    return found


def _in_si(values: FloatArray, convert: Conversion) -> FloatArray:
    # What overflows here is refused as not plausible, with its place, when the recording is made.
    with np.errstate(over="ignore"):
        return convert.to_si(values)


def _unit_notes(conversions: Mapping[str, Conversion], headers: Mapping[str, Header]) -> list[str]:
    notes = []
    for name, convert in conversions.items():
        stated = headers[name].unit
        if stated and stated not in (convert.unit, convert.unit.removesuffix(" abs")):
            notes.append(f"{name} read in {convert.unit} as given, not in {stated}")
        if convert.absolute_pressure:
            notes.append(
                f"pressure is absolute: the standard atmosphere, {STANDARD_ATMOSPHERE:.0f} Pa, taken off"
            )
    return notes


def _turn_signs(values: dict[str, FloatArray], matches: Mapping[str, Match], notes: list[str]) -> str:
    """Turn channels that count the other way round; return why, where that cannot be determined."""
    for name, match in matches.items():
        if match.sign < 0 and name in values:
            values[name] = -values[name]
            notes.append(f"{name} turned in sign, as asked")
    signs = compressive_signs(values["deflection"], values["force"])
    given = {name for name in ("deflection", "force") if matches[name].sign}
    turned = {name for name, sign in (("deflection", signs.deflection), ("force", signs.force)) if sign < 0}
    if len(given) == 2:
        return ""
    if signs.doubt or turned & given:
        return signs.doubt or f"{' and '.join(sorted(turned))} would have to be turned"
    for name in sorted(turned):
        values[name] = -values[name]
    if turned:
        notes.append(f"the rig counts compression negative: {' and '.join(sorted(turned))} turned in sign")
    return ""
