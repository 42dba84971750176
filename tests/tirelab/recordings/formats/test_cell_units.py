"""Units that stand behind every number of a column."""

from pathlib import Path

import numpy as np
import pytest
from house_form import refusal
from tirelab.recordings.recording import read_recording

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
