"""Tables whose columns stand between spaces read as the same table with commas does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.formats.spaced import spaced_columns, with_tabs
from tirelab.recordings.recording import RecordingError, read_recording

TIME = np.arange(150) / 10.0
DEFLECTION = np.round(11.0 * (1.0 - np.cos(TIME)), 3)
FORCE = np.round(300.0 * (DEFLECTION / 10.0) ** 1.4, 2)


def rows(form: str, comma: bool = False) -> str:
    text = "".join(form.format(*row) + "\n" for row in zip(TIME, DEFLECTION, FORCE, strict=True))
    return text.replace(".", ",") if comma else text


def assert_read(path: Path) -> None:
    recording = read_recording(path, radius="flat")
    np.testing.assert_allclose(recording.time, TIME, atol=1e-12)
    np.testing.assert_allclose(1e3 * recording.deflection, DEFLECTION, atol=1e-9)
    np.testing.assert_allclose(recording.force, FORCE)
    assert "columns read between spaces" in recording.notes


@pytest.mark.parametrize(
    "head",
    [
        "time [s]   deflection [mm]   force [N]\n",
        "time [s] deflection [mm] force [N]\n",
        "  time_s deflection_mm force_N\n",
        "time deflection force\ns mm N\n",
        "# time_s deflection_mm force_N\n",
        "run 5 of the tire\npressure 2.1 bar\n\nTime (s)  Tire deflection (mm)  Load (N)\n",
        "Time (s) tire deflection (mm) load (N)\n",
    ],
)
@pytest.mark.parametrize("form", ["{:.1f} {:.3f} {:.2f}", "  {:8.1f}  {:8.3f} {:10.2f}  "])
def test_a_table_between_spaces(head: str, form: str, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(head + rows(form))
    assert_read(path)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "latin-1"])
@pytest.mark.parametrize("comma", [False, True])
def test_encodings_and_decimal_commas(encoding: str, comma: bool, tmp_path: Path) -> None:
    path = tmp_path / "a.dat"
    text = "Prüfung Nummer\ntime_s deflection_mm force_N\n" + rows("{:8.1f} {:8.3f} {:9.2f}", comma)
    path.write_bytes(text.replace("\n", "\r\n").encode(encoding))
    assert_read(path)


def test_a_clock_and_a_comment_among_the_rows(tmp_path: Path) -> None:
    lines = [f"14:05:{s:04.1f} {x:.3f} {f:.2f}" for s, x, f in zip(TIME, DEFLECTION, FORCE, strict=True)]
    lines.insert(40, "# the operator coughed here")
    path = tmp_path / "a.txt"
    path.write_text("clock deflection_mm force_N\n" + "\n".join(lines) + "\n")
    assert_read(path)


@pytest.mark.parametrize(("row", "cells"), [("5.0 1.25", 2), ("5.0 1.25 3.0 4.0", 4)])
def test_a_row_of_another_width_is_named(row: str, cells: int, tmp_path: Path) -> None:
    lines = rows("{:.1f} {:.3f} {:.2f}").splitlines()
    lines[50] = row
    path = tmp_path / "a.txt"
    path.write_text("time_s deflection_mm force_N\n" + "\n".join(lines) + "\n")
    with pytest.raises(RecordingError, match=rf"row 52: has {cells} cells where the table has 3 columns"):
        read_recording(path, radius="flat")


@pytest.mark.parametrize(
    "line", ["0,5,1,2", "0.1, 0.2, 0.3", "0.1;0.2 ;0.3", "0.1\t0.2", "3 samples of rubber", "1 234,5"]
)
def test_other_tables_and_prose_are_none(line: str) -> None:
    assert spaced_columns([line] * 5) in ((0, 2) if line == "1 234,5" else (0,))


def test_a_line_of_text_stays() -> None:
    assert with_tabs("made by B and C\n", 3) == "made by B and C\n"
    assert with_tabs("# 1 2\r\n", 2) == "# 1\t2\r\n"


def test_names_and_units_in_comments_that_say_so(tmp_path: Path) -> None:
    """As scanning probes write them: of a segment, above its numbers, with more about it between and below."""
    head = (
        '# segment: extend\n# columns: time deflection force\n# fancyNames: "t" "x" "F"\n# units: s mm N\n#\n'
    )
    path = tmp_path / "probe.txt"
    path.write_text(head + rows("{:.1f} {:.3f} {:.2f}"), encoding="utf-8")
    assert_read(path)
    assert (
        "column names taken from the comments above the numbers" in read_recording(path, radius="flat").notes
    )
    path.write_text(
        head.replace("time deflection", "deflection") + rows("{:.1f} {:.3f} {:.2f}"), encoding="utf-8"
    )
    with pytest.raises(RecordingError, match="has no header row"):
        read_recording(path, radius="flat")
