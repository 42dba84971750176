"""The columns of a table as channels in SI, as its plan has them, and which way the rig counts."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from .channels import unit_of_column
from .clock_doubt import clock_doubt
from .counting import Counted, count_from_zero
from .epochs import began
from .formats import Columns, Header, RecordingError
from .formats.table import listed, quoted
from .pieces import Piece, samples_within
from .plausibility import Doubts, doubts_of, too_deep
from .reading_plan import Plan
from .rounded_clock import lost_in_single
from .rows import Rows, complete_rows
from .samples import HALF_DAY, descends, gap_notes, over_midnight, over_the_top
from .thousands_doubt import thousands_doubt
from .units import STANDARD_ATMOSPHERE, Conversion

FloatArray = NDArray[np.float64]

DEEPEST = 1.0
"""A compression [m] beyond the diameter of any bicycle wheel: its unit is wrong."""


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

    def tests(self) -> str:
        """Return how the parts of the file are named between which the time goes back, some of many."""
        time = self.values["time"]
        ends = [0, *(np.flatnonzero(np.diff(time) < 0.0) + 1).tolist(), time.size]
        rows = [self.rows.place(end + self.first).split()[-1] for end in ends[:-1]]
        last = [self.rows.place(end - 1 + self.first).split()[-1] for end in ends[1:]]
        named = [f"{self.rows.origin}@{a}:{b}" for a, b in zip(rows, last, strict=True)]
        return listed([shlex.quote(name) for name in named], most=4)

    def check_loading(self) -> None:
        """Refuse a deflection that never changes or is deeper than a wheel, and signs that are in doubt."""
        deflection = self.values["deflection"]
        # A part of a file may be a hold.
        read = (deflection, self.before.get("deflection", deflection))
        if min(v.min(initial=np.inf) for v in read) == max(v.max(initial=-np.inf) for v in read):
            still = f"is {plain(deflection[0], 6)} m in every row"
            naming = self.rows.origin.columns(deflection="NAME")
            raise self.error(0, "deflection", f"{still}; name the column that moves with {naming}")
        if self.counted.fault is not None:
            raise self.counted.fault
        deepest = int(np.argmax(deflection))
        if deflection[deepest] > DEEPEST and not self.part:
            guess = too_deep(self.rows.origin, float(np.ptp(deflection)), self.units.get("deflection", ""))
            what = f"{plain(deflection[deepest], 6)} m is deeper than a wheel; correct its unit"
            raise self.error(deepest, "deflection", what + (f" ({guess})" if guess else ""))


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
    _refuse_lost_steps(rows, plan)
    rows = rows.evened()
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
    notes += gap_notes(values["time"]) if plan.timed else []
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
    doubts = replace(doubts, sentences=(*_of_columns(rows, plan, values["time"]), *doubts.sentences))
    notes += [f"doubtful: {sentence}" for sentence in doubts.sentences]
    return Interpreted(values, rows, tuple(notes), counted, units, doubts, before, part_alone)


def _time_from_first(
    read: FloatArray | None, rows: Rows, plan: Plan, backwards: bool
) -> tuple[FloatArray, list[str]]:
    """Return the time of each sample [s], and the notes of what was done to it.

    read: the times of the file, where it has any; backwards: whether these fell from row to row
    """
    notes = []
    beginning = ""
    if read is None:
        assert plan.interval is not None  # a plan without a column of time has one
        kept = np.arange(len(rows.values["deflection"])) if rows.kept is None else rows.kept
        time = np.asarray(kept * plan.interval, dtype=np.float64)
    else:
        beginning = began(float(read[0]), plan.conversions["time"].multiplied)
        time = read - read[0] if beginning else read
    if backwards:
        notes.append("time falls from row to row: the rows read from the last to the first")
        if plan.headers["time"].dated:
            time = time - time[0]
    time, midnight = over_midnight(time)
    if midnight is not None:
        notes.append(f"the clock passes midnight at {rows.place(midnight)}: a day added from there on")
    elif read is not None and plan.headers["time"].dated:
        time, twelve = over_midnight(time, HALF_DAY)
        if twelve is not None:
            notes.append(f"the clock passes twelve at {rows.place(twelve)}: twelve hours added from there on")
    if read is not None and not plan.headers["time"].dated:
        time, anew = over_the_top(time, plan.conversions["time"].multiplied)
        if anew is not None:
            notes.append(f"the counter of the time is full before {rows.place(anew)}: it goes on from there")
    if beginning:
        notes.append(f"time counted from the first sample, which is at {beginning}")
    return time, notes


def _refuse_lost_steps(rows: Rows, plan: Plan) -> None:
    """Raise RecordingError where the times stand still because they were stored in single precision."""
    written, convert = rows.values.get("time"), plan.conversions.get("time")
    if written is None or convert is None:
        return
    size = convert.multiplied
    step = lost_in_single(written, size)
    if step:
        late = int(np.argmax(np.diff(written) <= 0.0)) + 1
        what = (
            f"time repeats {plain(written[late] * size, 9)} s: in single precision times of this size are "
            f"{plain(step, 3)} s apart, and the steps of the samples are lost; export them in double precision or "
            "from 0 on, or, if the samples are evenly spaced, give the rate at which they were taken: "
            f"{rows.origin.sampling('RATE')}"
        )
        raise rows.error(late, "time", what)


def _of_columns(rows: Rows, plan: Plan, time: FloatArray) -> list[str]:
    """Return a sentence for each column whose mark may stand between thousands, and for a clock of another unit."""
    header, convert = plan.headers.get("time"), plan.conversions.get("time")
    clock = ""
    if header is not None and convert is not None and not header.dated:
        clock = clock_doubt(rows.origin, time, convert.unit, convert.multiplied)
    said = [f"column {quoted(header.text)}: {clock}"] if header is not None and clock else []
    found = ((name, thousands_doubt(column)) for name, column in rows.values.items() if name in rows.headers)
    return said + [
        f"{rows.place(doubt[0])}, column {quoted(rows.headers[name].text)}: {doubt[1]}"
        for name, doubt in found
        if doubt is not None
    ]


def _part_text(piece: Piece) -> str:
    kind = "" if any(c.isalpha() for c in piece.start + piece.stop) else "rows "
    return f"{kind}{piece.start or 'the start'} to {piece.stop or 'the end'}"


def _numbered(rows: Rows, samples: int) -> NDArray[np.int64]:
    """Return the number by which messages call each sample: its row, or its place among the samples."""
    first, last = (int(rows.place(i).split()[-1]) for i in (0, samples - 1))
    if last - first == samples - 1:
        return np.arange(first, last + 1)
    return np.array([int(rows.place(i).split()[-1]) for i in range(samples)])


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
