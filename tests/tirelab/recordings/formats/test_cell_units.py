"""Units that stand behind every number of a column."""

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from house_form import refusal
from tirelab.recordings.recording import Recording, RecordingError, read_recording

ROWS = [
    [f"{i / 10:.1f} s", f"{0.5 * min(i, 80 - i):.2f} mm", f"{0.02 * min(i, 80 - i):.2f}kN"] for i in range(81)
]


def written(path: Path, rows: list[list[str]], mark: str = ",") -> Path:
    path.write_text("\n".join(mark.join(row) for row in [["Time", "Deflection", "Force"], *rows]) + "\n")
    return path


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_units_of_a_whole_column_are_taken_from_its_cells(tmp_path: Path, mark: str) -> None:
    recording = read_recording(written(tmp_path / "a.csv", ROWS, mark), radius="flat")
    np.testing.assert_allclose(recording.time, np.arange(81) / 10.0)
    # 40 steps of 0.5 mm, and of 20 N
    assert (recording.deflection.max(), recording.force.max()) == pytest.approx((0.02, 800.0))
    assert "units taken from the cells: s, mm, kN" in recording.notes


def test_below_lines_about_the_test_and_with_decimal_commas(tmp_path: Path) -> None:
    rows = [[cell.replace(".", ",") for cell in row] for row in ROWS]
    path = written(tmp_path / "a.csv", rows, ";")
    path.write_text("Press;2\nOperator;B\n" + path.read_text())
    assert read_recording(path, radius="flat").force.max() == pytest.approx(800.0)


@pytest.mark.parametrize("cell", ["0.40", "400 N", "0.4 kN later"])
def test_a_cell_without_the_unit_of_its_column_is_refused(tmp_path: Path, cell: str) -> None:
    rows = [*ROWS[:20], [*ROWS[20][:2], cell], *ROWS[21:]]
    assert "row 22, column 'Force'" in refusal(written(tmp_path / "a.csv", rows), radius="flat")


def test_a_cell_in_a_larger_unit_is_told_as_it_is_written(tmp_path: Path) -> None:
    rows = [[t, x, f"{i}.5 N"] for i, (t, x, _) in enumerate(ROWS)]
    path = written(tmp_path / "a.csv", [*rows[:30], [*rows[30][:2], "0.03 kN"], *rows[31:]])
    assert "'0.03 kN (without N)' is not a number" in refusal(path, radius="flat")


def workbook(path: Path, rows: list[list[str]]) -> Path:
    book = pytest.importorskip("openpyxl").Workbook()
    for row in [["Press", "2"], ["Time", "Deflection", "Force"], *rows]:
        book.active.append(row)
    book.save(path)
    book.close()
    return path


def frame(rows: list[list[str]]) -> pl.DataFrame:
    return pl.DataFrame(dict(zip(("Time", "Deflection", "Force"), zip(*rows, strict=True), strict=True)))


def read(kind: str, folder: Path, rows: list[list[str]]) -> Recording:
    """The rows from a workbook, a Parquet file, a frame of polars or one of pandas."""
    if kind == "xlsx":
        return read_recording(workbook(folder / "a.xlsx", rows), radius="flat")
    if kind == "parquet":
        frame(rows).write_parquet(folder / "a.parquet")
        return read_recording(folder / "a.parquet", radius="flat")
    table: Any = frame(rows)
    if kind == "pandas":
        table = pytest.importorskip("pandas").DataFrame(table.to_dict(as_series=False))
    return Recording.from_dataframe(table, radius="flat")


@pytest.mark.parametrize("kind", ["xlsx", "parquet", "polars", "pandas"])
class TestOtherTables:
    """A workbook, a Parquet file and a data frame are read as the text of the same cells."""

    @pytest.mark.parametrize("comma", [False, True])
    def test_units_of_a_whole_column(self, tmp_path: Path, kind: str, comma: bool) -> None:
        rows = [[cell.replace(".", ",") for cell in row] for row in ROWS] if comma else ROWS
        recording = read(kind, tmp_path, rows)
        np.testing.assert_allclose(recording.time, np.arange(81) / 10.0)
        # 40 steps of 0.5 mm, and of 20 N
        assert (recording.deflection.max(), recording.force.max()) == pytest.approx((0.02, 800.0))
        assert "units taken from the cells: s, mm, kN" in recording.notes

    @pytest.mark.parametrize("cell", ["0.40", "400 N", "0.4 kN later"])
    def test_a_cell_without_the_unit_of_its_column_is_refused(
        self, tmp_path: Path, kind: str, cell: str
    ) -> None:
        rows = [*ROWS[:20], [*ROWS[20][:2], cell], *ROWS[21:]]
        with pytest.raises(RecordingError) as caught:
            read(kind, tmp_path, rows)
        place = "row 23" if kind == "xlsx" else "sample 21"
        assert f"{place}, column 'Force'" in str(caught.value)

    def test_a_blank_is_no_reading(self, tmp_path: Path, kind: str) -> None:
        rows = [*ROWS[:20], [*ROWS[20][:2], "n/a"], *ROWS[21:]]
        assert len(read(kind, tmp_path, rows)) == len(ROWS) - 1
