"""What is known of a recording beside its numbers, in a small TOML file next to it."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .channels import known_channel
from .formats import RecordingError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FOLDER_SIDECAR = "recording.toml"
"""The sidecar of every recording in its folder."""

_KEYS = ("radius", "columns", "units")


@dataclass(frozen=True)
class Sidecar:
    """The radius, the columns and the units that sidecars state, and where each came from."""

    radius: str | None = None
    radius_source: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    sources: tuple[str, ...] = ()

    def overruled(
        self,
        columns: Mapping[str, str] | None,
        units: Mapping[str, str] | None,
        radius: str | float | None,
    ) -> Settings:
        """Return the settings where the user's go over these."""
        return Settings(
            {**self.columns, **(columns or {})},
            {**self.units, **(units or {})},
            radius,
            self.radius,
            self.radius_source,
        )


@dataclass(frozen=True)
class Settings:
    """What is known beside the table: columns and units by channel, and the radius.

    radius: as the user gave it; radius_in_file: as `radius_source` states it, over which the former goes
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    radius: str | float | None = None
    radius_in_file: str | None = None
    radius_source: str = ""


def read_sidecar(path: Path) -> Sidecar:
    """The sidecar of a recording: `recording.toml` in its folder, and over it one named like the recording.

    For `flat.csv` that is `flat.toml`. Keys: `radius = "25.4 cm"` (or "flat"), and the tables `[columns]`
    and `[units]`, which say per channel what `--columns` and `--units` say. Without a sidecar, an empty one.

    Errors: RecordingError for TOML that does not parse, an unknown key, or a value that is not text.
    """
    found = Sidecar()
    for file in (path.with_name(FOLDER_SIDECAR), path.with_suffix(".toml")):
        if not file.is_file():
            continue
        if file.name in found.sources:
            continue
        content = _content(file)
        radius = content.get("radius")
        found = Sidecar(
            radius=radius or found.radius,
            radius_source=file.name if radius else found.radius_source,
            columns={**found.columns, **content.get("columns", {})},
            units={**found.units, **content.get("units", {})},
            sources=(*found.sources, file.name),
        )
    return found


def _content(file: Path) -> dict[str, Any]:
    try:
        content: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise RecordingError(
            f'{file.name}: is not TOML ({error}); write for instance radius = "25.4 cm"'
        ) from None
    for key, value in content.items():
        if key not in _KEYS:
            raise RecordingError(f"{file.name}: {key!r} is not known here; the keys are {', '.join(_KEYS)}")
        if key in ("columns", "units"):
            if not isinstance(value, dict):
                raise RecordingError(f"{file.name}: {key} is a table; write [{key}] and lines below it")
            for channel, text in value.items():
                known_channel(channel, f"{file.name}, [{key}]")
                _as_text(file, f"{key}.{channel}", text)
        else:
            _as_text(file, key, value)
    return dict(content)


def _as_text(file: Path, key: str, value: object) -> None:
    if not isinstance(value, str) or (not value.strip() and not key.startswith("columns.")):
        advice = 'radius = "25.4 cm"' if key == "radius" else f'{key} = "..."'
        raise RecordingError(f"{file.name}: {key} is {value!r}, not text; write {advice}")
