"""How a user wants recordings to be read, as one value for all of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .recording import Recording


@dataclass(frozen=True)
class Reading:
    """The columns, units and surface radius of recordings, where these differ from what the files say.

    columns: channel -> column; units: channel -> unit; radius: "flat", "25.4cm" or a number [m], None: as in the file;
    each as for `read_recording`. Called with a file it returns its recording.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    radius: str | float | None = None

    def __call__(self, file: Path | str) -> Recording:
        """Return the recording in a file. Errors: RecordingError, see `read_recording`."""
        # here, since the command line states a reading before it loads the readers
        from .recording import read_recording

        return read_recording(file, columns=self.columns, radius=self.radius, units=self.units)

    def words(self) -> list[str]:
        """Return the words of a command line that read recordings in the same way."""
        from .channels import assignments_text

        words = []
        for option, values in (("--columns", self.columns), ("--units", self.units)):
            if values:
                words += [option, assignments_text(values)]
        if self.radius is not None:
            words += ["--radius", self.radius if isinstance(self.radius, str) else _with_unit(self.radius)]
        return words


def _with_unit(radius: float) -> str:
    return f"{float(radius)!r}m" if isfinite(radius) else "flat"
