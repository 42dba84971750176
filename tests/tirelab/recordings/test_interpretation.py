"""The order of the rows and the clock: what runs backwards, and what passes midnight, is read and said."""

from pathlib import Path

import numpy as np
from house_form import loading, write_rows
from tirelab.recordings.recording import read_recording

HEADER = "time [s],deflection [cm],force [N]"


def test_time_that_falls_is_read_from_the_last_row_to_the_first(tmp_path: Path) -> None:
    time, deflection, force = loading()
    columns = [column[::-1] for column in (time, deflection + 0.01 * time, force)]
    path = write_rows(tmp_path / "a.csv", HEADER, *columns)
    recording = read_recording(path, radius="flat")
    np.testing.assert_allclose(recording.time, time)
    np.testing.assert_allclose(recording.deflection, (deflection + 0.01 * time) / 100.0, rtol=1e-5)
    assert "time falls from row to row: the rows read from the last to the first" in recording.notes
    # rows are those of the file: the first below the header is the last in time
    np.testing.assert_allclose(read_recording(f"{path}@2:11", radius="flat").time, time[-10:])
    np.testing.assert_allclose(read_recording(f"{path}@0s:1s", radius="flat").time, time[:5])


def test_a_clock_without_a_date_passes_midnight(tmp_path: Path) -> None:
    time, deflection, force = loading()
    seconds = (86_390.0 + time) % 86_400.0
    clock = [f"{int(s // 3600):02}:{int(s // 60) % 60:02}:{s % 60:06.3f}" for s in seconds]
    rows = [f"{c};{x:.6g};{f:.6g}" for c, x, f in zip(clock, deflection, force, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Zeit;Weg (cm);Kraft (N)", *rows]) + "\n", encoding="utf-8")
    recording = read_recording(path, radius="flat")
    np.testing.assert_allclose(recording.time, time, atol=1e-9)
    # 10 s of 5 Hz before midnight: rows 2 to 51
    assert "the clock passes midnight at row 52: a day added from there on" in recording.notes


def test_a_column_in_volts_is_read_by_its_calibration_and_settings_keep_it(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(
        tmp_path / "a.csv", "time [s],deflection [cm],force [V]", time, deflection, force / 250.0
    )
    recording = read_recording(path, radius="flat", units={"force": "250 N"})
    np.testing.assert_allclose(recording.force, force, rtol=1e-5, atol=1e-3)
    assert "force read in 250 N as given, not in V" in recording.notes
    (tmp_path / "recording.toml").write_text('radius = "flat"\n[units]\nforce = "250 N"\n', encoding="utf-8")
    np.testing.assert_array_equal(read_recording(path).force, recording.force)
