"""The recording comes the same from Excel sheets, and what is none is refused."""

import datetime
import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from old_workbook import write_old_workbook
from one_recording import COLUMNS, HEADERS, SAMPLES, TIME, assert_the_recording, refusal
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.choices import Choices
from tirelab.recordings.files import recording_files
from tirelab.recordings.formats import workbook
from tirelab.recordings.inspection import inspect_recording
from tirelab.recordings.recording import RecordingError, read_recording


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

    def test_a_sheet_without_a_header_is_read_by_the_numbers_of_its_columns(self, tmp_path: Path) -> None:
        path = self.save(tmp_path / "a.xlsx", self.rows()[1:])
        assert "has no header row" in refusal(path)
        columns = {"time": "#1", "deflection": "#2", "force": "#3"}
        units = {"time": "s", "deflection": "mm", "force": "kN"}
        recording = read_recording(path, radius="flat", columns=columns, units=units)
        by_number = "the sheet has no header row: its columns are known by number only"
        assert_the_recording(recording, by_number, digits=1e-15)
        found = inspect_recording(path, Choices(radius="flat", columns=columns, units=units))
        assert dict(found.facts)["table"] == "xlsx, sheet 'Sheet', numbers in row 1"
        assert "no header and no numbers" in refusal(self.save(tmp_path / "b.xlsx", []))

    def test_the_table_below_a_title_with_units_below_its_names(self, tmp_path: Path) -> None:
        """As test machines write a sheet: the specimen above each column, the units below the names."""
        names = [
            ["Probe 4"] * 4,
            ["Prüfzeit", "Verformung", "Standardkraft", "Spannung"],
            ["s", "mm", "N", "MPa"],
        ]
        numbers = [[0.1 * i, 0.2 * i, 30.0 * i, 0.5] for i in range(40)]
        path = self.save(tmp_path / "a.xlsx", [*names, *numbers])
        recording = read_recording(path, radius="flat")
        np.testing.assert_allclose(recording.deflection, 2e-4 * np.arange(40))
        np.testing.assert_allclose(recording.force, 30.0 * np.arange(40))
        assert "units taken from row 3, below the names" in recording.notes
        numbers[9][2] = "oops"
        path = self.save(tmp_path / "b.xlsx", [*names, *numbers])
        assert "row 13, column 'Standardkraft': 'oops' is not a number" in refusal(path)

    def test_a_sheet_of_results_before_that_of_the_readings(self, tmp_path: Path) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        for row in (["Specimen", "E modulus"], ["1", 2.1], ["2", 2.2]):
            book.active.append(row)
        sheet = book.create_sheet("readings")
        for row in self.rows():
            sheet.append(row)
        book.save(tmp_path / "a.xlsx")
        recording = read_recording(tmp_path / "a.xlsx", radius="flat")
        others = "sheets of other columns: 'Sheet'; one is read by its name, as a.xlsx@Sheet"
        assert_the_recording(recording, f"read from sheet 'readings'; {others}", digits=1e-15)

    def test_of_sheets_with_other_columns_the_longest_is_read(self, tmp_path: Path) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.remove(book.active)
        for title, force, samples in (("preload", "force", 310), ("test", "load", 500), ("after", "F", 320)):
            sheet = book.create_sheet(title)
            if title == "test":
                sheet.append(["Operator", "B"])
            sheet.append(["time [s]", "stroke [mm]", f"{force} [N]"])
            for i in range(samples):
                sheet.append([0.1 * i, 0.2 * i, 10.0 * i])
        book.save(tmp_path / "a.xlsx")
        recording = read_recording(tmp_path / "a.xlsx", radius="flat")
        assert len(recording) == 500
        assert any(note.startswith("read from sheet 'test'; sheets of") for note in recording.notes)

    def test_sheets_of_the_same_columns_are_tests_side_by_side(self, tmp_path: Path) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.active.title = "notes"
        for number, samples in ((1, 30), (2, 50)):
            sheet = book.create_sheet(f"Specimen {number}")
            sheet.append(["Operator", f"B{number}"])
            sheet.append(["time [s]", "stroke [mm]", "load [N]"])
            for i in range(samples):
                sheet.append([0.1 * i, 0.2 * i, 10.0 * number * i])
        book.save(tmp_path / "a.xlsx")
        assert "holds 2 trials side by side" in refusal(tmp_path / "a.xlsx")
        files, _ = recording_files([tmp_path / "a.xlsx"])
        first, second = (read_recording(file, radius="flat") for file in files)
        assert (len(first), len(second)) == (30, 50)
        assert second.force.max() == pytest.approx(980.0)
        assert "read from sheet 'Specimen 2'" in second.notes
        assert (first.provenance, second.provenance) == (("Operator; B1",), ("Operator; B2",))
        facts = dict(inspect_recording(files[1], Choices(radius="flat")).facts)
        assert facts["table"] == "xlsx, sheet 'Specimen 2', names in row 2"

    def test_sheets_on_each_of_which_several_tests_stand_have_the_tests_of_all(self, tmp_path: Path) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.active.title = "Day 0"
        for sheet, first in ((book.active, 10.0), (book.create_sheet("Day 7"), 30.0)):
            sheet.append([f"{name} {n}" for n in (1, 2) for name in ("time [s]", "stroke [mm]", "load [N]")])
            for i in range(40):
                sheet.append([v for n in (0.0, 10.0) for v in (0.1 * i, 0.2 * i, (first + n) * i)])
        book.save(tmp_path / "a.xlsx")
        files, _ = recording_files([tmp_path / "a.xlsx"])
        largest = [read_recording(file, radius="flat").force.max() for file in files]
        assert largest == pytest.approx([390.0, 780.0, 1170.0, 1560.0])
        assert "has 4 trials side by side" in refusal(tmp_path / "a.xlsx@trial5")

    def test_a_column_without_a_name_on_one_of_them_makes_no_difference(self, tmp_path: Path) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.remove(book.active)
        for title, samples in (("1000-50mm", 60), ("800-50mm", 50)):
            sheet = book.create_sheet(title)
            sheet.append(["time [s]", "stroke [mm]", "load [N]"])
            for i in range(samples):
                sheet.append([0.1 * i, 0.2 * i, 10.0 * i, *([0.0] if samples == 60 else [])])
        book.save(tmp_path / "a.xlsx")
        files, _ = recording_files([tmp_path / "a.xlsx"])
        first, second = (read_recording(file, radius="flat") for file in files)
        assert (len(first), len(second)) == (60, 50)
        assert second.force.max() == pytest.approx(490.0)
        assert "read from sheet '800-50mm'" in second.notes

    def test_a_sheet_is_named_behind_the_file(self, tmp_path: Path) -> None:
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.active.title = "notes"
        for title, factor, samples in (("RDG1 1", 1.0, 40), ("mean curve", 2.0, 60)):
            sheet = book.create_sheet(title)
            sheet.append(["time [s]", "stroke [mm]", "load [N]", *(["work [J]"] if factor == 1.0 else [])])
            for i in range(samples):
                sheet.append([0.1 * i, 0.2 * i, 10.0 * factor * i])
        path = tmp_path / "a.xlsx"
        book.save(path)
        longest = read_recording(path, radius="flat")
        assert longest.force.max() == pytest.approx(1180.0)
        how = "sheets of other columns: 'RDG1 1'; one is read by its name, as 'a.xlsx@RDG1 1'"
        assert f"read from sheet 'mean curve'; {how}" in longest.notes
        one = read_recording(f"{path}@rdg1 1", radius="flat")
        assert one.force.max() == pytest.approx(390.0)
        assert one.name == "a@rdg1 1"
        assert "read from sheet 'RDG1 1'" in one.notes
        assert len(read_recording(f"{path}@RDG1 1@1s:2s", radius="flat")) == 10
        assert inspect_recording(f"{path}@RDG1 1", Choices(radius="flat")).key == "a.xlsx@RDG1 1"
        (tmp_path / "recording.toml").write_text(
            '[files."a.xlsx@RDG1 1"]\nname = "the first"\nradius = "flat"\n'
        )
        assert read_recording(f"{path}@RDG1 1").name == "the first@RDG1 1"
        said = refusal(tmp_path / "a.xlsx@RDG2")
        assert (
            "has no sheet 'RDG2'; its sheets are 'notes', 'RDG1 1', 'mean curve', and a part of one" in said
        )
        assert "sheet 'notes': holds no header and no numbers" in refusal(tmp_path / "a.xlsx@notes")

    def test_numbers_beside_the_names_are_of_another_table(self, tmp_path: Path) -> None:
        beside = [
            [None, None, 20.0, 80.0],
            [None, None, 3.2, 77.1],
            *[[None] * 4 for _ in range(SAMPLES - 1)],
        ]
        rows = [row + more for row, more in zip(self.rows(), beside, strict=True)]
        path = self.save(tmp_path / "a.xlsx", [*rows, [None] * 5 + [1.0, 2.0]])
        assert_the_recording(read_recording(path, radius="flat"), digits=1e-15)

    def test_a_column_that_names_the_steps_and_numbers_that_were_not_measured(self, tmp_path: Path) -> None:
        nothing = 1.797693134862315e308
        rows: list[list[Any]] = [["Segment", *row, "Hardness"] for row in self.rows()[:1]]
        rows += [[None, *row, nothing] for row in self.rows()[1:]]
        rows[1][0], rows[120][0] = "Load", "Unload"
        path = self.save(tmp_path / "a.xlsx", [*rows, ["END", None, None, None, None]])
        said = "skipped as empty: row 202"
        assert_the_recording(read_recording(path, radius="flat"), said, digits=1e-15)
        # The reader counts an empty column that the file claims to have.
        wider = self.save(tmp_path / "c.xlsx", [[*row[:5], None, None] for row in rows])
        assert_the_recording(read_recording(wider, radius="flat"), digits=1e-15)
        rows[9][3] = nothing
        recording = read_recording(self.save(tmp_path / "b.xlsx", rows), radius="flat")
        assert "skipped for want of force: row 10" in recording.notes


OFFICE = """<?xml version="1.0" encoding="UTF-8"?>
<office:document-content xmlns:office="urn:oasis:names:tc:opendocument:xmlns:office:1.0"
 xmlns:table="urn:oasis:names:tc:opendocument:xmlns:table:1.0"
 xmlns:text="urn:oasis:names:tc:opendocument:xmlns:text:1.0" office:version="1.3"><office:body>
<office:spreadsheet><table:table table:name="one">{}</table:table></office:spreadsheet></office:body>
</office:document-content>"""


def test_an_open_document_is_read_as_the_others_are(tmp_path: Path) -> None:
    pytest.importorskip("python_calamine")
    names = "".join(
        f'<table:table-cell office:value-type="string"><text:p>{name}</text:p></table:table-cell>'
        for name in ("time [s]", "stroke [mm]", "load [N]")
    )
    rows = [names] + [
        "".join(
            f'<table:table-cell office:value-type="float" office:value="{v}"/>'
            for v in (0.1 * i, 0.2 * i, 9 * i)
        )
        for i in range(30)
    ]
    content = OFFICE.format("".join(f"<table:table-row>{row}</table:table-row>" for row in rows))
    mime = "application/vnd.oasis.opendocument.spreadsheet"
    manifest = (
        '<manifest:manifest xmlns:manifest="urn:oasis:names:tc:opendocument:xmlns:manifest:1.0">'
        f'<manifest:file-entry manifest:full-path="/" manifest:media-type="{mime}"/></manifest:manifest>'
    )
    with zipfile.ZipFile(tmp_path / "a.ods", "w") as book:
        book.writestr("mimetype", mime)
        book.writestr("META-INF/manifest.xml", manifest)
        book.writestr("content.xml", content)
    recording = read_recording(tmp_path / "a.ods", radius="flat")
    np.testing.assert_allclose(recording.force, 9.0 * np.arange(30))
    np.testing.assert_allclose(recording.deflection, 2e-4 * np.arange(30))


def test_a_workbook_of_the_format_before_xlsx(tmp_path: Path) -> None:
    """It is no archive, so that a search for one leaves the stream at its end."""
    pytest.importorskip("python_calamine")
    rows = [list(HEADERS), *(list(map(float, row)) for row in zip(*COLUMNS.values(), strict=True))]
    path = write_old_workbook(tmp_path / "a.xls", rows)
    assert_the_recording(read_recording(path, radius="flat"))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_text_table_that_is_named_as_a_workbook(tmp_path: Path, encoding: str) -> None:
    """Instruments write one so that a spreadsheet opens it."""
    lines = ["Impact tester", "\t".join(HEADERS)]
    lines += ["\t".join(f"{value:.17g}" for value in row) for row in zip(*COLUMNS.values(), strict=True)]
    (tmp_path / "a.xls").write_text("\n".join(lines), encoding=encoding)
    above = "table found at row 2: the lines above it are kept as its provenance"
    assert_the_recording(read_recording(tmp_path / "a.xls", radius="flat"), above)


@pytest.mark.parametrize("content", ["<html><table><tr><td>1</td></tr></table></html>", "\x09\x08\x00\x01"])
def test_what_is_neither_text_nor_a_workbook_is_refused_as_a_workbook(tmp_path: Path, content: str) -> None:
    (tmp_path / "a.xls").write_text(content)
    with pytest.raises(RecordingError, match="cannot be read as a workbook"):
        read_recording(tmp_path / "a.xls", radius="flat")


@pytest.mark.parametrize("name", ["bomb.xlsx", "bomb.ods"])
def test_a_workbook_that_would_fill_the_memory_is_refused_before_it_is_unpacked(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workbook, "PACKED_FROM", 2**20)
    with zipfile.ZipFile(tmp_path / name, "w", zipfile.ZIP_DEFLATED) as book:
        book.writestr("xl/worksheets/sheet1.xml", b"<c><v>1</v></c>" * 2**18)
    assert "unpacks from" in (told := refusal(tmp_path / name))
    assert f"to {2**18 * 15 / 1e6:.3g} MB, which no table of measured numbers does" in told


def test_a_workbook_of_noise_is_far_from_that(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    force = np.random.default_rng(1).normal(0.0, 5.0, 2000).round(1)
    for row in (["time [s]", "stroke [mm]", "load [N]"], *([i, i % 7, f] for i, f in enumerate(force))):
        book.active.append(row)
    book.save(tmp_path / "a.xlsx")
    with zipfile.ZipFile(tmp_path / "a.xlsx") as members:
        content = sum(member.file_size for member in members.infolist())
    assert 5 * content < workbook.MOST_PACKED * (tmp_path / "a.xlsx").stat().st_size


def of_tests(path: Path, tests: int, header: list[str]) -> Path:
    """Return a workbook with a sheet of results of one row, and a sheet for each of several tests."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    results = book.active
    results.append(["", "Fmax", "dL at Fmax"])
    results.append(["", "N", "mm"])
    results.append(["test 1", 25.3, 8.4])
    for test in range(1, tests + 1):
        sheet = book.create_sheet(f"test {test}")
        sheet.append(header)
        for i in range(30):
            sheet.append([0.1 * i, 0.2 * i, 10.0 * test * i])
    book.save(path)
    book.close()
    return path


def test_a_workbook_of_many_tests_is_opened_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    path = of_tests(tmp_path / "a.xlsx", 5, ["time [s]", "stroke [mm]", "load [N]"])
    opened: list[Any] = []
    load = openpyxl.load_workbook

    def counted(stream: Any, **options: Any) -> Any:
        opened.append(stream)
        return load(stream, **options)

    monkeypatch.setattr(openpyxl, "load_workbook", counted)
    files, _ = recording_files([path])
    forces = [inspect_recording(file, Choices(part=True)).recording.force[-1] for file in files]
    assert forces == [290.0 * test for test in range(1, 6)]
    assert len(opened) == 1
    of_tests(path, 2, ["time [s]", "stroke [mm]", "load [kN]"])
    assert read_recording(f"{path}@trial2", radius="flat").force[-1] == pytest.approx(580e3)


def test_a_row_of_results_is_not_the_recording_that_is_asked_about(tmp_path: Path) -> None:
    path = of_tests(tmp_path / "a.xlsx", 1, ["Time [s]", "strain [%]", "stress [N/mm^2]"])
    assert "'strain [%]', 'stress [N/mm^2]' say strain or stress" in refusal(path, radius="flat")


def test_the_columns_of_tests_side_by_side_are_called_as_in_one(tmp_path: Path) -> None:
    """So that one command reads them all: of a separation that falls nobody knows which way the rig counts."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for test in (1, 2):
        sheet = book.create_sheet(f"test {test}") if test > 1 else book.active
        sheet.append(["time [s]", "tool separation [mm]", "force [N]"])
        for i in range(30):
            sheet.append([0.1 * i, 13.0 - 0.1 * i, 2.0 * test * i])
    book.save(tmp_path / "a.xlsx")
    book.close()
    files, _ = recording_files([tmp_path / "a.xlsx"])
    commands = set()
    for file in files:
        with pytest.raises(IncompleteRecording) as caught:
            inspect_recording(file, Choices(part=True))
        commands.add(tuple(caught.value.words()))
    assert commands == {("--columns", "deflection=-tool separation [mm],force=+force [N]")}
    signs = {"deflection": "-tool separation [mm]", "force": "+force [N]"}
    told = inspect_recording(files[1], Choices(signs, part=True))
    assert told.recording.force[-1] == 116.0
    assert told.settings["columns"]["deflection"] == "-tool separation [mm]"
