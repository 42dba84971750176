"""The rows of a file that can be used: those that lack a value are skipped with a note, never filled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .channels import CHANNELS
from .formats import Columns, Header, RecordingError
from .formats.table import quoted
from .held import held_readings
from .jumps import false_readings, lost_readings, unevenly_read
from .origin import Origin
from .rounded_clock import evened
from .samples import COARSE, GAP

FloatArray = NDArray[np.float64]

MOST_BLANK = 0.1
"""The share of rows that may lack a value; with more, the columns were not recorded together."""

NOT_MEASURED = ((9.8e37, 3.5e38), (1.79e308, np.inf))
"""Numbers within these limits say that nothing was measured: 9.9E37 of SCPI-1999, the largest single and double."""

MOST_NAMED = 12
"""How many rows a note names one by one."""

NEARBY = 5
"""How many rows before and after one show how much the readings change from row to row there."""

OPTIONAL = tuple(channel.name for channel in CHANNELS if not channel.required and channel.name != "radius")
"""The channels a recording can do without; a sample without its surface is none."""


@dataclass(frozen=True)
class Rows:
    """The complete rows, by channel in the file's units: the sample each came from, and what was skipped."""

    origin: Origin
    headers: Mapping[str, Header]
    values: Mapping[str, FloatArray]
    kept: NDArray[np.intp] | None
    columns: Columns
    notes: tuple[str, ...]

    def place(self, index: int) -> str:
        """Where in the file the row of that number stands."""
        return self.columns.place(index if self.kept is None else int(self.kept[index]))

    def reversed(self) -> Rows:
        """Return the rows from the last to the first."""
        whole = np.arange(len(next(iter(self.values.values())))) if self.kept is None else self.kept
        values = {name: column[::-1].copy() for name, column in self.values.items()}
        return replace(self, values=values, kept=whole[::-1])

    def evened(self) -> Rows:
        """Return the rows with even times where those of the file are these, rounded, and a note of it."""
        written = self.values.get("time")
        if written is None:
            return self
        whole = np.arange(written.size) if self.kept is None else self.kept
        even = evened(written, whole)
        if even is None:
            return self
        said = "the times are those of even samples, rounded: read as even, as before they were written"
        return replace(self, values={**self.values, "time": even}, notes=(*self.notes, said))

    def error(self, index: int, channel: str, what: str) -> RecordingError:
        """The error for one value, with its place in the file."""
        header = self.headers.get(channel)
        column = f", column {quoted(header.text)}" if header else ""
        return RecordingError(f"{self.origin}, {self.place(index)}{column}: {what}")


def complete_rows(origin: Origin, headers: Mapping[str, Header], columns: Columns) -> Rows:
    """The rows with a value in every required channel; an optional channel with many blanks is left out.

    Of equal rows with one time the first is kept, with a note: some machines write the end of a step of a test twice.
    Rows before the clock runs, at the very beginning, are skipped with a note but for the last of them, few rows to
    which a rounded clock gives the time of the one before, rows that only repeat a reading which the logger holds, and
    rows whose deflection was lost.
    Errors: RecordingError for no rows, for a single one, or when more than `MOST_BLANK` of them lack a value.
    """
    values = dict(zip(headers, columns.values, strict=True))
    samples = len(columns.values[0])
    if samples == 0:
        raise RecordingError(f"{origin}: has a header and no rows below it; record again, or export it anew")
    # Some programs write the largest number there is where nothing was measured.
    for name, column in values.items():
        if max(np.fmax.reduce(column), -np.fmin.reduce(column)) >= NOT_MEASURED[0][0]:
            size = np.abs(column)
            marks = [(least <= size) & (size < most) for least, most in NOT_MEASURED]
            values[name] = np.where(np.logical_or(*marks), np.nan, column)
    values, kept, notes = _without_blanks(origin, columns, values)
    for which in (_repeated, _before_the_clock, _rounded_together, _held, _lost, _read_falsely):
        skipped, said = which(values)
        if len(skipped):
            whole = np.arange(samples) if kept is None else kept
            notes.append(f"skipped as {said}: {_places(columns, whole[skipped])}")
            kept = np.delete(whole, skipped)
            values = {name: np.delete(column, skipped) for name, column in values.items()}
    left = samples if kept is None else len(kept)
    if left < 2:
        raise RecordingError(
            f"{origin}: has {'a single row' if left else 'no row'} with a value in every column; "
            "a recording needs at least two"
        )
    return Rows(origin, headers, values, kept, columns, tuple(notes))


def _without_blanks(
    origin: Origin, columns: Columns, values: Mapping[str, FloatArray]
) -> tuple[dict[str, FloatArray], NDArray[np.intp] | None, list[str]]:
    """Return the rows that lack no value, their numbers, None where all are kept, and notes of the others."""
    # The greatest value is NaN as soon as one is: one pass, and no array of flags for a clean column.
    blank = {name: np.isnan(column) for name, column in values.items() if np.isnan(column.max())}
    if not blank:
        return dict(values), None, []
    notes = []
    samples = len(columns.values[0])
    none = np.zeros(samples, dtype=bool)
    empty = np.logical_and.reduce([blank.get(name, none) for name in values])
    for name in [name for name in OPTIONAL if name in blank]:
        missing = int(np.count_nonzero(blank[name] & ~empty))
        if missing > MOST_BLANK * samples:
            notes.append(f"{name} left out: {missing} of {samples} rows have no value for it")
            del blank[name]
            values = {other: column for other, column in values.items() if other != name}
    lacking = np.logical_or.reduce([none, *blank.values()])
    partial = np.flatnonzero(lacking & ~empty)
    channels = " and ".join(name for name in blank if np.any(blank[name][partial]))
    if len(partial) > MOST_BLANK * samples:
        raise RecordingError(
            f"{origin}: {len(partial)} of {samples} rows have no value for {channels} "
            f"({columns.place(int(partial[0]))} the first); delete them, or record the channels together"
        )
    if len(partial):
        notes.append(f"skipped for want of {channels}: {_places(columns, partial)}")
    if np.any(empty):
        notes.append(f"skipped as empty: {_places(columns, np.flatnonzero(empty))}")
    kept = np.flatnonzero(~(lacking | empty))
    return {name: column[kept] for name, column in values.items()}, kept, notes


Skipped = tuple[NDArray[np.intp], str]
"""Rows to skip, and as what they are skipped."""

NONE = np.empty(0, dtype=np.intp)


def _repeated(values: Mapping[str, FloatArray]) -> Skipped:
    """Return the rows that equal the one before in every channel, the time among them."""
    said, time = "equal to the row before, its time among it", values.get("time")
    if time is None:
        return NONE, said
    found = np.flatnonzero(time[1:] == time[:-1]) + 1
    same = [column[found] == column[found - 1] for column in values.values()]
    return (found[np.logical_and.reduce(same)] if len(found) else found), said


def _before_the_clock(values: Mapping[str, FloatArray]) -> Skipped:
    """Return the rows at the beginning that have the time of the row after them; none where other rows repeat one too.

    A machine may write what it reads while it waits for the start of the test. One row alone may be a slip; it is none
    where the deflection has not changed after it.
    """
    said = "before the clock runs"
    time, deflection = values.get("time"), values.get("deflection")
    if time is None or len(time) < 2 or not time[0] < time[-1]:
        return NONE, said
    still = np.flatnonzero(time[1:] == time[:-1])
    if len(still) == 1 and (deflection is None or deflection[0] != deflection[1]):
        return NONE, said
    return (still if np.array_equal(still, np.arange(len(still))) else NONE), said


def _rounded_together(values: Mapping[str, FloatArray]) -> Skipped:
    """Return the rows at the time of the one before that read what comes next in the motion: each gauge changes by no
    more than from row to row nearby, and no sample is missing after it. None where more than COARSE repeat a time.
    """
    said, time = "at the time of the row before, to which the clock is rounded", values.get("time")
    if time is None or len(time) < 2:
        return NONE, said
    found = np.flatnonzero(time[1:] == time[:-1]) + 1
    if not 0 < len(found) <= COARSE * len(time):
        return NONE, said
    moved = [np.abs(np.diff(gauge)) for gauge in _gauges(values) if gauge.size]
    goes_on = [i for i in found if _goes_on(time[i : i + 3]) and all(_usual(m, i - 1) for m in moved)]
    return np.array(goes_on, dtype=np.intp), said


def _goes_on(time: FloatArray) -> bool:
    """Whether no sample is missing between the first two of three times."""
    return len(time) < 3 or bool(time[1] - time[0] <= GAP * (time[2] - time[1]))


def _usual(moved: FloatArray, at: int) -> bool:
    """Whether a change is at most as large as the largest of those nearby."""
    nearby = np.concatenate([moved[max(at - NEARBY, 0) : at], moved[at + 1 : at + 1 + NEARBY]])
    return bool(moved[at] <= nearby.max(initial=0.0))


def _held(values: Mapping[str, FloatArray]) -> Skipped:
    """Return the rows in which one gauge has no new reading, as the logger writes rows more often."""
    name, rows, repeats = held_readings(*_gauges(values))
    return repeats, f"repeats of the last reading of the {name}, which is new in one of {rows} rows only"


def _lost(values: Mapping[str, FloatArray]) -> Skipped:
    """Return the rows whose deflection was not read."""
    said = "readings that the gauge of the deflection lost, far from those before and after"
    return lost_readings(*_gauges(values)), said


def _read_falsely(values: Mapping[str, FloatArray]) -> Skipped:
    """Return the rows whose deflection is off the motion."""
    gauges, time = _gauges(values), values.get("time")
    uneven = np.ones(gauges[0].size, dtype=bool) if time is None else unevenly_read(time)
    said = "false readings of the deflection, off the motion before and after by more than noise"
    return false_readings(*gauges, uneven), said


def _gauges(values: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return deflection and force, without samples where one of them is missing."""
    both = values.keys() >= {"deflection", "force"}
    return (values["deflection"], values["force"]) if both else (np.empty(0), np.empty(0))


def _places(columns: Columns, rows: NDArray[np.intp]) -> str:
    named = ", ".join(columns.place(int(row)) for row in rows[:MOST_NAMED])
    more = len(rows) - MOST_NAMED
    return f"{named} and {more} more" if more > 0 else named
