"""Recordings of a tire on a rig: what was measured, in SI, checked, and with all that reading them did."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import check_given, refuse_unknown, text_or_number, texts_of_channels
from .choices import Choices
from .description import facts, html_table, one_line
from .fixed_array import fix, fixed
from .formats import Columns, RecordingError, Table, open_table
from .formats.delimited import DelimitedTable
from .formats.excel import ExcelTable
from .formats.table import quoted
from .frames import array_table, array_units, frame_table, is_single, single_radius
from .interpretation import Interpreted, interpret
from .memory import memory_available, readable_size
from .metadata import Settings, read_sidecar
from .origin import Origin
from .pieces import Piece, split_piece
from .reading_plan import Plan, plan_reading
from .rows import OPTIONAL
from .samples import SampleFault, check_time, check_values, checked_radius, find_gaps

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Recording", "RecordingError", "Understood", "read_recording", "understand"]

FloatArray = NDArray[np.float64]


class Gauged(TypedDict, total=False):
    """What can be said of the gauges of a table, each as for `read_recording`."""

    sampling: str | float | None
    zero: Mapping[str, str] | None


class Exported(Gauged, total=False):
    """What can be said of a file too."""

    skip_rows: int | None


@dataclass(frozen=True, eq=False, repr=False)
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
    believed_force   [N] of a simulation, compressive > 0, or None
    source           the file read, or None
    notes            everything that reading did to the numbers, in sentences
    timed            whether time was measured, or its sampling given; otherwise the times are made up
    doubts           what is doubtful of the sizes of the numbers, in sentences (among the notes too)
    provenance       what the file says above its table: of the machine, the tire, the test
    far_zero         why its zero is so far off that no effect holds it, "" where one does
    history          of a part of a file what was recorded before it, or None: a simulation starts with it

    All arrays have the shape (samples,), samples >= 2, and are read-only; arrays that others may write to are copied.
    Errors: RecordingError (SampleFault where one sample is at fault) for unequal lengths, fewer than two
    samples, time that does not increase, a radius of zero, values not finite or beyond `LARGEST_PLAUSIBLE`.
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
    timed: bool = True
    doubts: tuple[str, ...] = ()
    provenance: tuple[str, ...] = ()
    believed_force: FloatArray | None = None
    far_zero: str = ""
    history: Recording | None = None

    def __post_init__(self) -> None:
        check_given(self.name, str, "name", "a text", "name='press'")
        samples = len(self.time)
        for name, channel in self.channels():
            values = fixed(channel)
            if values.shape != (samples,):
                raise RecordingError(
                    f"recording {quoted(self.name)}: {name} has shape {values.shape}, time ({samples},); "
                    "give every channel one value per sample"
                )
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

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Take the state of a pickled or copied recording, whose arrays are read-only too."""
        for value in state.values():
            if isinstance(value, np.ndarray):
                fix(value)
        self.__dict__.update(state)

    @classmethod
    def from_arrays(
        cls,
        time: ArrayLike | None,
        deflection: ArrayLike,
        force: ArrayLike,
        surface_radius: ArrayLike | None = None,
        *,
        name: str = "recording",
        units: Mapping[str, str] | None = None,
        **beside: ArrayLike | None,
    ) -> Recording:
        """Return a recording of arrays, lists or columns, with the checks and the sign rule of a file.

        Parameters
        time, deflection, force   shape (samples,); copied; [s], [m], [N] unless `units` says otherwise;
                                  time None where it was not measured
        surface_radius            the same, or one for all samples: a number [m], inf, "flat" or "25.4 cm"
        units                     channel -> unit: {"deflection": "mm", "force": "kN", "radius": "cm"}
        pressure, temperature, speed, believed_force   the same; [Pa] of gauge pressure, [K], [m/s], [N]

        Samples that lack a value (NaN) are skipped, signs that are clearly the other way round are turned;
        `notes` says so. Errors: RecordingError, one sentence with the sample, the value and the next step.
        """
        origin = Origin(name, "arrays")
        refuse_unknown(beside, dict.fromkeys(OPTIONAL))
        more = {name: values for name, values in beside.items() if values is not None}
        channel_units = array_units(origin, texts_of_channels("units", units), more)
        arrays: dict[str, Any] = {"deflection": deflection, "force": force, **more}
        if time is None:
            channel_units.pop("time")
        else:
            arrays = {"time": time, **arrays}
        radius = None
        if surface_radius is None or is_single(surface_radius):
            radius = single_radius(origin, surface_radius, channel_units["radius"])
            channel_units["radius"] = "m"
        else:
            arrays["radius"] = surface_radius
        table = array_table(origin, arrays)
        columns = {**({"time": ""} if time is None else {}), **{name: name for name in more}}
        return _recording_of(origin, table, Settings(columns, channel_units, radius))

    @classmethod
    def from_dataframe(
        cls,
        frame: Any,
        *,
        name: str = "recording",
        columns: Mapping[str, str] | None = None,
        radius: str | float | None = None,
        units: Mapping[str, str] | None = None,
        **more: Unpack[Gauged],
    ) -> Recording:
        """Return a recording of a pandas, polars or Arrow table, read like a file of the same columns.

        Parameters
        frame    units stand in the column names, such as `Load [kN]`; a named or dated index is a column too
        columns, radius, units, sampling, zero   as for `read_recording`

        Errors: RecordingError, one sentence with column, sample, value and the next step.
        """
        origin = Origin(name, "frame")
        refuse_unknown(more, Gauged.__annotations__)
        said = (texts_of_channels("columns", columns), texts_of_channels("units", units))
        zero = texts_of_channels("zero", more.get("zero"))
        radius, sampling = text_or_number("radius", radius), text_or_number("sampling", more.get("sampling"))
        settings = Settings(*said, radius, sampling=sampling, zero=zero)
        return _recording_of(origin, frame_table(origin, frame), settings)

    def __repr__(self) -> str:
        return one_line(
            self.name, [f if f[0] != "time" else ("time", "time not measured") for f in self._facts()]
        )

    def _repr_html_(self) -> str:
        extra = [(name, "recorded") for name in OPTIONAL if getattr(self, name) is not None]
        notes = [("note", note) for note in self.notes]
        return html_table(self.name, [*self._facts(), *extra, *notes])

    def _facts(self) -> tuple[tuple[str, str], ...]:
        found = facts(self.time, self.deflection, self.surface_radius, self.force)
        return (
            found
            if self.timed
            else tuple(("time", "not measured") if f[0] == "duration" else f for f in found)
        )

    def __len__(self) -> int:
        return len(self.time)

    @cached_property
    def whole(self) -> Recording:
        """The recording with its history before it; itself where it has none."""
        if self.history is None:
            return self
        pairs = zip(self.history.channels(), self.channels(), strict=True)
        joined = {name: np.concatenate([earlier, own]) for (name, earlier), (_, own) in pairs}
        joined["surface_radius"] = joined.pop("radius")
        return replace(self, **joined, history=None)  # type: ignore[arg-type]

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
            ("believed_force", self.believed_force),
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
    **more: Unpack[Exported],
) -> Recording:
    """A recording from a file: CSV, TSV, Parquet, JSON, .mat, MDF4, TDMS or Excel, by its suffix.

    Parameters
    path      of the file; `press.csv@10s:20s` is that part of it, `@100:2000` those rows, `@trial2` the second of tests
              that stand side by side
    columns   channel -> column: its name whatever the case, or #number from 1; `-NAME` turns its sign,
              `+NAME` says that its sign is right; an empty name leaves a channel out (the time: not measured)
    radius    of the surface, over a column of it: "flat", "25.4cm", "-50.8 cm", or a number [m]
    units     channel -> unit, over what the file says
    sampling  rate or interval of the samples, over a column of time: "10 Hz", "0.1 s", or a number [Hz]
    zero      channel -> what its gauge reads when nothing is loaded, which is subtracted: {"deflection": "30 mm"}
    skip_rows rows of text above the table, which is found without it too

    What is not said here may stand in a sidecar (`metadata`). Rows that lack a value are skipped, signs that
    are clearly the other way round are turned, gaps are left as they are; `notes` lists all of it.

    Errors: RecordingError, one sentence with file, row, column, value and the next step; IncompleteRecording, one of
    them, where columns, units or the radius have to be given.
    """
    refuse_unknown(more, Exported.__annotations__)
    said = (texts_of_channels("columns", columns), texts_of_channels("units", units))
    zero = texts_of_channels("zero", more.get("zero"))
    radius, sampling = text_or_number("radius", radius), text_or_number("sampling", more.get("sampling"))
    how = Choices(*said, radius, sampling, more.get("skip_rows"), zero=zero)
    return understand(path, how).recording


@dataclass(frozen=True)
class Understood:
    """A recording with how it was understood: the file, the piece of it, the table, the plan, and what came of it."""

    recording: Recording
    path: Path
    piece: Piece
    table: Table
    plan: Plan
    found: Interpreted


def understand(path: Path | str, how: Choices) -> Understood:
    """Return the recording in a file, or in a piece of it, and how it was understood. Errors: as `read_recording`."""
    said = (str(path), *replace(how, zero={}).words(inspecting=True))
    path, piece = split_piece(path)
    sidecar = read_sidecar(path, how.settings, piece.trial, piece.sheet)
    skip_rows = sidecar.skip_rows if how.skip_rows is None else how.skip_rows
    table = open_table(path, skip_rows, piece.sheet)
    settings = sidecar.overruled(how.columns, how.units, how.radius, how.sampling, how.zero)
    settings = replace(settings, part=settings.part or how.part)
    own = {f"columns.{name}" for name in how.columns} | {f"units.{name}" for name in how.units}
    own |= {"skip_rows"} if how.skip_rows is not None else set()
    kept = {what: file for what, file in sidecar.said_in.items() if what not in own}
    plan = plan_reading(Origin(path.name, said=said, kept=kept), table, settings, piece.trial)
    _refuse_too_large(path, table, len(plan.headers) + 1)
    piece = piece.within(how.start, how.stop).within(sidecar.start, sidecar.stop)
    found = interpret(plan, _read(table, plan, piece), sidecar.sources, piece)
    recording = _checked(found, plan, (sidecar.name or path.stem) + piece.suffix, path)
    said_above = table.sheet_of(plan.matches["force"].index) if isinstance(table, ExcelTable) else table
    provenance = tuple(getattr(said_above, "provenance", ()))
    if provenance:
        recording = replace(recording, provenance=provenance)
    return Understood(recording, path, piece, table, plan, found)


def _read(table: Table, plan: Plan, piece: Piece) -> Columns:
    """Return the columns of a plan; where not all can be read, those up to the last row of the piece, if it names its
    rows, or those of the piece alone."""
    try:
        return table.read(plan.wanted)
    except RecordingError:
        rows = piece.rows
        if rows is None or not isinstance(table, DelimitedTable):
            raise
        try:
            return table.read_rows(plan.wanted, 1, rows[1])  # what was recorded before the piece counts
        except RecordingError:
            return table.read_rows(plan.wanted, *rows)


def _recording_of(origin: Origin, table: Table, settings: Settings) -> Recording:
    plan = plan_reading(origin, table, settings)
    return _checked(interpret(plan, table.read(plan.wanted)), plan, origin.name, None)


def _checked(found: Interpreted, plan: Plan, name: str, source: Path | None) -> Recording:
    """Return the recording; a sample that cannot be is refused with its place in the file or table."""
    try:
        recording = Recording(
            name=name,
            **_arrays(found.values),
            source=source,
            notes=found.notes,
            timed=plan.timed,
            doubts=found.doubts.sentences,
            far_zero=found.doubts.far_zero,
            history=_history(found.before, name),
        )
    except SampleFault as fault:
        part = f"; if another test begins here, read one of them: {found.tests()}" if fault.anew else ""
        raise found.error(fault.index, fault.channel, fault.what + part) from None
    found.check_loading()
    return recording


def _history(before: Mapping[str, FloatArray], name: str) -> Recording | None:
    """Return what was recorded before a part of a file, None where that is nothing, or cannot be."""
    try:
        return Recording(name, **_arrays(before)) if len(before.get("time", ())) > 1 else None
    except RecordingError:
        return None


def _arrays(values: Mapping[str, FloatArray]) -> dict[str, Any]:
    """Return channels that were read, which nobody else has, under the names that a recording has for them."""
    return {"surface_radius" if name == "radius" else name: fix(column) for name, column in values.items()}


def _refuse_too_large(path: Path, table: Table, columns: int) -> None:
    needed, available = table.bytes_needed(columns), memory_available()
    if needed > available:
        size = readable_size(path.stat().st_size)
        raise RecordingError(
            f"{path.name}: has {size} and needs about {readable_size(needed)} of memory, of which "
            f"{readable_size(available)} are free; cut it into shorter recordings, or keep every tenth row"
        )
