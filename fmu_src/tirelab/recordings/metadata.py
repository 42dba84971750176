"""What is known of a recording beside its numbers, in a small TOML file next to it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from radialtire import CHANNELS

from .channels import known_channel
from .formats import RecordingError
from .pieces import Piece
from .toml_text import parse_toml
from .units import with_likely_unit

FOLDER_SIDECAR = "recording.toml"
"""The sidecar of every recording in its folder."""

_CONSTANT = {channel.name: (f"{channel.usual:.4g} {channel.unit}", channel.unit) for channel in CHANNELS}
"""Channels of which a file may state one value for the whole recording, with an example and its SI unit."""

_EXAMPLES = {
    "name": ("front, 2 bar", ""),
    "radius": ("25.4 cm", "m"),
    "sampling": ("10 Hz", ""),
    "from": ("10 s", ""),
    "to": ("20 s", ""),
    "zero.deflection": ("30 mm", ""),
    "zero.force": ("30 N", ""),
    **_CONSTANT,
}
"""Values as they are written; with the SI unit where a number may be of several units, and its size tells which."""

_TEXTS = ("radius", "sampling", "from", "to", "name", *_CONSTANT)
_TABLES = ("columns", "units", "zero")
_KEYS = (*_TEXTS, *_TABLES, "skip_rows", "part", "files")
_SAID = ("table", "provenance", "doubtful")
"""Keys that `inspect` writes for the reader of the file alone."""


@dataclass(frozen=True)
class Sidecar:
    """The radius, the columns and the units that sidecars state, and where each came from.

    said_in: "columns.force", "units.force" or "skip_rows" -> the file that says it
    """

    radius: str | None = None
    radius_source: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    sources: tuple[str, ...] = ()
    sampling: str | None = None
    skip_rows: int | None = None
    start: str = ""
    stop: str = ""
    constants: Mapping[str, str] = field(default_factory=dict)
    part: bool = False
    zero: Mapping[str, str] = field(default_factory=dict)
    name: str = ""
    said_in: Mapping[str, str] = field(default_factory=dict)

    def overruled(
        self,
        columns: Mapping[str, str] | None,
        units: Mapping[str, str] | None,
        radius: str | float | None,
        sampling: str | float | None = None,
        zero: Mapping[str, str] | None = None,
    ) -> Settings:
        """Return the settings where the user's go over these."""
        return Settings(
            {**self.columns, **(columns or {})},
            {**self.units, **(units or {})},
            radius,
            self.radius,
            self.radius_source,
            self.sampling if sampling is None else sampling,
            self.constants,
            self.part,
            {**self.zero, **(zero or {})},
        )

    def below(self, over: Sidecar) -> Sidecar:
        """Return this sidecar with what another says put over it."""
        return Sidecar(
            radius=over.radius or self.radius,
            radius_source=over.radius_source if over.radius else self.radius_source,
            columns={**self.columns, **over.columns},
            units={**self.units, **over.units},
            sources=(*self.sources, *(s for s in over.sources if s not in self.sources)),
            sampling=over.sampling or self.sampling,
            skip_rows=self.skip_rows if over.skip_rows is None else over.skip_rows,
            start=over.start or self.start,
            stop=over.stop or self.stop,
            constants={**self.constants, **over.constants},
            part=self.part or over.part,
            zero={**self.zero, **over.zero},
            name=over.name or self.name,
            said_in={**self.said_in, **over.said_in},
        )


@dataclass(frozen=True)
class Settings:
    """What is known beside the table: columns and units by channel, and the radius.

    radius: as the user gave it; radius_in_file: as `radius_source` states it, over which the former goes
    sampling: rate or interval of the samples, where the table has no time; constants: the one value of a channel that
    no column holds, such as "2.5 bar" of the pressure; part: of a part that has no ground, and not of a tire
    zero: what a gauge reads when nothing is loaded, such as "30 mm" of the deflection
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    radius: str | float | None = None
    radius_in_file: str | None = None
    radius_source: str = ""
    sampling: str | float | None = None
    constants: Mapping[str, str] = field(default_factory=dict)
    part: bool = False
    zero: Mapping[str, str] = field(default_factory=dict)


def read_sidecar(path: Path, named: Path | None = None, trial: int | None = None, sheet: str = "") -> Sidecar:
    """The sidecar of a recording: `recording.toml` in its folder, and over it one named like the recording.

    For `flat.csv` that is `flat.toml`. Keys: `radius = "25.4 cm"` (or "flat"), `sampling = "10 Hz"`, `from`, `to`,
    `skip_rows = 3`, `name = "front, 2 bar"` of one recording, as messages and the report call it, `part = true` of a
    damper or a bushing, `pressure = "2.5 bar"` and `temperature = "21 degC"` where no column holds them, and the tables
    `[columns]`, `[units]` and `[zero]`, which say per channel what `--columns`, `--units` and `--zero` say.
    The same keys below `[files."flat.csv"]` hold for that file alone. Without a sidecar, an empty one.

    named: a file of settings that is read instead of those beside the recording; trial, sheet: of tests side by side
    and of a workbook, each of which may have a table of its own, `[files."flat.csv@trial2"]`
    Errors: RecordingError for TOML that does not parse, an unknown key, or a value that is not text.
    """
    if named is not None and not named.is_file():
        raise RecordingError(f"{named}: there is no such file of settings; check the path")
    beside = (path.with_name(FOLDER_SIDECAR), path.with_suffix(".toml"))
    found = Sidecar()
    for file in dict.fromkeys(beside if named is None else (named,)):
        if file.is_file():
            content = _content(file)
            if "name" in content and file != beside[1]:
                raise RecordingError(
                    f'{file.name}: a name is of one recording; write it below [files."{path.name}"]'
                )
            for part in _parts(content, path.name, Piece(trial, sheet=sheet).part):
                found = found.below(_sidecar(part, file.name))
    return found


def _parts(content: Mapping[str, Any], name: str, part: str) -> list[Mapping[str, Any]]:
    """Return what a file of settings says of every recording, and of one of them: nothing where that is all others."""
    files = content.get("files", {})
    own = [files[key] for key in dict.fromkeys((name, name + part)) if key in files]
    common = {key: value for key, value in content.items() if key != "files"}
    return [*([common] if common else []), *own]


def _sidecar(content: Mapping[str, Any], source: str) -> Sidecar:
    radius = content.get("radius")
    return Sidecar(
        radius=radius,
        radius_source=source if radius else "",
        columns=content.get("columns", {}),
        units=content.get("units", {}),
        sources=(source,),
        sampling=content.get("sampling"),
        skip_rows=content.get("skip_rows"),
        start=content.get("from", ""),
        stop=content.get("to", ""),
        constants={name: content[name] for name in _CONSTANT if name in content},
        part=content.get("part", False),
        zero=content.get("zero", {}),
        name=content.get("name", "").strip(),
        said_in=dict.fromkeys(
            [
                *(key for key in ("skip_rows",) if key in content),
                *(f"{table}.{name}" for table in ("columns", "units") for name in content.get(table, {})),
            ],
            source,
        ),
    )


def _content(file: Path) -> dict[str, Any]:
    try:
        content = parse_toml(file.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise RecordingError(
            f'{file.name} is not TOML ({error}); write for instance radius = "25.4 cm"'
        ) from None
    _check(file, content, "")
    files = content.get("files", {})
    if not isinstance(files, dict) or not all(isinstance(part, dict) for part in files.values()):
        raise RecordingError(f'{file.name}: files is a table; write [files."NAME.csv"] and lines below it')
    for name, part in files.items():
        _check(file, part, f'files."{name}".')
    return content


def _check(file: Path, content: Mapping[str, Any], inside: str) -> None:
    for key, value in content.items():
        if key in _SAID and inside:
            continue
        if key not in _KEYS or (inside and key == "files"):
            keys = ", ".join(key for key in _KEYS if not (inside and key == "files"))
            raise RecordingError(f"{file.name}: {inside + key!r} is not known here; the keys are {keys}")
        if key in _TABLES:
            if not isinstance(value, dict):
                raise RecordingError(f"{file.name}: {key} is a table; write [{key}] and lines below it")
            for channel, text in value.items():
                known_channel(channel, f"{file.name}, [{key}]")
                _as_text(file, f"{key}.{channel}", text)
        elif key == "skip_rows":
            if not isinstance(value, int) or isinstance(value, bool) or value < 0:
                raise RecordingError(
                    f"{file.name}: skip_rows is {value!r}; write the number of rows above the table"
                )
        elif key == "part":
            if not isinstance(value, bool):
                raise RecordingError(f"{file.name}: part is {value!r}; write part = true, or leave it out")
        elif key in _TEXTS:
            _as_text(file, key, value)


def _as_text(file: Path, key: str, value: object) -> None:
    if not isinstance(value, str) or (not value.strip() and not key.startswith("columns.")):
        raise RecordingError(
            f'{file.name}: {key} is {value!r}, not text; write {key} = "{_example(key, value)}"'
        )


def _example(key: str, value: object) -> str:
    """Return what may stand for a key: a number that was written with its likely unit, or an example."""
    text, si = _EXAMPLES.get(key, ("...", ""))
    unit = text.split(" ")[1:]
    if not isinstance(value, (int, float)) or isinstance(value, bool) or len(unit) != 1:
        return text
    if not 0.0 < abs(value) < math.inf:
        return text
    return with_likely_unit(value, text, si) if si else f"{value:.15g} {unit[0]}"
