"""One recording that the tests of the formats write in each of them, and check as it was read."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tirelab.recordings.recording import Recording, RecordingError, read_recording

SAMPLES = 200
TIME = np.arange(SAMPLES) / 100.0
DEFLECTION = 12.5 * (1.0 - np.cos(2.0 * np.pi * TIME))
FORCE = 0.5509 * (DEFLECTION / 10.0) ** 1.422
HEADERS = ("time [s]", "deflection [mm]", "force [kN]")
COLUMNS = dict(zip(HEADERS, (TIME, DEFLECTION, FORCE), strict=True))
UNITS = {"time": "s", "deflection": "mm", "force": "kN"}


def assert_the_recording(recording: Recording, *notes: str, digits: float = 3e-16) -> None:
    np.testing.assert_array_equal(recording.time, TIME)
    # Written exactly in mm and kN: one rounding in each conversion is what may differ.
    np.testing.assert_allclose(recording.deflection, DEFLECTION / 1000.0, rtol=digits)
    np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=digits)
    assert recording.notes == (*notes, "surface radius flat as given")


def refusal(path: Path, **options: Any) -> str:
    with pytest.raises(RecordingError) as caught:
        read_recording(path, **{"radius": "flat", **options})
    assert "\n" not in str(caught.value)
    return str(caught.value)
