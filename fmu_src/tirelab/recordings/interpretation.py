"""The columns of a table as channels in SI: which is which, in which unit, and which way the rig counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .asking import Lacking, asked, may_count_time, rises, stating_time
from .channels import UNIT_OF, known_channel, says_absolute, unit_of_column
from .counting import Counted, count_from_zero
from .formats import Columns, Header, RecordingError, Table, Wanted
from .formats.table import SomeColumns, listed, quoted
from .matching import Match, match_channels, option_name, recognised
from .metadata import Settings
from .origin import Origin
from .pieces import Piece, samples_within
from .plausibility import YEAR_2001, YEAR_2096, Doubts, doubts_of, too_deep
from .rows import Rows, complete_rows
from .samples import descends, gap_notes, over_midnight
from .units import (
    STANDARD_ATMOSPHERE,
    Conversion,
    UnitError,
    conversion,
    given_conversion,
    measures,
    parse_interval,
    parse_quantity,
    parse_radius,
    sampling_said,
)

FloatArray = NDArray[np.float64]

MOST_LOOKED_AT = 8
"""Most columns without a channel that are searched for a time."""

DEEPEST = 1.0
"""A compression [m] beyond the diameter of any bicycle wheel: its unit is wrong."""


@dataclass(frozen=True)
class Plan:
    """What is to be read from a table: columns by channel, their units, and the radius if no column gives it.

    interval: between samples [s] where no column gives the time; timed: whether the time was measured, or its interval
    given; trials: how many tests stand side by side in the table; constants: of channels that no column holds [SI]
    names: how the options call each column; settings: what was said beside the table
    """

    origin: Origin
    matches: Mapping[str, Match]
    headers: Mapping[str, Header]
    conversions: Mapping[str, Conversion]
    radius: float | None
    notes: tuple[str, ...]
    interval: float | None = None
    timed: bool = True
    trials: int = 1
    constants: Mapping[str, float] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)
    settings: Settings = Settings()  # noqa: RUF009

    @property
    def wanted(self) -> tuple[Wanted, ...]:
        """The columns to read, in the order of `headers`."""
        return tuple(Wanted(match.index, name) for name, match in self.matches.items())


@dataclass(frozen=True)
class Interpreted:
    """Channels in SI with compression positive, by name, and the rows that they came from.

    counted: how the gauges count; units: of the channels as they were read
    doubts: what is doubtful of their sizes; before: the channels at the samples before those of the piece
    part: whether it is of a part, and not of a tire
    """

    values: Mapping[str, FloatArray]
    rows: Rows
    notes: tuple[str, ...]
    counted: Counted
    units: Mapping[str, str] = field(default_factory=dict)
    doubts: Doubts = Doubts()  # noqa: RUF009
    before: Mapping[str, FloatArray] = field(default_factory=dict)
    part: bool = False

    @property
    def first(self) -> int:
        """How many samples were left out before those of the piece."""
        return len(self.before.get("time", ()))

    def error(self, index: int, channel: str, what: str) -> RecordingError:
        """Return the error for one sample, with its place in the file."""
        return self.rows.error(index + self.first, channel, what)

    def above(self, index: int) -> str:
        """Return how the part of the file above one sample is named."""
        first, last = (self.rows.place(i + self.first).split()[-1] for i in (0, max(index - 1, 0)))
        return f"{self.rows.origin}@{first}:{last}"

    def check_loading(self) -> None:
        """Refuse a deflection that never changes or is deeper than a wheel, and signs that are in doubt."""
        deflection = self.values["deflection"]
        if deflection.min() == deflection.max():
            still = f"is {deflection[0]:.6g} m in every row"
            naming = self.rows.origin.columns(deflection="NAME")
            raise self.error(0, "deflection", f"{still}; name the column that moves with {naming}")
        if self.counted.fault is not None:
            raise self.counted.fault
        deepest = int(np.argmax(deflection))
        if deflection[deepest] > DEEPEST and not self.part:
            guess = too_deep(self.rows.origin, float(np.ptp(deflection)), self.units.get("deflection", ""))
            what = f"{deflection[deepest]:.6g} m is deeper than a wheel; correct its unit"
            raise self.error(deepest, "deflection", what + (f" ({guess})" if guess else ""))


def plan_reading(origin: Origin, table: Table, settings: Settings, trial: int | None = None) -> Plan:
    """Return which columns of a table become which channels, in which units, on which surface.

    trial: which of several tests side by side, from 1
    Errors: IncompleteRecording where a required column, a unit or the radius is not known, for all of them at once;
    RecordingError where several columns may be a channel or a unit is none.
    """
    found = match_channels(origin, table.headers, table.time_axis, settings.columns, trial)
    matches = dict(found.columns)
    interval, notes = _given_interval(origin, matches, settings)
    radius, more = _given_radius(origin, table, matches, settings)
    if radius is not None:
        matches.pop("radius", None)
    headers = {name: table.headers[match.index] for name, match in matches.items()}
    conversions, without_unit, wrong = _conversions(origin, headers, settings.units)
    lacking = tuple(name for name in found.missing if name != "time")
    no_time = "time" not in matches and interval is None
    looked_at: Table = table
    of_test = matches
    if found.looked_at is not None:
        first, width = found.looked_at
        looked_at = SomeColumns(table, first, width)
        of_test = {name: replace(match, index=match.index - first) for name, match in matches.items()}
    if no_time and settings.columns.get("time") is None and _may_hold_time(looked_at, of_test):
        lacking = ("time", *lacking)
    wanted = Lacking(lacking, without_unit, radius is None and "radius" not in matches, wrong)
    if wanted:
        raise asked(origin, looked_at, of_test, wanted, settings)
    if no_time:
        interval = 1.0
        rate = sampling_said(getattr(table, "provenance", ()))
        known = "the lines above the table state the sampling" if rate else "if the sampling is known"
        notes.append(
            "time was not measured: one second from sample to sample is made up, and nothing of rate, time or "
            f"acceleration can be told ({known}: {origin.sampling(rate or '10Hz')})"
        )
    constants, told = _constants(matches, settings)
    told += _others_alike(table.headers, found.columns, settings) if found.trials == 1 else []
    return Plan(
        origin,
        matches,
        headers,
        conversions,
        radius,
        (*notes, *more, *told),
        None if "time" in matches else interval,
        not no_time,
        found.trials,
        constants,
        {name: option_name(looked_at.headers, match.index) for name, match in of_test.items()},
        settings,
    )


def _others_alike(headers: Sequence[Header], matches: Mapping[str, Match], settings: Settings) -> list[str]:
    """Return a note for each channel that is not named by the user although other columns have a unit of it too."""
    taken = {match.index for match in matches.values()}
    notes = []
    for name in ("deflection", "force"):
        if name in settings.columns:
            continue
        others = [
            f"{quoted(header.text)} (#{i + 1})"
            for i, header in enumerate(headers)
            if i not in taken
            and "radius" not in recognised([header], {})
            and measures(unit_of_column(header, name) or "", UNIT_OF[name])
        ]
        if others:
            chosen = quoted(headers[matches[name].index].text)
            notes.append(f"{name} taken from {chosen}; not from {listed(others)}")
    return notes


def _constants(matches: Mapping[str, Match], settings: Settings) -> tuple[dict[str, float], list[str]]:
    """Return the one value [SI] of each channel that no column holds and the settings state, and the notes of them."""
    values: dict[str, float] = {}
    notes = []
    for name, text in settings.constants.items():
        if name in matches:
            notes.append(f"{name} = {text} of the settings not used: a column gives it")
            continue
        try:
            values[name] = parse_quantity(text, UNIT_OF[name])
        except UnitError as error:
            raise RecordingError(f"{name} in the settings: {error}") from None
        notes.append(f"{name} {text} in every row, as the settings say")
    return values, notes


def interpret(
    plan: Plan,
    read: Columns,
    sources: tuple[str, ...] = (),
    piece: Piece = Piece(),  # noqa: B008
) -> Interpreted:
    """Return the columns read as channels in SI, rows without a value skipped, clearly wrong signs turned.

    sources: names of the files from which settings were read; piece: the part of the samples that is kept
    Errors: RecordingError where too many rows lack a value, or the piece holds too few.
    """
    rows = complete_rows(plan.origin, plan.headers, read)
    backwards = "time" in rows.values and descends(rows.values["time"])
    rows = rows.reversed() if backwards else rows
    values = {name: _in_si(column, plan.conversions[name]) for name, column in rows.values.items()}
    samples = len(values["deflection"])
    time, time_notes = _time_from_first(values.get("time"), rows, plan, backwards)
    values = {"time": time, **values} if "time" not in values else {**values, "time": time}
    if plan.radius is not None:
        values["radius"] = np.full(samples, plan.radius)
    values |= {name: np.full(samples, value) for name, value in plan.constants.items()}
    notes = [*read.notes, *rows.notes, *plan.notes]
    notes += [f"settings read from {source}" for source in sources]
    notes += [*_unit_notes(plan.conversions, plan.headers), *time_notes]
    counted = count_from_zero(values, plan.origin, plan.matches, plan.names, plan.settings)
    notes += counted.notes
    believed = values.get("believed_force")
    if believed is not None and float(np.dot(believed, values["force"])) < 0.0:
        values["believed_force"] = -believed
        notes.append("believed_force turned in sign: it counts the other way than the force")
    part = samples_within(plan.origin.name, piece, values["time"], _numbered(rows, samples))
    before: dict[str, FloatArray] = {}
    if part is not None:
        before = {name: column[: part.start] for name, column in values.items()}
        values = {name: column[part] for name, column in values.items()}
        notes.append(f"{part.stop - part.start} of {samples} samples read: {_part_text(piece)}")
    notes += gap_notes(values["time"])
    units = {name: convert.unit for name, convert in plan.conversions.items()}
    first = len(before.get("time", ()))

    def where(channel: str, sample: int | None) -> str:
        header = plan.headers.get(channel)
        if header is None:
            return ""
        column = f"column {quoted(header.text)}"
        return column if sample is None else f"{rows.place(sample + first)}, {column}"

    part_alone = plan.settings.part
    doubts = Doubts() if counted.fault else doubts_of(counted.gauges, values, units, where, part_alone)
    notes += [f"doubtful: {sentence}" for sentence in doubts.sentences]
    return Interpreted(values, rows, tuple(notes), counted, units, doubts, before, part_alone)


def _time_from_first(
    read: FloatArray | None, rows: Rows, plan: Plan, backwards: bool
) -> tuple[FloatArray, list[str]]:
    """Return the time of each sample [s], and the notes of what was done to it.

    read: the times of the file, where it has any; backwards: whether these fell from row to row
    """
    notes = []
    since_1970 = 0.0
    if read is None:
        assert plan.interval is not None  # a plan without a column of time has one
        kept = np.arange(len(rows.values["deflection"])) if rows.kept is None else rows.kept
        time = np.asarray(kept * plan.interval, dtype=np.float64)
    else:
        since_1970 = float(read[0]) if YEAR_2001 <= float(read[0]) <= YEAR_2096 else 0.0
        time = read - since_1970 if since_1970 else read
    if backwards:
        notes.append("time falls from row to row: the rows read from the last to the first")
        if plan.headers["time"].dated:
            time = time - time[0]
    time, midnight = over_midnight(time)
    if midnight is not None:
        notes.append(f"the clock passes midnight at {rows.place(midnight)}: a day added from there on")
    if since_1970:
        notes.append(f"time counted from the first sample, which is at {since_1970:.6f} s since 1970")
    return time, notes


def _part_text(piece: Piece) -> str:
    kind = "" if any(c.isalpha() for c in piece.start + piece.stop) else "rows "
    return f"{kind}{piece.start or 'the start'} to {piece.stop or 'the end'}"


def _numbered(rows: Rows, samples: int) -> NDArray[np.int64]:
    """Return the number by which messages call each sample: its row, or its place among the samples."""
    first, last = (int(rows.place(i).split()[-1]) for i in (0, samples - 1))
    if last - first == samples - 1:
        return np.arange(first, last + 1)
    return np.array([int(rows.place(i).split()[-1]) for i in range(samples)])


def _given_interval(
    origin: Origin, matches: dict[str, Match], settings: Settings
) -> tuple[float | None, list[str]]:
    """Return the interval between samples [s] that a sampling rate gives, None without one; it goes over a column."""
    if settings.sampling is None:
        return None, []
    try:
        interval = parse_interval(settings.sampling)
    except UnitError as error:
        raise RecordingError(f"{origin}: {error}") from None
    instead = ", not taken from its column" if matches.pop("time", None) is not None else ""
    return interval, [f"time made of samples {interval:.6g} s apart, as given{instead}"]


def _may_hold_time(table: Table, matches: Mapping[str, Match]) -> bool:
    """Return whether a column that is no channel may be the time: it has a unit of time, or its numbers rise evenly."""
    taken = {match.index for match in matches.values()}
    free = [i for i in range(len(table.headers)) if i not in taken]
    if stating_time(table.headers, taken):
        return True
    for index in [i for i in free if may_count_time(table.headers[i])][:MOST_LOOKED_AT]:
        try:
            if rises(table.read((Wanted(index, "time"),)).values[0]):
                return True
        except RecordingError:
            continue
    return False


def _given_radius(
    origin: Origin, table: Table, matches: Mapping[str, Match], settings: Settings
) -> tuple[float | None, list[str]]:
    """Return the radius of every row and the note of where it is from; None where a column gives it, or nothing."""
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
    return (np.inf, []) if settings.part else (None, [])


def _radius_text(radius: float) -> str:
    return "flat" if np.isinf(radius) else f"{radius:.6g} m"


def _conversions(
    origin: Origin, headers: Mapping[str, Header], units: Mapping[str, str]
) -> tuple[dict[str, Conversion], tuple[str, ...], dict[str, tuple[str, str]]]:
    """Return how each column becomes SI, the channels of which no unit is known, and those whose unit is none although
    one was likely meant: what is said of it, and that unit."""
    found: dict[str, Conversion] = {}
    without: list[str] = []
    wrong: dict[str, tuple[str, str]] = {}
    for name in units:
        known_channel(name, f"{origin}, units")
    for name, header in headers.items():
        place = f"{origin}, column {quoted(header.text)}"
        unit = units.get(name) or unit_of_column(header, name)
        if not unit:
            without.append(name)
            continue
        try:
            read = given_conversion if units.get(name) else conversion
            found[name] = read(unit, UNIT_OF[name])
            if name == "pressure" and not found[name].absolute_pressure and says_absolute(header):
                found[name] = conversion(f"{unit} abs", UNIT_OF[name])
        except UnitError as error:
            if error.likely and name not in units:
                wrong[name] = (f"{place}: {error}", error.likely)
                continue
            kept = origin.kept_in("units", name)
            said = f", unit in {kept}" if kept else ""
            given = bool(units.get(name)) and not kept
            giving = "" if given else f" (or give it: {origin.units(**{name: 'UNIT'})})"
            raise RecordingError(f"{place}{said}: {error}{giving}") from None
    return found, tuple(without), wrong


def _in_si(values: FloatArray, convert: Conversion) -> FloatArray:
    # What overflows here is refused as not plausible, with its place, when the recording is made.
    with np.errstate(over="ignore"):
        return convert.to_si(values)


def _unit_notes(conversions: Mapping[str, Conversion], headers: Mapping[str, Header]) -> list[str]:
    notes = []
    for name, convert in conversions.items():
        stated = unit_of_column(headers[name], name)
        if stated and stated not in (convert.unit, convert.unit.removesuffix(" abs")):
            notes.append(f"{name} read in {convert.unit} as given, not in {stated}")
        if convert.absolute_pressure:
            notes.append(
                f"pressure is absolute: the standard atmosphere, {STANDARD_ATMOSPHERE:.0f} Pa, taken off"
            )
    return notes
