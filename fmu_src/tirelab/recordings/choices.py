"""What a user chooses of how recordings are read; loads nothing, since the commands state it before they read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Choices:
    """The columns, units and surface radius of recordings, where these differ from what the files say.

    columns: channel -> column; units: channel -> unit; radius: "flat", "25.4cm" or a number [m], None: as in the file;
    sampling: "10 Hz"; skip_rows: above the table; each as for `read_recording`. start, stop: of the part that is read
    of every file, "10s" or a row, where the file's name does not say it; settings: a file that is read instead of the
    recording.toml beside each recording. part: a damper or a bushing, and no tire: it has no ground to be pressed on.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    radius: str | float | None = None
    sampling: str | float | None = None
    skip_rows: int | None = None
    start: str = ""
    stop: str = ""
    settings: Path | None = None
    part: bool = False
