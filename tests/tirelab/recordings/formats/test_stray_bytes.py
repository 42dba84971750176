"""Bytes and words of no reading: zero bytes, joined byte order marks, dashes; nothing is lost in silence."""

from pathlib import Path

import pytest
from tirelab.recordings.recording import Recording, RecordingError, read_recording

NAMES = "Time [s];Stroke [mm];Load [N]\n"
ROWS = [f"{i / 10:.1f};{20.0 - abs(20.0 - i / 2):.3f};{i:.3f}\n" for i in range(81)]
TEXT = NAMES + "".join(ROWS)


def read(folder: Path, text: str) -> Recording:
    path = folder / "press.csv"
    path.write_bytes(text.encode())
    return read_recording(path, radius="flat")


def test_zero_bytes_at_the_end_of_a_file_are_left_out(tmp_path: Path) -> None:
    assert len(read(tmp_path, TEXT + "\0" * 4096)) == len(ROWS)


def test_a_line_of_zero_bytes_is_an_empty_one(tmp_path: Path) -> None:
    late = "".join(f"{8.1 + 0.1 * i:.1f};0.000;0.000\n" for i in range(9000))
    found = read(tmp_path, f"{TEXT}{late}{chr(0) * 512}\n950;0.000;0.000\n")
    assert "skipped as empty: row 9083" in found.notes


def test_zero_bytes_among_the_numbers_are_named_by_their_row(tmp_path: Path) -> None:
    text = TEXT.replace("3.000;", "\0\0.000;", 1)
    with pytest.raises(RecordingError, match=r"press\.csv, row 8: holds zero bytes.*tr -d '\\000' < "):
        read(tmp_path, text)


def test_byte_order_marks_of_files_that_were_joined_are_left_out(tmp_path: Path) -> None:
    head = f"\ufeff{NAMES}"
    found = read(tmp_path, "\ufeff" + head + "".join(ROWS[:40]) + head + "".join(ROWS[40:]))
    assert len(found) == len(ROWS)
    assert "header written again, its rows read on: row 42" in found.notes


@pytest.mark.parametrize("blank", ["--", "---", "n.a.", "-nan(ind)", "1.#QNAN"])
def test_words_for_no_reading_cost_their_row(tmp_path: Path, blank: str) -> None:
    found = read(tmp_path, f"{TEXT}8.1;0.000;{blank}\n")
    assert len(found) == len(ROWS)
    assert "skipped for want of force: row 83" in found.notes
