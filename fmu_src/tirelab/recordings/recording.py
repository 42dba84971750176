"""Recordings of a tire on a rig: what was measured, in SI, checked, and with all that reading them did."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .channels import UNIT_OF, Match, known_channel, match_channels, says_absolute, unit_of_column
from .formats import Header, RecordingError, Table, Wanted, open_table
from .formats.table import quoted
from .memory import memory_available, readable_size
from .metadata import Sidecar, read_sidecar
from .rows import Rows, complete_rows
from .samples import SampleFault, check_time, check_values, checked_radius, find_gaps, gap_notes
from .sign_convention import compressive_signs
from .units import STANDARD_ATMOSPHERE, Conversion, UnitError, conversion, parse_radius

__all__ = ["Recording", "RecordingError", "read_recording", "write_recording"]

FloatArray = NDArray[np.float64]

DEEPEST = 1.0
"""A compression [m] beyond the diameter of any bicycle wheel: its unit is wrong."""

_EXAMPLE_UNITS = {
    "time": "s",
    "deflection": "mm",
    "radius": "cm",
    "force": "N",
    "pressure": "kPa",
    "temperature": "degC",
    "speed": "m/s",
}
_HOUSE_UNITS = {**_EXAMPLE_UNITS, "deflection": "cm", "temperature": "K"}
_SIGNIFICANT_DIGITS = 12


@dataclass(frozen=True, eq=False)
class Recording:
    """What was measured on a tire, sample by sample.

    name             the file's stem, or a name given
    time             [s], strictly increasing
    deflection       [m], compressed > 0
    surface_radius   [m], convex > 0, concave < 0, flat = inf
    force            [N], compressive > 0
    pressure         [Pa], gauge, or None
    temperature      [K], or None
    speed            [m/s], or None
    source           the file read, or None
    notes            everything that reading did to the numbers, in sentences

    All arrays have the shape (samples,), samples >= 2, and are read-only.
    Errors: RecordingError (SampleFault where one sample is at fault) for unequal lengths, fewer than two
    samples, time that does not increase, a radius of zero, values not finite or beyond `BEYOND_BELIEF`.
    """

    name: str
    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    force: FloatArray
    pressure: FloatArray | None = None
    temperature: FloatArray | None = None
    speed: FloatArray | None = None
    source: Path | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        samples = len(self.time)
        for name, channel in self.channels():
            values = np.asarray(channel, dtype=np.float64).view()
            if values.shape != (samples,):
                raise RecordingError(
                    f"recording {quoted(self.name)}: {name} has shape {values.shape}, time ({samples},); "
                    "give every channel one value per sample"
                )
            values.flags.writeable = False
            object.__setattr__(self, "surface_radius" if name == "radius" else name, values)
        if samples < 2:
            raise RecordingError(
                f"recording {quoted(self.name)}: has {samples} samples; at least two are needed"
            )
        for name, values in self.channels():
            if name != "radius":
                check_values(name, values)
        object.__setattr__(self, "surface_radius", checked_radius(self.surface_radius))
        check_time(self.time)

    def __len__(self) -> int:
        return len(self.time)

    def channels(self) -> Iterator[tuple[str, FloatArray]]:
        """The channels there are, by name, in the order of the house form."""
        named = (
            ("time", self.time),
            ("deflection", self.deflection),
            ("radius", self.surface_radius),
            ("force", self.force),
            ("pressure", self.pressure),
            ("temperature", self.temperature),
            ("speed", self.speed),
        )
        return ((name, values) for name, values in named if values is not None)

    @cached_property
    def sampling_interval(self) -> float:
        """The median step in time [s]."""
        return float(np.median(np.diff(self.time)))

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @cached_property
    def gaps(self) -> NDArray[np.intp]:
        """The samples after which time steps by more than `GAP` sampling intervals: between i and i + 1."""
        return find_gaps(np.diff(self.time))


def read_recording(
    path: Path | str,
    *,
    columns: Mapping[str, str] | None = None,
    radius: str | float | None = None,
    units: Mapping[str, str] | None = None,
) -> Recording:
    """A recording from a file: CSV, TSV, Parquet, .mat, MDF4, TDMS or Excel, by its suffix.

    Parameters
    columns   channel -> column: its name whatever the case, or #number from 1; `-NAME` turns its sign,
              `+NAME` says that its sign is right; an empty name leaves an optional channel out
    radius    of the surface, over a column of it: "flat", "25.4cm", "-50.8 cm", or a number [m]
    units     channel -> unit, over what the file says

    What is not said here may stand in a sidecar (`tirelab.sidecar`). Rows that lack a value are skipped,
    signs that are clearly the other way round are turned, gaps are left as they are; `notes` tells all of it.

    Errors: RecordingError, one sentence with file, row, column, value and the next step.
    """
    path = Path(path)
    table = open_table(path)
    sidecar = read_sidecar(path)
    matches = match_channels(path, table.headers, table.time_axis, {**sidecar.columns, **(columns or {})})
    single_radius, notes = _given_radius(path, table, matches, sidecar, radius)
    if single_radius is not None:
        matches.pop("radius", None)
    headers = {name: table.headers[match.index] for name, match in matches.items()}
    conversions = _conversions(path, headers, {**sidecar.units, **(units or {})})
    _refuse_too_large(path, table, len(headers) + 1)
    read = table.read([Wanted(match.index, name) for name, match in matches.items()])
    rows = complete_rows(path, headers, read)
    values = {name: _in_si(column, conversions[name]) for name, column in rows.values.items()}
    if single_radius is not None:
        values["radius"] = np.full(len(values["time"]), single_radius)
    notes = [*read.notes, *rows.notes, *notes]
    notes += [f"settings read from {source}" for source in sidecar.sources]
    notes += _unit_notes(conversions, headers)
    doubt = _turn_signs(values, matches, notes)
    notes += gap_notes(values["time"])
    try:
        recording = Recording(
            name=path.stem,
            time=values["time"],
            deflection=values["deflection"],
            surface_radius=values["radius"],
            force=values["force"],
            pressure=values.get("pressure"),
            temperature=values.get("temperature"),
            speed=values.get("speed"),
            source=path,
            notes=tuple(notes),
        )
    except SampleFault as fault:
        raise rows.error(fault.index, fault.channel, fault.what) from None
    _check_loading(rows, recording, doubt)
    return recording


def write_recording(recording: Recording, path: Path | str) -> None:
    """Write a recording as CSV in the house form, `time [s],deflection [cm],radius [cm],force [N]`.

    Pressure [kPa] (gauge), temperature [K] and speed [m/s] follow where there are any. Numbers have 12
    significant digits: reading the file again gives each value within 1e-11 of itself.
    Errors: RecordingError when the file cannot be written.
    """
    frame = {}
    for name, values in recording.channels():
        convert = conversion(_HOUSE_UNITS[name], UNIT_OF[name])
        frame[f"{name} [{convert.unit}]"] = _rounded(values * convert.divide / convert.multiply)
    try:
        pl.DataFrame(frame).write_csv(Path(path))
    except OSError as error:
        raise RecordingError(
            f"{path}: cannot be written ({error}); check the folder and its permissions"
        ) from None


def _given_radius(
    path: Path, table: Table, matches: Mapping[str, Match], sidecar: Sidecar, radius: str | float | None
) -> tuple[float | None, list[str]]:
    """The radius of every row and the note of where it is from; None where a column gives it."""
    column = quoted(table.headers[matches["radius"].index].text) if "radius" in matches else ""
    try:
        if radius is not None:
            over = column or (sidecar.radius and sidecar.radius_source)
            instead = f", not taken from {over}" if over else ""
            return parse_radius(radius), [f"surface radius {_told(parse_radius(radius))} as given{instead}"]
        if column:
            unused = [f"radius of {sidecar.radius_source} not used: column {column} gives it"]
            return None, unused if sidecar.radius else []
        if sidecar.radius:
            length = parse_radius(sidecar.radius)
            return length, [f"surface radius {_told(length)} from {sidecar.radius_source}"]
    except UnitError as error:
        place = sidecar.radius_source if radius is None else path.name
        raise RecordingError(f"{place}: {error}") from None
    raise RecordingError(
        f"{path.name}: the radius of the surface is not known; add a column such as radius [cm] (inf: flat), "
        'or give --radius flat (25.4cm, -50.8cm), or write radius = "flat" into recording.toml beside it'
    )


def _told(radius: float) -> str:
    return "flat" if np.isinf(radius) else f"{radius:.6g} m"


def _conversions(
    path: Path, headers: Mapping[str, Header], units: Mapping[str, str]
) -> dict[str, Conversion]:
    found = {}
    for name in units:
        known_channel(name, f"{path.name}, units")
    for name, header in headers.items():
        place = f"{path.name}, column {quoted(header.text)}"
        unit = units.get(name) or unit_of_column(header, name)
        if not unit:
            raise RecordingError(
                f"{place}: has no unit; write it into the header, such as {name} [{_EXAMPLE_UNITS[name]}], "
                f"or give it: --units {name}={_EXAMPLE_UNITS[name]}"
            )
        try:
            found[name] = conversion(unit, UNIT_OF[name])
            if name == "pressure" and not found[name].absolute_pressure and says_absolute(header):
                found[name] = conversion(f"{unit} abs", UNIT_OF[name])
        except UnitError as error:
            raise RecordingError(f"{place}: {error} (or give it: --units {name}=UNIT)") from None
    return found


def _refuse_too_large(path: Path, table: Table, columns: int) -> None:
    needed, available = table.bytes_needed(columns), memory_available()
    if needed > available:
        size = readable_size(path.stat().st_size)
        raise RecordingError(
            f"{path.name}: has {size} and needs about {readable_size(needed)} of memory, of which "
            f"{readable_size(available)} are free; cut it into shorter recordings, or keep every tenth row"
        )


def _in_si(values: FloatArray, convert: Conversion) -> FloatArray:
    # What overflows here is refused as beyond belief, with its place, when the recording is made.
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
    """Turn what counts the other way round; where that cannot be told, the words for it."""
    for name, match in matches.items():
        if match.sign < 0 and name in values:
            values[name] = -values[name]
            notes.append(f"{name} turned in sign, as asked")
    signs = compressive_signs(values["deflection"], values["force"])
    settled = {name for name in ("deflection", "force") if matches[name].sign}
    turned = {name for name, sign in (("deflection", signs.deflection), ("force", signs.force)) if sign < 0}
    if len(settled) == 2:
        return ""
    if signs.doubt or turned & settled:
        return signs.doubt or f"{' and '.join(sorted(turned))} would have to be turned"
    for name in sorted(turned):
        values[name] = -values[name]
    if turned:
        notes.append(f"the rig counts compression negative: {' and '.join(sorted(turned))} turned in sign")
    return ""


def _check_loading(rows: Rows, recording: Recording, doubt: str) -> None:
    deflection = recording.deflection
    if deflection.min() == deflection.max():
        raise rows.error(
            0,
            "deflection",
            f"is {deflection[0]:.6g} m in every row; name the column that moves with --columns",
        )
    if doubt:
        raise RecordingError(
            f"{rows.path.name}: which way the rig counts cannot be told ({doubt}); say it with a sign before "
            "each column, + to keep and - to turn it: --columns deflection=-NAME,force=+NAME"
        )
    deepest = int(np.argmax(deflection))
    if deflection[deepest] > DEEPEST:
        raise rows.error(
            deepest, "deflection", f"{deflection[deepest]:.6g} m is deeper than a wheel; correct its unit"
        )


def _rounded(values: FloatArray) -> FloatArray:
    """The values to 12 significant digits, so that 2.54 is not written as 2.5400000000000005."""
    # Beyond these magnitudes the scale itself would overflow, and no measurement is that small.
    sized = np.isfinite(values) & (np.abs(values) > 1e-250)
    digits = np.zeros(values.shape)
    np.log10(np.abs(values), out=digits, where=sized)
    scale = 10.0 ** (_SIGNIFICANT_DIGITS - 1 - np.floor(digits))
    return np.where(sized, np.round(values * scale) / scale, values)
