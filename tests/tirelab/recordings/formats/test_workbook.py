"""Sheets that a workbook does not show, and formulas that nobody worked out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from one_recording import refusal
from tirelab.recordings.files import recording_files
from tirelab.recordings.recording import read_recording

openpyxl = pytest.importorskip("openpyxl")

NAMES = ["time [s]", "stroke [mm]", "load [N]"]
RESULTS = ["Specimen", "E modulus"]


def saved(path: Path, sheets: dict[str, list[str]], hidden: tuple[str, ...] = ()) -> Path:
    """A workbook of sheets by their title with these names of columns, each with forces of its own."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for number, (title, names) in enumerate(sheets.items(), 1):
        sheet = book.create_sheet(title)
        sheet.append(names)
        for i in range(30):
            sheet.append([0.1 * i, 0.2 * i, 10.0 * number * i][: len(names)])
        sheet.sheet_state = "hidden" if title in hidden else "visible"
    book.save(path)
    book.close()
    return path


@pytest.mark.parametrize("name", ["a.xlsx", "a.xlsb"])
def test_a_hidden_sheet_is_no_trial(tmp_path: Path, name: str) -> None:
    """Of .xlsb, .xls and .ods another library reads the sheets, whatever their form."""
    path = saved(tmp_path / name, {"old run": NAMES, "run": NAMES}, ("old run",))
    files, _ = recording_files([path])
    assert files == (path,)
    found = read_recording(path, radius="flat")
    assert found.force.max() == pytest.approx(580.0)
    said = f"read from sheet 'run'; hidden and not read: 'old run'; one is read as '{name}@old run'"
    assert said in found.notes
    assert read_recording(f"{path}@old run", radius="flat").force.max() == pytest.approx(290.0)


@pytest.mark.parametrize(
    ("sheets", "instead"),
    [({"Raw": NAMES, "Results": RESULTS}, "; one that is shown: a.xlsx@Results"), ({"Raw": NAMES}, "")],
)
def test_a_workbook_that_shows_no_recording_names_the_hidden_one(
    tmp_path: Path, sheets: dict[str, list[str]], instead: str
) -> None:
    path = saved(tmp_path / "a.xlsx", {"empty": [], **sheets}, ("Raw",))
    said = "'Raw' is hidden; one is read by its name, as a.xlsx@Raw"
    assert refusal(path).endswith(f"no columns for deflection and force, and {said}{instead}")


def with_formulas(path: Path, columns: tuple[int, ...], rows: range) -> Path:
    """A workbook in which some cells are formulas without a result."""
    book = openpyxl.Workbook()
    book.active.title = "run 1"
    book.active.append(NAMES)
    for i in range(60):
        cells: list[Any] = [0.1 * i, 0.2 * i, 30.0 * i]
        for column in columns:
            cells[column] = f"={cells[column]}*1" if i in rows else cells[column]
        book.active.append(cells)
    book.save(path)
    book.close()
    return path


@pytest.mark.parametrize(
    ("columns", "rows", "cell"),
    [((2,), range(60), "C2"), ((1, 2), range(20, 60), "B22"), ((0, 1, 2), range(60), "A2")],
)
def test_formulas_without_results_are_refused_by_their_cell(
    tmp_path: Path, columns: tuple[int, ...], rows: range, cell: str
) -> None:
    said = f"a.xlsx, sheet 'run 1', cell {cell}: its formula was never worked out; open the workbook in a spreadsheet"
    assert said in refusal(with_formulas(tmp_path / "a.xlsx", columns, rows), radius="flat")


def test_a_single_formula_without_a_result_is_told(tmp_path: Path) -> None:
    found = read_recording(with_formulas(tmp_path / "a.xlsx", (2,), range(7, 8)), radius="flat")
    assert "skipped for want of force: row 9" in found.notes
    assert any("cell C9: its formula was never worked out" in note for note in found.notes)
