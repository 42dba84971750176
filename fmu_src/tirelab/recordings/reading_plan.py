"""What is to be read from a table: which column is which channel, in which unit, and what was said beside it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..names import plain
from .asking import Lacking, asked
from .channels import EXAMPLE_UNITS, UNIT_OF, known_channel, says_absolute, unit_of_column, units_stated
from .formats import Header, RecordingError, Table, Wanted
from .formats.table import SomeColumns, listed, quoted
from .guessing import may_count_time, rises, stating_time
from .matching import Match, Matches, match_channels, option_name, recognised, several_columns
from .metadata import Settings
from .origin import Origin
from .rows import OPTIONAL
from .sampling import parse_interval, sampling_said
from .side_by_side import SeveralTrials
from .totals import total_force
from .units import (
    Conversion,
    UnitError,
    conversion,
    given_conversion,
    is_no_unit,
    measures,
    parse_quantity,
    parse_radius,
)

MOST_LOOKED_AT = 8
"""Most columns without a channel that are searched for a time."""


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
        spare = set(OPTIONAL) - {"believed_force"}  # which is read where it is asked for alone
        return tuple(Wanted(match.index, name, name not in spare) for name, match in self.matches.items())


def plan_reading(origin: Origin, table: Table, settings: Settings, trial: int | None = None) -> Plan:
    """Return which columns of a table become which channels, in which units, on which surface.

    trial: which of several tests side by side, from 1
    Errors: IncompleteRecording where a required column, a unit or the radius is not known, for all of them at once;
    RecordingError where several columns may be a channel or a unit is none.
    """
    found, total = _matches(origin, table, settings, trial)
    matches = dict(found.columns)
    interval, notes = _given_interval(origin, matches, settings)
    radius, more = _given_radius(origin, table, matches, settings)
    if radius is not None:
        matches.pop("radius", None)
    headers = {name: table.headers[match.index] for name, match in matches.items()}
    above: tuple[str, ...] = getattr(table, "provenance", ())
    conversions, without_unit, wrong = _conversions(origin, headers, settings.units)
    stated = {name: unit for name, unit in units_stated(above).items() if name in without_unit}
    conversions |= {name: conversion(unit, UNIT_OF[name]) for name, unit in stated.items()}
    without_unit = tuple(name for name in without_unit if name not in stated)
    notes += [f"{name} in {unit}, as the lines above the table say" for name, unit in stated.items()]
    unread = _unread(headers, without_unit, settings)
    without_unit = tuple(name for name in without_unit if name not in unread)
    notes += [_unread_note(origin, headers.pop(name), name) for name in unread]
    matches = {name: match for name, match in matches.items() if name not in unread}
    radius = np.inf if "radius" in unread else radius
    lacking = tuple(name for name in found.missing if name != "time")
    no_time = "time" not in matches and interval is None
    looked_at: Table = table
    of_test = matches
    if found.looked_at is not None:
        first, width = found.looked_at
        looked_at = SomeColumns(table, first, width)
        of_test = {name: replace(match, index=match.index - first) for name, match in matches.items()}
    asks = no_time and settings.columns.get("time") is None
    if asks and _may_hold_time(looked_at, of_test, len(lacking)):
        lacking = ("time", *lacking)
    wanted = Lacking(lacking, without_unit, radius is None and "radius" not in matches, wrong)
    if wanted:
        raise asked(origin, looked_at, of_test, wanted, settings)
    if no_time:
        interval = 1.0
        rate = sampling_said(above)
        known = "the lines above the table state the sampling" if rate else "if the sampling is known"
        notes.append(
            "time was not measured: one second from sample to sample is made up, and nothing of rate, time or "
            f"acceleration can be told ({known}: {origin.sampling(rate or '10Hz')})"
        )
    constants, told = _constants(matches, settings)
    given = {*settings.columns, *(["force"] if total else [])}
    told += _others_alike(table.headers, found.columns, given) if found.trials == 1 else []
    return Plan(
        origin,
        matches,
        headers,
        conversions,
        radius,
        (*notes, *more, *total, *told),
        None if "time" in matches else interval,
        not no_time,
        found.trials,
        constants,
        {name: option_name(looked_at.headers, match.index) for name, match in of_test.items()},
        settings,
    )


def _matches(
    origin: Origin, table: Table, settings: Settings, trial: int | None
) -> tuple[Matches, tuple[str, ...]]:
    """Return which column is which channel; of forces of which one is the sum of others that one, with a note.

    Errors: as `match_channels`; RecordingError where a column that is called the force is a part of such a sum.
    """
    several: RecordingError | None = None
    try:
        found = match_channels(origin, table.headers, table.time_axis, settings.columns, trial)
        if found.trials > 1 or "force" in settings.columns:
            return found, ()
    except SeveralTrials:
        raise
    except RecordingError as error:
        several = error
    total = total_force(table) if "force" not in settings.columns and trial is None else None
    if total is not None:
        if several is None and "force" in found.columns and found.columns["force"].index in total.addends:
            raise several_columns(
                origin, table.headers, "force", (total.column, found.columns["force"].index)
            )
        columns = {**settings.columns, "force": f"#{total.column + 1}"}
        return match_channels(origin, table.headers, table.time_axis, columns), (total.note(table.headers),)
    if several is not None:
        raise several
    return found, ()


def _unread(headers: Mapping[str, Header], without_unit: Sequence[str], settings: Settings) -> list[str]:
    """Return the channels that no recording needs, found by a symbol alone: without a unit it may be of anything."""
    needless = [name for name in OPTIONAL if name not in settings.columns] + ["radius"] * settings.part
    return [name for name in without_unit if name in needless and len(headers[name].name) == 1]


def _unread_note(origin: Origin, header: Header, name: str) -> str:
    giving = origin.units(**{name: EXAMPLE_UNITS[name]})
    return (
        f"column {quoted(header.text)} not read as {name}: no unit; if it is the {name}, give one: {giving}"
    )


def _others_alike(
    headers: Sequence[Header], matches: Mapping[str, Match], given: Collection[str]
) -> list[str]:
    """Return a note for each channel whose column is not given although other columns have a unit of it too."""
    taken = {match.index for match in matches.values()}
    notes = []
    for name in ("deflection", "force"):
        if name in given:
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
    return interval, [f"time made of samples {plain(interval, 6)} s apart, as given{instead}"]


def _may_hold_time(table: Table, matches: Mapping[str, Match], lacking: int) -> bool:
    """Return whether a column that is no channel may be the time: it has a unit of time, or its numbers rise evenly.

    lacking: how many other channels have no column; where they take all that are left, rising is no sign of a clock
    """
    taken = {match.index for match in matches.values()}
    free = [i for i in range(len(table.headers)) if i not in taken]
    if stating_time(table.headers, taken):
        return True
    if len(free) <= lacking:
        return False
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
    return "flat" if np.isinf(radius) else f"{plain(radius, 6)} m"


def _conversions(
    origin: Origin, headers: Mapping[str, Header], units: Mapping[str, str]
) -> tuple[dict[str, Conversion], tuple[str, ...], dict[str, tuple[str, str]]]:
    """Return how each column becomes SI, the channels of which no unit is known, and those whose unit is none although
    one was likely meant, or is a word: what is said of it, and that unit, "" for a word."""
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
            if name not in units and (error.likely or is_no_unit(unit, [UNIT_OF[name]])):
                wrong[name] = (f"{place}: {error}", error.likely)
                continue
            kept = origin.kept_in("units", name)
            said = f", unit in {kept}" if kept else ""
            given = bool(units.get(name)) and not kept
            giving = "" if given else f" (or give it: {origin.units(**{name: 'UNIT'})})"
            raise RecordingError(f"{place}{said}: {error}{giving}") from None
    return found, tuple(without), wrong
