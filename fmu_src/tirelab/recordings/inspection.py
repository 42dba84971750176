"""What was understood of a file: its table, columns, units, sampling, signs, zero and steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .channels import UNIT_OF
from .choices import Choices
from .description import surface_text
from .formats.delimited import DelimitedTable
from .formats.excel import ExcelTable
from .matching import recognised
from .plausibility import force_begins
from .recording import Recording, Understood, understand
from .zero import Zero

FloatArray = NDArray[np.float64]

LOOKED_AT = 20_000
"""Most samples that are searched for the step of a gauge."""

ON_GRID, MOST_STEPS = 0.1, 8.0
"""Differences of up to so many steps lie on the grid of a converter, or of the digits written, within this part of a
step of its multiples: of readings on no grid a fifth do."""

SHOWN_IN = {"deflection": ("mm", 1e3), "radius": ("cm", 1e2), "pressure": ("kPa", 1e-3)}
"""Units in which channels are shown, where they are not SI."""

GIVEN = "given"
"""What stands for the column of a channel that the user gave as one value."""

SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars"}


@dataclass(frozen=True)
class ChannelFound:
    """One channel as it was understood, in words.

    column: its name in the file; unit: in which it was read; span: least and greatest value; step: between readings, ""
    where they lie on no grid; remark: of its sign; zero: what was subtracted
    """

    channel: str
    column: str
    unit: str
    span: str
    step: str
    remark: str
    zero: str = ""


@dataclass(frozen=True)
class Inspection:
    """What was understood of one recording: facts as pairs of a name and a text, channels, doubts, notes, provenance.

    key: the name of the file as `recording.toml` calls it, with @trial2 or @SHEET where that is one; settings: what is
    written there so that the file is read the same again
    """

    key: str
    path: Path
    recording: Recording
    facts: tuple[tuple[str, str], ...]
    channels: tuple[ChannelFound, ...]
    settings: Mapping[str, Any]

    @property
    def remarks(self) -> tuple[str, ...]:
        """What reading did to the numbers, without what is doubtful of them."""
        return tuple(note for note in self.recording.notes if not note.startswith("doubtful: "))

    def to_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "file": str(self.path),
            "name": self.recording.name,
            "channels": [asdict(channel) for channel in self.channels],
            "facts": dict(self.facts),
            "says": list(self.recording.provenance),
            "notes": list(self.remarks),
            "doubts": list(self.recording.doubts),
            "settings": dict(self.settings),
        }


def inspect_recording(path: Path | str, how: Choices) -> Inspection:
    """Return what is understood of a file, or a piece of one. Errors: as `read_recording`."""
    found = understand(path, how)
    key = found.path.name + found.piece.part
    return Inspection(
        key,
        found.path,
        found.recording,
        tuple(_facts(found)),
        tuple(_channels(found)),
        {**_settings(found), **{k: v for k, v in (("from", how.start), ("to", how.stop)) if v}},
    )


def step_of(values: FloatArray) -> float | None:
    """Return the step between readings, in their unit: the least difference, where all others are multiples of it.

    None where the readings lie on no grid, or there are fewer than three different ones.
    """
    distinct = np.unique(values[: max(1, LOOKED_AT)])
    if len(distinct) < 3:
        return None
    differences = np.diff(distinct)
    scale = float(np.abs(distinct).max())
    differences = differences[differences > 1e-12 * scale]
    if not len(differences):
        return None
    step = float(differences.min())
    step = float(np.median(differences[differences < 1.5 * step]))
    # of many steps at once the error of the step itself adds up
    multiples = differences[differences < MOST_STEPS * step] / step
    on_grid = np.abs(multiples - np.round(multiples)) < ON_GRID
    return step if len(multiples) > 0.5 * len(differences) and np.mean(on_grid) > 0.95 else None


def _facts(found: Understood) -> list[tuple[str, str]]:
    recording = found.recording
    part = found.plan.settings.part
    zero = force_begins(recording.deflection, recording.force, recording.surface_radius)
    begins = "not seen in these readings" if zero is None else _begins_text(zero)
    return [
        ("table", _table_text(found)),
        ("samples", f"{len(recording)}"),
        ("sampling", _sampling_text(recording)),
        ("surface", "none: a part, not a tire" if part else surface_text(recording.surface_radius)),
        ("zero", begins),
    ]


def _begins_text(zero: Zero) -> str:
    if zero.off and not zero.seen:
        return f"not seen: {zero.sentence()}"
    return f"the force begins at {zero.shown}{'' if zero.seen else ', extrapolated'}"


def _table_text(found: Understood) -> str:
    if not isinstance(found.table, DelimitedTable):
        kind = found.path.suffix.lstrip(".")
        if not isinstance(found.table, ExcelTable):
            return kind
        sheet = found.table.sheet_of(found.plan.matches["force"].index)
        where = (
            f"names in row {sheet.header_row}" if sheet.header_row else f"numbers in row {sheet.first_row}"
        )
        return f"{kind}, sheet {sheet.title!r}, {where}"
    layout = found.table.layout
    named = "names" if layout.lines_before_data >= layout.table_line else "numbers"
    text = f"{named} in row {layout.table_line}"
    if named == "names":
        text += f", numbers from row {layout.lines_before_data + 1}"
    decimal = "commas" if layout.style.decimal_comma else "points"
    between = "spaces" if layout.spaced else SEPARATORS[layout.separator]
    marks = f"; {between} between columns, decimal {decimal}"
    thousands = f", {layout.style.thousands!r} between thousands" if layout.style.thousands else ""
    encoding = "" if layout.encoding == "utf-8" else f"; {layout.encoding}"
    trials = f"; {found.plan.trials} trials side by side" if found.plan.trials > 1 else ""
    return text + marks + thousands + encoding + trials


def _sampling_text(recording: Recording) -> str:
    if not recording.timed:
        return "time was not measured"
    interval = recording.sampling_interval
    steps = np.diff(recording.time)
    even = (
        "even" if steps.max() < 1.01 * steps.min() else f"steps of {steps.min():.4g} to {steps.max():.4g} s"
    )
    return f"{1.0 / interval:.6g} Hz ({interval:.4g} s, {even}) over {recording.duration:.6g} s"


def _channels(found: Understood) -> list[ChannelFound]:
    rows = []
    for name, values in found.recording.channels():
        if name == "radius" and found.plan.settings.part and "radius" not in found.plan.matches:
            continue
        unit, factor = SHOWN_IN.get(name, (UNIT_OF[name], 1.0))
        finite = values[np.isfinite(values)] * factor
        span = _span(finite, unit, flat=len(finite) < len(values))
        step = None if name in ("time", "radius") or not len(finite) else step_of(finite)
        header, made = (
            found.plan.headers.get(name),
            "made up" if name == "time" and not found.recording.timed else GIVEN,
        )
        match = found.plan.matches.get(name)
        rows.append(
            ChannelFound(
                name,
                f"{header.text} (#{match.index + 1})" if header and match else made,
                found.found.units.get(name, ""),
                span,
                "" if step is None else f"{step:.3g} {unit}",
                "turned in sign" if name in found.found.counted.gauges.turned else "",
                found.plan.settings.zero.get(name, ""),
            )
        )
    return rows


def _span(finite: FloatArray, unit: str, flat: bool) -> str:
    """Return the range of values as text; flat: whether there are others, without end."""
    if not len(finite):
        return "flat"
    low, high = f"{finite.min():.5g}", f"{finite.max():.5g}"
    return f"{low}{f' to {high}' if high != low else ''} {unit}{', flat' if flat else ''}"


def _settings(found: Understood) -> dict[str, Any]:
    """Return the settings that read the file the same again, and for people what stands above the table."""
    plan, recording = found.plan, found.recording
    settings: dict[str, Any] = {}
    if isinstance(found.table, DelimitedTable) and found.table.layout.table_line > 1:
        layout = found.table.layout
        # names in a comment are found only from the top of the file
        if layout.lines_before_data >= layout.table_line:
            settings["skip_rows"] = layout.table_line - 1
    columns = {}
    for name, match in plan.matches.items():
        sign = match.sign if match.sign else -1 if name in found.found.counted.gauges.turned else 0
        if name in ("deflection", "force") and not sign:
            sign = 1
        columns[name] = {1: "+", -1: "-", 0: ""}[sign] + plan.names[name]
    columns |= {name: "" for name, text in plan.settings.columns.items() if not text.strip()}
    if not recording.timed:
        columns["time"] = ""
    if plan.radius is not None and "radius" in recognised(found.table.headers, {}):
        columns["radius"] = ""  # or the column would go over the radius that was given
    settings["columns"] = columns
    settings["units"] = dict(found.found.units)
    if plan.settings.zero:
        settings["zero"] = dict(plan.settings.zero)
    for name, value in plan.constants.items():
        settings[name] = f"{value!r} {UNIT_OF[name]}"
    if plan.settings.part:
        settings["part"] = True
    elif plan.radius is not None:
        settings["radius"] = "flat" if np.isinf(plan.radius) else f"{plan.radius!r} m"
    if plan.interval is not None and recording.timed:
        settings["sampling"] = f"{plan.interval!r} s"
    if recording.provenance:
        settings["provenance"] = list(recording.provenance)
    if recording.doubts:
        settings["doubtful"] = list(recording.doubts)
    return settings
