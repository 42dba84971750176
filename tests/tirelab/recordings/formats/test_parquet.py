"""The recording comes the same from Parquet, and what is none is refused."""

import datetime
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from one_recording import COLUMNS, DEFLECTION, FORCE, SAMPLES, TIME, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording


class TestParquet:
    def test_columns_with_units_in_their_names(self, tmp_path: Path) -> None:
        pl.DataFrame(COLUMNS).write_parquet(tmp_path / "a.parquet")
        assert_the_recording(read_recording(tmp_path / "a.parquet", radius="flat"))

    def test_time_stamps_count_from_the_first_and_nulls_are_blanks(self, tmp_path: Path) -> None:
        start = datetime.datetime(2024, 2, 3, 4, 5, 6)
        stamps = [start + datetime.timedelta(milliseconds=10 * i) for i in range(SAMPLES)]
        force: list[float | None] = list(FORCE)
        force[8] = None
        frame = pl.DataFrame(
            {"time": stamps, "x_mm": DEFLECTION, "deflection_mm": DEFLECTION, "force_kN": force}
        )
        frame.write_parquet(tmp_path / "a.parquet")
        recording = read_recording(tmp_path / "a.parquet", radius="flat")
        np.testing.assert_allclose(recording.time, np.delete(TIME, 8), atol=1e-12)
        assert "skipped for want of force: sample 9" in recording.notes

    def test_text_says_units_in_a_first_row_and_clock_times_as_in_a_frame(self, tmp_path: Path) -> None:
        times = [f"14:05:{0.01 * i:05.2f}" for i in range(SAMPLES)]
        columns = {
            "Zeit": ["", *times],
            "Weg": ["[mm]", *map(str, DEFLECTION.tolist())],
            "Kraft": ["[kN]", *map(str, FORCE.tolist())],
        }
        pl.DataFrame(columns).write_parquet(tmp_path / "a.parquet")
        recording = read_recording(tmp_path / "a.parquet", radius="flat")
        assert_the_recording(recording, "units taken from sample 1, below the names")

    @pytest.mark.parametrize(
        ("values", "said"),
        [
            (["a"] * SAMPLES, "holds text, 'a' the first"),
            ([True] * SAMPLES, "true and false"),
            ([[1.0]] * SAMPLES, "lists"),
        ],
    )
    def test_what_is_not_a_number_is_refused(self, tmp_path: Path, values: list[Any], said: str) -> None:
        pl.DataFrame({**COLUMNS, "force [kN]": values}).write_parquet(tmp_path / "a.parquet")
        assert said in refusal(tmp_path / "a.parquet")
