"""What a dropped file was understood to be, as `tirelab inspect` says it, and what is guessed where it does not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..errors import TirelabError
from ..recordings.asking import IncompleteRecording
from ..recordings.channels import CHANNELS
from ..recordings.choices import Choices
from ..recordings.files import recording_files, why_no_recording
from ..recordings.formats import Table, open_table
from ..recordings.inspection import Inspection, inspect_recording
from ..recordings.metadata import read_sidecar
from ..recordings.origin import Origin
from ..recordings.pieces import split_piece
from ..recordings.reading_plan import plan_reading

CHANNEL_NAMES = tuple(channel.name for channel in CHANNELS)


@dataclass(frozen=True)
class Channel:
    """A channel with the column that it was read from, and that column's unit; both empty where there is none.

    values: from the least to the greatest; remark: of its step and its sign
    """

    channel: str
    required: bool
    column: str = ""
    unit: str = ""
    values: str = ""
    remark: str = ""


@dataclass(frozen=True)
class Understood:
    """A file as it was read.

    headers: of all its columns; channels: with the columns chosen; facts: table, samples, sampling, ... as texts
    notes: what reading did to the numbers, and what the file says above its table; doubts: what is doubtful of them
    problem: why it cannot be read, empty where it can; guess: columns, units and radius that may solve it
    """

    headers: tuple[str, ...]
    channels: tuple[Channel, ...]
    facts: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    problem: str = ""
    guess: Mapping[str, Any] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return asdict(self)


def understood(file: Path, name: str) -> Understood:
    """Return what is in a file with the settings beside it (`metadata.read_sidecar`).

    name: what the user calls it. Raises TirelabError, one sentence, where it is no recording at all; a table that may
    be one has a `problem` instead, which other settings may solve.
    """
    try:
        table = open_table(file)
    except TirelabError as error:
        raise TirelabError(_by_name(str(error), file, name)) from None
    headers = tuple(header.text for header in table.headers)
    (first, *others), _ = recording_files([file])
    try:
        found = inspect_recording(first, Choices())
    except IncompleteRecording as error:
        _refuse(error, file, name)
        asked = error.settings
        guess = {"columns": dict(asked.columns), "units": dict(asked.units), "radius": asked.radius or ""}
        problem = f"{_by_name(error.what, file, name)}; what may be meant is filled in below, check it"
        planned = _planned(first, table, asked.radius)
        return Understood(headers, planned, problem=problem, guess=guess)
    except TirelabError as error:
        _refuse(error, file, name)
        return Understood(headers, _planned(first, table), problem=_by_name(str(error), file, name))
    more = (("tests", f"{1 + len(others)} side by side, each a recording; of the first:"),) if others else ()
    # The page itself wrote the settings beside it.
    written = f"settings read from {file.with_suffix('.toml').name}"
    remarks = [_by_name(r, file, name) for r in found.remarks if r != written]
    notes = (*remarks, *(f"it says: {text}" for text in found.recording.provenance))
    doubts = tuple(_by_name(doubt, file, name) for doubt in found.recording.doubts)
    return Understood(headers, _channels(found, headers), (*more, *found.facts), notes, doubts)


def _refuse(error: TirelabError, file: Path, name: str) -> None:
    """Raise what `tirelab inspect` says, where no settings could make a recording of the file."""
    if why_no_recording(file) is not None:
        raise TirelabError(_by_name(str(error), file, name)) from None


def _channels(found: Inspection, headers: tuple[str, ...]) -> tuple[Channel, ...]:
    rows = {row.channel: row for row in found.channels}
    listed = []
    for channel in CHANNELS:
        row = rows.get(channel.name)
        if row is None:
            listed.append(Channel(channel.name, channel.required))
            continue
        # the column is told with its number, which the page's list of headers has by its order
        column = next((h for i, h in enumerate(headers, 1) if row.column == f"{h} (#{i})"), "")
        remark = ", ".join(filter(None, (f"step {row.step}" if row.step else "", row.remark)))
        listed.append(Channel(channel.name, channel.required, column, row.unit, row.span, remark))
    return tuple(listed)


def _planned(file: Path, table: Table, radius: str | float | None = None) -> tuple[Channel, ...]:
    """Return the channels of a table that cannot be read yet, as far as its columns tell with a guessed radius."""
    path, piece = split_piece(file)
    try:
        settings = read_sidecar(path, trial=piece.trial).overruled(None, None, radius)
        plan = plan_reading(Origin(path.name), table, settings, piece.trial)
    except TirelabError:
        return tuple(Channel(c.name, c.required) for c in CHANNELS)
    chosen = {
        channel: (header.text, plan.conversions[channel].unit) for channel, header in plan.headers.items()
    }
    return tuple(Channel(c.name, c.required, *chosen.get(c.name, ())) for c in CHANNELS)


def _by_name(sentence: str, file: Path, name: str) -> str:
    """Return a sentence in which the file, and that of its settings, have the user's name for it."""
    settings = file.with_suffix(".toml").name
    return (
        sentence.replace(str(file), name)
        .replace(file.name, name)
        .replace(settings, f"the settings of {name}")
    )
