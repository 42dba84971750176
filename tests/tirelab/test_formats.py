"""One recording in every format: read as the same numbers, and refused in one sentence when it is damaged."""

import builtins
import datetime
import importlib
import math
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import scipy.io
from tirelab.formats import LOADERS
from tirelab.recording import Recording, RecordingError, read_recording

SAMPLES = 200
TIME = np.arange(SAMPLES) / 100.0
DEFLECTION = 12.5 * (1.0 - np.cos(2.0 * np.pi * TIME))
FORCE = 0.5509 * (DEFLECTION / 10.0) ** 1.422
HEADERS = ("time [s]", "deflection [mm]", "force [kN]")
COLUMNS = dict(zip(HEADERS, (TIME, DEFLECTION, FORCE), strict=True))
UNITS = {"time": "s", "deflection": "mm", "force": "kN"}


def text_table(separator: str, comma: bool = False) -> str:
    rows = [separator.join(repr(float(v)) for v in row) for row in zip(*COLUMNS.values(), strict=True)]
    body = "\n".join(rows)
    return separator.join(HEADERS) + "\n" + (body.replace(".", ",") if comma else body) + "\n"


def assert_the_recording(recording: Recording, *notes: str, digits: float = 3e-16) -> None:
    np.testing.assert_array_equal(recording.time, TIME)
    # Written exactly in mm and kN: one rounding in each conversion is what may differ.
    np.testing.assert_allclose(recording.deflection, DEFLECTION / 1000.0, rtol=digits)
    np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=digits)
    assert recording.notes == (*notes, "surface radius flat as given")


def refusal(path: Path, **options: Any) -> str:
    with pytest.raises(RecordingError) as caught:
        read_recording(path, **{"radius": "flat", **options})
    assert "\n" not in str(caught.value)
    return str(caught.value)


class TestText:
    @pytest.mark.parametrize(
        ("suffix", "separator", "comma", "note"),
        [
            (".csv", ",", False, ()),
            (".csv", ";", False, ()),
            (".csv", ";", True, ("commas read as decimal commas",)),
            (".tsv", "\t", False, ()),
            (".txt", "\t", True, ("commas read as decimal commas",)),
        ],
    )
    def test_separators_and_decimal_marks(
        self, tmp_path: Path, suffix: str, separator: str, comma: bool, note: tuple[str, ...]
    ) -> None:
        path = tmp_path / f"a{suffix}"
        path.write_text(text_table(separator, comma), encoding="utf-8")
        assert_the_recording(read_recording(path, radius="flat"), *note)

    @pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32"])
    def test_encodings_that_say_what_they_are(self, tmp_path: Path, encoding: str) -> None:
        path = tmp_path / "a.csv"
        path.write_text(text_table(";", comma=True), encoding=encoding)
        assert_the_recording(read_recording(path, radius="flat"), "commas read as decimal commas")

    def test_encodings_that_do_not(self, tmp_path: Path) -> None:
        path = tmp_path / "a.csv"
        path.write_bytes(text_table(",").encode("utf-16-le"))
        assert_the_recording(read_recording(path, radius="flat"), "read as UTF-16 without a byte order mark")
        path.write_bytes(("# Prüfstand µ\n" + text_table(",")).encode("latin-1"))
        (note,) = [n for n in read_recording(path, radius="flat").notes if "Latin-1" in n]
        assert note == "not UTF-8 (byte 0xfc at 4): read as Latin-1"

    @pytest.mark.parametrize("end", ["\r\n", "\r"])
    def test_line_ends(self, tmp_path: Path, end: str) -> None:
        path = tmp_path / "a.csv"
        path.write_bytes(text_table(",").replace("\n", end).encode())
        assert_the_recording(read_recording(path, radius="flat"))
        path.write_bytes(text_table(",").rstrip("\n").replace("\n", end).encode())
        assert_the_recording(read_recording(path, radius="flat"))

    def test_quotes_comments_a_declared_separator_and_a_row_of_units(self, tmp_path: Path) -> None:
        lines = text_table(";").splitlines()
        lines[0] = '"time";"tire\ndeflection";"force"'
        lines.insert(1, "s;mm;kN")
        path = tmp_path / "a.csv"
        path.write_text("sep=;\n# run 5\n\n" + "\n".join(lines) + "\n# end\n\n\n", encoding="utf-8")
        assert_the_recording(
            read_recording(path, radius="flat"),
            "units taken from row 6, below the names",
            "comment lines (#) skipped: row 207",
            "skipped as empty: row 208, row 209",
        )

    def test_names_in_a_comment_above_the_numbers(self, tmp_path: Path) -> None:
        path = tmp_path / "a.csv"
        np.savetxt(
            path, np.column_stack(list(COLUMNS.values())), "%.17g", delimiter=",", header=",".join(HEADERS)
        )
        assert_the_recording(
            read_recording(path, radius="flat"), "column names taken from the comment in row 1"
        )

    def test_quoted_numbers_and_columns_of_text_beside_them(self, tmp_path: Path) -> None:
        samples = zip(*(column.tolist() for column in COLUMNS.values()), strict=True)
        rows = [f'"{t!r}","a, ""b""\nc",{x!r},"{f!r}"' for t, x, f in samples]
        path = tmp_path / "a.csv"
        path.write_text(
            "time [s],remark,deflection [mm],force [kN]\n" + "\n".join(rows) + "\n", encoding="utf-8"
        )
        assert_the_recording(read_recording(path, radius="flat"))
        path.write_text(path.read_text(encoding="utf-8").replace('"0.05"', '"x"'), encoding="utf-8")
        # Each row takes two lines of the file: the sixth row starts in line 12.
        assert "row 12, column 'time [s]': 'x' is not a number" in refusal(path)

    def test_a_whole_file_of_commas_that_may_mark_thousands_is_not_guessed_at(self, tmp_path: Path) -> None:
        path = tmp_path / "a.tsv"
        rows = [f"{i}\t{i}\t{'1,0' if i > 4 else '9'}{i:02d}" for i in range(10)]
        path.write_text("time [s]\tdeflection [mm]\tforce [N]\n" + "\n".join(rows) + "\n", encoding="utf-8")
        assert "row 7, column 'force [N]': '1,005' may have a decimal comma or a thousands mark" in refusal(
            path
        )

    def test_two_decimal_marks_in_one_file_are_refused(self, tmp_path: Path) -> None:
        path = tmp_path / "a.csv"
        path.write_text("time [s];x [mm];F [N]\n0.5;1.5;2\n1.5;2,5;3\n", encoding="utf-8")
        assert "row 3, column 'x [mm]': '2,5' has the decimal mark ',' and row 2 has '.'" in refusal(path)

    def test_a_file_of_many_blocks_is_read_like_one_of_few(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        path = tmp_path / "a.csv"
        path.write_text(text_table(",").replace("0.5,", "0.5,x"), encoding="utf-8")
        whole = refusal(path)
        path.write_text(text_table(","), encoding="utf-8")
        monkeypatch.setattr("tirelab.formats.delimited.BLOCK", 100)
        assert_the_recording(read_recording(path, radius="flat"))
        path.write_text(text_table(",").replace("0.5,", "0.5,x"), encoding="utf-8")
        assert refusal(path) == whole
        path.write_text(text_table(","), encoding="utf-16")
        assert_the_recording(read_recording(path, radius="flat"))

    def test_a_decimal_comma_that_comes_late_is_understood(self, tmp_path: Path) -> None:
        path = tmp_path / "a.csv"
        rows = [f"{i};{i % 9};{i % 9}" for i in range(2000)]
        path.write_text("time [s];x [mm];F [N]\n" + "\n".join(rows) + "\n2000;1,5;3,25\n", encoding="utf-8")
        recording = read_recording(path, radius="flat")
        assert recording.force[-1] == 3.25
        assert "commas read as decimal commas" in recording.notes


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


class TestMatlab:
    def test_vectors_structs_and_matrices(self, tmp_path: Path) -> None:
        path = tmp_path / "a.mat"
        matrix = np.column_stack([DEFLECTION, DEFLECTION * 0.0, FORCE])
        scipy.io.savemat(
            path, {"t": TIME, "run": {"cell": {"F": FORCE}}, "x_F": matrix, "note": "rig 5", "Ts": 0.01}
        )
        named = {"time": "t", "deflection": "x_F:0", "force": "x_F:2"}
        assert_the_recording(read_recording(path, columns=named, units=UNITS, radius="flat"))
        named["force"] = "run.cell.F"
        assert_the_recording(read_recording(path, columns=named, units=UNITS, radius="flat"))

    def test_matrices_that_lie_on_their_side(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"m": np.vstack(list(COLUMNS.values()))})
        named = {"time": "m:0", "deflection": "m:1", "force": "m:2"}
        assert_the_recording(read_recording(tmp_path / "a.mat", columns=named, units=UNITS, radius="flat"))

    def test_vectors_of_unequal_length_are_refused(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"time": TIME, "deflection": DEFLECTION, "force": FORCE[::2]})
        assert "unequal numbers of samples ('time' 200, 'deflection' 200, 'force' 100)" in refusal(
            tmp_path / "a.mat", units=UNITS
        )

    def test_complex_numbers_are_refused(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"time": TIME, "deflection": DEFLECTION, "force": FORCE * 1j})
        assert "complex numbers" in refusal(tmp_path / "a.mat", units=UNITS)

    def test_version_7_3_is_asked_to_be_saved_again(self, tmp_path: Path) -> None:
        (tmp_path / "a.mat").write_bytes(
            b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + b"\x89HDF\r\n\x1a\n"
        )
        assert "save(..., '-v7')" in refusal(tmp_path / "a.mat")


class TestMdf:
    @pytest.fixture
    def path(self, tmp_path: Path) -> Path:
        asammdf = pytest.importorskip("asammdf")
        signal = asammdf.Signal
        slow = slice(None, None, 10)
        with asammdf.MDF(version="4.10") as mdf:
            invalid = np.arange(SAMPLES) == 8
            mdf.append(
                [
                    signal(DEFLECTION, TIME, unit="mm", name="Stroke"),
                    signal(FORCE, TIME, unit="kN", name="Load"),
                    signal(FORCE, TIME, unit="kN", name="Flagged", invalidation_bits=invalid),
                ]
            )
            mdf.append([signal(FORCE[slow], TIME[slow], unit="kN", name="Slow")])
            mdf.append([signal(FORCE, TIME + 0.005, unit="kN", name="Late")])
            mdf.append([signal(FORCE, TIME, name="Stroke")])
            mdf.save(tmp_path / "a.mf4")
        return tmp_path / "a.mf4"

    def test_channels_with_the_units_and_the_time_of_the_file(self, path: Path) -> None:
        columns = {"deflection": "0/Stroke", "force": "Load"}
        assert_the_recording(read_recording(path, columns=columns, radius="flat"))

    def test_samples_marked_invalid_are_blanks(self, path: Path) -> None:
        recording = read_recording(
            path, columns={"deflection": "0/Stroke", "force": "Flagged"}, radius="flat"
        )
        assert len(recording) == SAMPLES - 1
        assert "skipped for want of force: sample 9" in recording.notes

    @pytest.mark.parametrize(
        ("force", "said"), [("Slow", "unequal numbers"), ("Late", "sampled at different times")]
    )
    def test_channels_of_other_times_are_not_resampled(self, path: Path, force: str, said: str) -> None:
        assert said in refusal(path, columns={"deflection": "0/Stroke", "force": force})


class TestTdms:
    @pytest.fixture
    def path(self, tmp_path: Path) -> Path:
        nptdms = pytest.importorskip("nptdms")
        clock = {"wf_increment": 0.01, "wf_start_offset": 0.0}
        with nptdms.TdmsWriter(tmp_path / "a.tdms") as writer:
            writer.write_segment(
                [
                    nptdms.ChannelObject(
                        "rig", "Stroke", DEFLECTION, properties={**clock, "unit_string": "mm"}
                    ),
                    nptdms.ChannelObject("rig", "Load", FORCE, properties={**clock, "unit_string": "kN"}),
                    nptdms.ChannelObject("rig", "Force (kN)", FORCE, properties={"wf_increment": 0.01}),
                    nptdms.ChannelObject("slow", "Slow", FORCE[::10], properties={"unit_string": "kN"}),
                    nptdms.ChannelObject(
                        "slow", "Late", FORCE, properties={"wf_increment": 0.02, "unit_string": "kN"}
                    ),
                    nptdms.ChannelObject("slow", "Clock", TIME, properties={"unit_string": "s"}),
                    nptdms.ChannelObject("slow", "Remark", ["a"] * SAMPLES),
                ]
            )
        return tmp_path / "a.tdms"

    @pytest.mark.parametrize("force", ["Load", "Force"])
    def test_channels_with_units_and_waveform_time(self, path: Path, force: str) -> None:
        columns = {"deflection": "Stroke", "force": force}
        recording = read_recording(path, columns=columns, radius="flat")
        np.testing.assert_allclose(recording.time, TIME, atol=1e-15)
        np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=3e-16)

    def test_time_in_a_channel(self, path: Path) -> None:
        columns = {"time": "Clock", "deflection": "Stroke", "force": "Load"}
        assert_the_recording(read_recording(path, columns=columns, radius="flat"))

    @pytest.mark.parametrize(
        ("force", "said"),
        [
            ("Slow", "unequal numbers"),
            ("Late", "start or step differently"),
            ("Remark", "holds text, 'a' the first"),
        ],
    )
    def test_other_channels_are_refused(self, path: Path, force: str, said: str) -> None:
        assert said in refusal(path, columns={"deflection": "Stroke", "force": force}, units={"force": "N"})


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


class TestEveryFormat:
    @pytest.mark.parametrize(
        "suffix", [suffix for suffix in LOADERS if suffix not in (".csv", ".dat", ".asc")]
    )
    def test_an_empty_or_damaged_file_is_told_in_one_sentence(self, tmp_path: Path, suffix: str) -> None:
        path = tmp_path / f"a{suffix}"
        path.write_bytes(b"")
        assert "is empty" in refusal(path)
        for content in (
            b"MDF     4.10    ",
            b"PK\x03\x04" + b"\x00" * 60,
            b"PAR1" * 9,
            b"TDSm" + b"\xff" * 40,
            b"\x00" * 300,
        ):
            path.write_bytes(content)
            assert path.name in refusal(path)

    @pytest.mark.parametrize(
        ("start", "said"),
        [
            (b"PK\x03\x04", "Excel"),
            (b"\x1f\x8b", "gzip"),
            (b"PAR1", "Parquet"),
            (b"\x00", "not text"),
        ],
    )
    def test_what_only_calls_itself_csv_is_told(self, tmp_path: Path, start: bytes, said: str) -> None:
        (tmp_path / "a.csv").write_bytes(start + b"\x00\x01" * 20)
        assert said in refusal(tmp_path / "a.csv")

    @pytest.mark.parametrize(("name", "said"), [("a.xls", ".xlsx"), ("a.hdf5", "'.hdf5'"), ("a", "''")])
    def test_a_suffix_that_cannot_be_read_is_told(self, tmp_path: Path, name: str, said: str) -> None:
        (tmp_path / name).write_bytes(b"anything")
        assert said in refusal(tmp_path / name)

    @pytest.mark.parametrize(
        ("suffix", "module", "extra"),
        [(".mf4", "asammdf", "mdf"), (".tdms", "nptdms", "tdms"), (".xlsx", "openpyxl", "excel")],
    )
    def test_a_library_that_is_not_installed_is_named_with_its_extra(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, module: str, extra: str
    ) -> None:
        def absent(name: str) -> object:
            if name == module:
                raise ImportError(name)
            return builtins.__import__(name)

        monkeypatch.setattr(importlib, "import_module", absent)
        (tmp_path / f"a{suffix}").write_bytes(b"anything")
        said = refusal(tmp_path / f"a{suffix}")
        assert module in said
        assert f"pip install 'tirelab[{extra}]'" in said
