"""How a user wants recordings to be read, as one value for all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
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
