"""Which files of a folder are recordings: stray files are skipped with a note, faulty recordings are not."""

import json
from pathlib import Path

import numpy as np
import openpyxl
import polars as pl
import pytest
from house_form import HOUSE_FORM, loading, refusal, write_rows
from tirelab.errors import TirelabError
from tirelab.recordings.files import recording_files, why_no_recording
from tirelab.recordings.formats import LOADERS

PROSE = (
    "Tests of the 2.1 in tire, 30 psi.\nThe press was an Instron 5565, Bluehill 3.\n\nOne, two, three runs.\n"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of two recordings whose names do not stand in the order in which they were written."""
    place = tmp_path / "set"
    place.mkdir()
    time, deflection, force = loading()
    for name in ("slow.csv", "fast.csv"):
        write_rows(place / name, HOUSE_FORM, time, deflection, [np.inf] * len(time), force)
    return place


class TestFolders:
    def test_a_folders_recordings_come_in_the_order_of_their_names(self, folder: Path) -> None:
        assert recording_files([folder]) == ((folder / "fast.csv", folder / "slow.csv"), ())

    def test_files_stand_where_they_are_given(self, folder: Path, tmp_path: Path) -> None:
        lone = tmp_path / "a.csv"
        files, _ = recording_files([folder / "slow.csv", folder, lone])
        # A file that is not there is kept: reading it says so.
        assert files == (folder / "slow.csv", folder / "fast.csv", folder / "slow.csv", lone)

    @pytest.mark.parametrize("name", ["notes.txt", "README.txt", "operators.csv", "log.dat"])
    def test_a_stray_text_file_is_skipped_and_said(self, folder: Path, name: str) -> None:
        (folder / name).write_text(PROSE, encoding="utf-8")
        files, skipped = recording_files([folder])
        assert [file.name for file in files] == ["fast.csv", "slow.csv"]
        assert [file.path for file in skipped] == [folder / name]
        assert str(skipped[0]).startswith(f"{name} skipped: it is no recording (")
        assert "\n" not in str(skipped[0])

    def test_the_same_file_given_by_name_is_refused(self, folder: Path) -> None:
        (folder / "notes.txt").write_text(PROSE, encoding="utf-8")
        files, skipped = recording_files([folder / "notes.txt"])
        assert (files, skipped) == ((folder / "notes.txt",), ())
        assert "notes.txt: no column holds numbers" in refusal(files[0])

    def test_what_has_no_known_suffix_is_left_out(self, folder: Path) -> None:
        for name in ("photo.png", "recording.toml", "notes.md"):
            (folder / name).write_text("", encoding="utf-8")
        assert recording_files([folder])[1] == ()

    def test_hidden_files_and_locks_are_left_out(self, folder: Path) -> None:
        for name in ("._slow.csv", "~$results.xlsx"):
            (folder / name).write_bytes(b"\x00\x05\x16\x07")
        assert [file.name for file in recording_files([folder])[0]] == ["fast.csv", "slow.csv"]

    def test_subfolders_are_not_entered(self, folder: Path) -> None:
        (folder / "more.csv").mkdir()
        assert len(recording_files([folder])[0]) == 2

    def test_an_empty_folder_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(TirelabError, match=r"holds no recording; a recording ends in one of \.csv"):
            recording_files([tmp_path])

    def test_a_folder_of_stray_files_is_refused_with_their_reasons(self, tmp_path: Path) -> None:
        (tmp_path / "notes.txt").write_text(PROSE, encoding="utf-8")
        with pytest.raises(TirelabError, match=r"holds no recording \(notes\.txt skipped"):
            recording_files([tmp_path])


class TestWhatIsNoRecording:
    @pytest.mark.parametrize(
        "content",
        [
            "Recorded on Monday.\n",
            "# nothing but\n# a comment\n",
            "Load, measured with a cell,\nis in newtons.\n",
            "run,operator,remark\n1,Ann,dry\n2,Ben,wet\n",
            "name,verdict,score\nslow,friction,0.9\nfast,lag,0.8\n",
            "a,b,c\n1,2,3\n4,5,6\n",
        ],
        ids=["one line", "comments", "a sentence", "runs", "verdicts", "other numbers"],
    )
    def test_text_without_a_channel(self, tmp_path: Path, content: str) -> None:
        file = tmp_path / "a.txt"
        file.write_text(content, encoding="utf-8")
        assert why_no_recording(file) is not None

    def test_a_workbook_that_lists_tests(self, tmp_path: Path) -> None:
        book = openpyxl.Workbook()
        for row in (["run", "operator", "score"], [1, "Ann", 0.9]):
            book.active.append(row)
        book.save(tmp_path / "tests.xlsx")
        assert why_no_recording(tmp_path / "tests.xlsx") == "no column has the name or the unit of a channel"


class TestWhatMayBeARecording:
    """Nothing that may have been measured is lost: it is refused when it is read."""

    @pytest.mark.parametrize(
        "content",
        [
            "",
            "time [s],deflection [mm],force [N]\n",
            "time [s],force [N]\n0,1\n1,2\n",
            "time,load\n0,1\n1,2\n",
            "0.0,0.1,2.0\n0.1,0.2,4.0\n",
            "0.0 0.1 2.0\n0.1 0.2 4.0\n",
            "Zeit [s];Weg [mm];Kraft [kN]\n0,0;0,1;0,2\n",
            "Uhrzeit;Weg [mm];Kraft [kN]\n2024-01-01 12:00:00;0,1;0,2\n",
            "time [s],deflection [mm],force [N]\n0,1,overload\n",
            "a,b,c\n" + 20 * "1,2,3\n",
            "Machine;ZwickRoell\n\nTime [s];Load [N]\n" + 20 * "0,1;0,2\n",
        ],
        ids=[
            "empty",
            "headed",
            "two",
            "bare",
            "headerless",
            "spaces",
            "German",
            "dated",
            "faulty",
            "unnamed",
            "machine",
        ],
    )
    def test_text(self, tmp_path: Path, content: str) -> None:
        file = tmp_path / "a.csv"
        file.write_text(content, encoding="utf-8")
        assert why_no_recording(file) is None
        assert refusal(file, radius="flat")

    def test_a_format_of_measurements_with_other_names(self, tmp_path: Path) -> None:
        pl.DataFrame({"Weg": [1.0, 2.0], "Kraft": [1.0, 2.0]}).write_parquet(tmp_path / "a.parquet")
        assert why_no_recording(tmp_path / "a.parquet") is None

    @pytest.mark.parametrize("suffix", [suffix for suffix in LOADERS if suffix not in (".csv", ".tsv")])
    def test_a_damaged_file(self, tmp_path: Path, suffix: str) -> None:
        file = tmp_path / f"a{suffix}"
        file.write_bytes(b"\x00\x01\x02" * 50)
        assert why_no_recording(file) is None

    def test_a_file_that_cannot_be_opened(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def locked(*args: object, **options: object) -> None:
            raise PermissionError(13, "Permission denied")

        (tmp_path / "a.csv").write_text(PROSE, encoding="utf-8")
        monkeypatch.setattr(Path, "open", locked)
        assert why_no_recording(tmp_path / "a.csv") is None

    @pytest.mark.parametrize("columns", [{"force": "Ch2"}, {"force": "-ch2"}, {"force": "+#2"}])
    def test_a_column_that_the_user_names(self, tmp_path: Path, columns: dict[str, str]) -> None:
        file = tmp_path / "a.csv"
        file.write_text("Ch1,Ch2\n1,2\n", encoding="utf-8")
        assert why_no_recording(file) is not None
        assert why_no_recording(file, columns) is None

    def test_a_column_that_a_sidecar_names(self, tmp_path: Path) -> None:
        file = tmp_path / "a.csv"
        file.write_text("Zeit,Kraft\n1,2\n", encoding="utf-8")
        (tmp_path / "recording.toml").write_text(
            f"[columns]\nforce = {json.dumps('Kraft')}\n", encoding="utf-8"
        )
        assert why_no_recording(file) is None

    def test_sheets_of_tests_whose_columns_a_sidecar_names(self, tmp_path: Path) -> None:
        """As `tirelab inspect` writes them: one table of settings for each test, none for the whole file."""
        file, book = tmp_path / "a.xlsx", openpyxl.Workbook()
        book.remove(book.active)
        for title in ("First", "Second"):
            sheet = book.create_sheet(title)
            sheet.append(["Motor", "Current"])
            for row in zip(*loading()[1:], strict=True):
                sheet.append(row)
        book.save(file)
        own = 'part = true\ncolumns = {time = "", deflection = "+Motor", force = "+Current"}\n'
        settings = "".join(f'[files."a.xlsx@trial{n}"]\n{own}' for n in (1, 2))
        (tmp_path / "recording.toml").write_text(settings, encoding="utf-8")
        both = tuple(tmp_path / f"a.xlsx@trial{n}" for n in (1, 2))
        assert recording_files([file])[0] == both
        assert recording_files([tmp_path])[0] == both

    def test_every_export_of_a_press(self, shared: Path) -> None:
        files = [f for f in (shared / "recordings" / "press_exports").iterdir() if f.suffix in LOADERS]
        assert files
        assert [file.name for file in files if why_no_recording(file) is not None] == []
