"""How a user wants recordings to be read, as one value for all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from .choices import Choices

if TYPE_CHECKING:
    from .recording import Recording


@dataclass(frozen=True)
class Reading(Choices):
    """How recordings are to be read; called with a file, or a piece of one, it returns its recording."""

    def __call__(self, file: Path | str) -> Recording:
        """Return the recording in a file. Errors: RecordingError, see `read_recording`."""
        # here, since the command line states a reading before it loads the readers
        from .recording import understand

        return understand(file, self).recording

    def of_part(self) -> Reading:
        """Return how recordings of a part are read: a damper or a bushing has no ground, so none is asked for."""
        return replace(self, part=True)

    def words(self) -> list[str]:
        """Return the words of a command line that read recordings in the same way."""
        from .channels import assignments_text

        words = []
        for option, values in (("--columns", self.columns), ("--units", self.units)):
            if values:
                words += [option, assignments_text(values)]
        if self.radius is not None:
            words += ["--radius", self.radius if isinstance(self.radius, str) else _with_unit(self.radius)]
        elif self.part:
            words += ["--radius", "flat"]  # not every command has a word for a part
        if self.sampling is not None:
            sampling = self.sampling if isinstance(self.sampling, str) else f"{self.sampling!r}Hz"
            words += ["--sampling", sampling]
        if self.skip_rows is not None:
            words += ["--skip-rows", str(self.skip_rows)]
        words += ["--from", self.start] if self.start else []
        words += ["--to", self.stop] if self.stop else []
        words += ["--settings", str(self.settings)] if self.settings is not None else []
        return words


def _with_unit(radius: float) -> str:
    return f"{float(radius)!r}m" if isfinite(radius) else "flat"
