"""Numbers that a sheet stores as text are read where a whole column is such."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from one_recording import refusal
from tirelab.recordings.recording import read_recording

HEADERS = ["time [s]", "stroke [mm]", "load [N]"]


def save(path: Path, rows: list[list[Any]]) -> Path:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in [HEADERS, *rows]:
        book.active.append(row)
    book.save(path)
    return path


@pytest.mark.parametrize("written", ["{:.2f}", "{:,.2f}", " {:.2f} "])
def test_a_column_of_text_is_read_whatever_the_rows_beside_hold(tmp_path: Path, written: str) -> None:
    """Rows that are blank do not count, nor does it that a mark stands between thousands."""
    blank: list[Any] = [None] * 3
    rows = [[0.1 * i, 0.1 * i, written.format(25.0 * i)] for i in range(100)]
    path = save(tmp_path / "a.xlsx", [row for pair in rows for row in (pair, blank, blank)])
    recording = read_recording(path, radius="flat")
    np.testing.assert_allclose(recording.force, 25.0 * np.arange(100))


def test_what_may_be_thousands_is_not_read(tmp_path: Path) -> None:
    rows = [[0.1 * i, 0.1 * i, "0.00" if i < 99 else "1,234"] for i in range(100)]
    path = save(tmp_path / "a.xlsx", rows)
    assert "row 101, column 'load [N]': '1,234' is not a number" in refusal(path)


def test_a_single_text_in_a_column_of_numbers_is_refused(tmp_path: Path) -> None:
    rows = [[0.1 * i, 0.1 * i, "0.00" if i == 50 else 25.0 * i] for i in range(100)]
    assert "row 52, column 'load [N]': '0.00' is not a number" in refusal(save(tmp_path / "a.xlsx", rows))
