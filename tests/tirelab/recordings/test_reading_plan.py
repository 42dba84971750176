"""What is to be read: a unit that is none is refused, and the user is not told to give what was given."""

from pathlib import Path

import numpy as np
import pytest
from house_form import loading, write_rows
from tirelab.recordings.formats import RecordingError
from tirelab.recordings.reading import Reading
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


@pytest.mark.parametrize("symbol", ["v", "p", "T", "R"])
def test_a_symbol_without_a_unit_is_no_channel_that_a_part_needs(tmp_path: Path, symbol: str) -> None:
    """A table of `x, v, F`: the rate of the deflection is not the speed of a ride, and was asked for its unit."""
    time, deflection, force = loading()
    header = f"time [s],x [cm],{symbol},F [N]"
    path = write_rows(tmp_path / "a.csv", header, time, deflection, np.gradient(deflection, time), force)
    found = Reading(part=True)(path)
    assert [name for name, _ in found.channels()] == ["time", "deflection", "radius", "force"]
    (note,) = (note for note in found.notes if repr(symbol) in note)
    assert note.startswith(f"column '{symbol}' not read as ")
    assert ": no unit; " in note


def test_a_speed_that_is_named_or_has_a_unit_is_read(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(
        tmp_path / "a.csv", "time [s],x [cm],v,F [N]", time, deflection, 0.0 * time + 3.0, force
    )
    found = read_recording(path, radius="flat", units={"speed": "m/s"})
    assert found.speed is not None
    assert found.speed[0] == 3.0
    with pytest.raises(RecordingError, match="column 'v': has no unit"):
        read_recording(path, radius="flat", columns={"speed": "v"})


def test_a_radius_without_a_unit_is_asked_for_of_a_tire(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(
        tmp_path / "a.csv", "time [s],x [cm],R,F [N]", time, deflection, 0.0 * time + 25.4, force
    )
    with pytest.raises(RecordingError, match="column 'R': has no unit"):
        read_recording(path)
