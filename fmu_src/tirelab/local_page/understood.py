"""What a dropped file was understood to be: which column is which, in which unit, and what was done to the numbers."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..errors import TirelabError
from ..recordings.channels import CHANNELS
from ..recordings.description import facts
from ..recordings.files import why_no_recording
from ..recordings.formats import open_table
from ..recordings.interpretation import plan_reading
from ..recordings.metadata import read_sidecar
from ..recordings.origin import Origin
from ..recordings.recording import read_recording

CHANNEL_NAMES = tuple(channel.name for channel in CHANNELS)


@dataclass(frozen=True)
class Channel:
    """A channel with the column that it was read from, and that column's unit; both empty where there is none."""

    channel: str
    required: bool
    column: str = ""
    unit: str = ""


@dataclass(frozen=True)
class Understood:
    """A file as it was read.

    headers: of all its columns; channels: with the columns chosen; facts: samples, duration, ... as texts; notes: what
    reading did to the numbers; problem: why it cannot be read, empty where it can
    """

    headers: tuple[str, ...]
    channels: tuple[Channel, ...]
    facts: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = ()
    problem: str = ""

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
    if (reason := why_no_recording(file)) is not None:
        raise TirelabError(f"{name} is no recording: {reason}")
    headers = tuple(header.text for header in table.headers)
    nothing = tuple(Channel(c.name, c.required) for c in CHANNELS)
    try:
        plan = plan_reading(Origin(name), table, read_sidecar(file).overruled(None, None, None))
        chosen = {
            channel: (header.text, plan.conversions[channel].unit) for channel, header in plan.headers.items()
        }
        channels = tuple(Channel(c.name, c.required, *chosen.get(c.name, ())) for c in CHANNELS)
    except TirelabError as error:
        return Understood(headers, nothing, problem=_by_name(str(error), file, name))
    try:
        recording = read_recording(file)
    except TirelabError as error:
        return Understood(headers, channels, problem=_by_name(str(error), file, name))
    told = facts(recording.time, recording.deflection, recording.surface_radius, recording.force)
    return Understood(headers, channels, told, recording.notes)


def _by_name(sentence: str, file: Path, name: str) -> str:
    """Return a sentence in which the file has the user's name for it."""
    return sentence.replace(str(file), name).replace(file.name, name)
