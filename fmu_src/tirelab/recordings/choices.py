"""What a user chooses of how recordings are read; loads nothing, since the commands state it before they read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path


@dataclass(frozen=True)
class Choices:
    """The columns, units and surface radius of recordings, where these differ from what the files say.

    columns: channel -> column; units: channel -> unit; radius: "flat", "25.4cm" or a number [m], None: as in the file;
    sampling: "10 Hz"; skip_rows: above the table; each as for `read_recording`. start, stop: of the part that is read
    of every file, "10s" or a row, where the file's name does not say it; settings: a file that is read instead of the
    recording.toml beside each recording. part: a damper or a bushing, and no tire: it has no ground to be pressed on.
    zero: channel -> what its gauge reads when nothing is loaded, "30 mm", which is subtracted.
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
    zero: Mapping[str, str] = field(default_factory=dict)

    def words(self, inspecting: bool = False) -> list[str]:
        """Return the words of a command line that read recordings in the same way; inspecting: of `tirelab inspect`."""
        from .channels import assignments_text

        words = []
        for option, values in (("--columns", self.columns), ("--units", self.units)):
            if values:
                words += [option, assignments_text(values)]
        if self.radius is not None:
            words += ["--radius", self.radius if isinstance(self.radius, str) else _with_unit(self.radius)]
        elif self.part:
            # not every command has a word for a part
            words += ["--part"] if inspecting else ["--radius", "flat"]
        if self.sampling is not None:
            sampling = self.sampling if isinstance(self.sampling, str) else f"{self.sampling!r}Hz"
            words += ["--sampling", sampling]
        words += [word for name, text in self.zero.items() for word in ("--zero", f"{name}={text}")]
        if self.skip_rows is not None:
            words += ["--skip-rows", str(self.skip_rows)]
        words += ["--from", self.start] if self.start else []
        words += ["--to", self.stop] if self.stop else []
        words += ["--settings", str(self.settings)] if self.settings is not None else []
        return words


def _with_unit(radius: float) -> str:
    return f"{float(radius)!r}m" if isfinite(radius) else "flat"
