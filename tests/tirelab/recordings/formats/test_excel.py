"""The recording comes the same from Excel sheets, and what is none is refused."""

import datetime
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from one_recording import COLUMNS, HEADERS, SAMPLES, TIME, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording


class TestExcel:
    def save(self, path: Path, rows: list[list[Any]], empty_sheet_first: bool = False) -> Path:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        sheet = book.create_sheet("numbers") if empty_sheet_first else book.active
        for row in rows:
            sheet.append(row)
        book.save(path)
        book.close()
        return path

    def rows(self) -> list[list[Any]]:
        return [list(HEADERS), *([float(v) for v in row] for row in zip(*COLUMNS.values(), strict=True))]

    def test_the_first_sheet_that_holds_anything(self, tmp_path: Path) -> None:
        path = self.save(tmp_path / "a.xlsx", [[], ["", None], *self.rows()], empty_sheet_first=True)
        # openpyxl writes 16 digits of each number.
        assert_the_recording(read_recording(path, radius="flat"), digits=1e-15)

    def test_blanks_empty_rows_and_words(self, tmp_path: Path) -> None:
        rows = [[*row, "flat"] for row in self.rows()]
        rows[0][3] = "radius [cm]"
        rows[9][2] = None
        rows[19] = []
        path = self.save(tmp_path / "a.xlsx", [*rows, [], [None]])
        recording = read_recording(path)
        assert len(recording) == SAMPLES - 2
        assert "skipped for want of force: row 10" in recording.notes
        assert "skipped as empty: row 20" in recording.notes
        assert np.all(recording.surface_radius == math.inf)

    @pytest.mark.parametrize(
        ("cell", "said"),
        [
            ("#DIV/0!", "'#DIV/0!' is not a number"),
            ("1,5", "'1,5' is not a number"),
            (True, "'True' is not a number"),
        ],
    )
    def test_what_is_not_a_number_is_told_by_its_row(self, tmp_path: Path, cell: object, said: str) -> None:
        rows = self.rows()
        rows[9][2] = cell
        assert f"row 10, column 'force [kN]': {said}" in refusal(self.save(tmp_path / "a.xlsx", rows))

    def test_a_formula_is_not_worked_out(self, tmp_path: Path) -> None:
        rows = self.rows()
        rows[9][2] = "=1+1"
        recording = read_recording(self.save(tmp_path / "a.xlsx", rows), radius="flat")
        assert "skipped for want of force: row 10" in recording.notes

    @pytest.mark.parametrize(
        "start",
        [datetime.datetime(2024, 2, 3, 23, 59, 59), datetime.time(4, 5, 6), datetime.timedelta(hours=30)],
    )
    def test_dates_and_times_of_day_count_from_the_first(self, tmp_path: Path, start: Any) -> None:
        rows = self.rows()
        for row in rows[1:]:
            step = datetime.timedelta(seconds=row[0])
            if isinstance(start, datetime.time):
                row[0] = (datetime.datetime.combine(datetime.date(2024, 2, 3), start) + step).time()
            else:
                row[0] = start + step
        recording = read_recording(self.save(tmp_path / "a.xlsx", rows), radius="flat")
        # Excel keeps a day as a double: half a microsecond is lost, and openpyxl rounds to one.
        np.testing.assert_allclose(recording.time, TIME, atol=2e-6)

    def test_a_sheet_without_a_header_is_told(self, tmp_path: Path) -> None:
        assert "is no header" in refusal(self.save(tmp_path / "a.xlsx", self.rows()[1:]))
        assert "no header and no numbers" in refusal(self.save(tmp_path / "b.xlsx", []))
