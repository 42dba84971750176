"""What is to be read: a unit that is none is refused, and the user is not told to give what was given."""

from pathlib import Path

import numpy as np
import pytest
from house_form import loading, write_rows
from tirelab.recordings.formats import RecordingError
from tirelab.recordings.recording import read_recording

HEADER = "time [s],deflection [cm],force [N]"


def test_what_a_load_cell_bears_is_no_calibration(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force (500 N)", time, deflection, force)
    recording = read_recording(path, radius="flat", units={"force": "N"})
    np.testing.assert_allclose(recording.force, force, rtol=1e-5, atol=1e-3)
    with pytest.raises(RecordingError, match=r"unknown unit '500 N' of force.* give it: --units force=UNIT"):
        read_recording(path, radius="flat")


def test_who_has_given_a_unit_is_not_told_to_give_one(tmp_path: Path) -> None:
    path = write_rows(tmp_path / "a.csv", HEADER, *loading())
    with pytest.raises(RecordingError, match="'V' is not a unit of force") as refused:
        read_recording(path, radius="flat", units={"force": "V"})
    assert "give it" not in str(refused.value)
