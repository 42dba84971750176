"""The recording comes the same from text of any separator, decimal mark and encoding, and what is none is refused."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from one_recording import COLUMNS, HEADERS, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording


def text_table(separator: str, comma: bool = False) -> str:
    rows = [separator.join(repr(float(v)) for v in row) for row in zip(*COLUMNS.values(), strict=True)]
    body = "\n".join(rows)
    return separator.join(HEADERS) + "\n" + (body.replace(".", ",") if comma else body) + "\n"


def test_semicolons_within_a_text_cell_part_no_table(tmp_path: Path) -> None:
    """A logger keeps the message of the controller, itself of numbers, behind the columns."""
    rows = text_table(",").splitlines()
    raw = [f"{row},DTA;0;{i};1;7" for i, row in enumerate(rows[1:])]
    path = tmp_path / "logger.csv"
    path.write_text("\n".join([rows[0] + ",raw", *raw]), encoding="ascii")
    assert_the_recording(read_recording(path, radius="flat"))


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

    @pytest.mark.parametrize(("opened", "closed"), [('="', '"'), ('"=""', '"""')])
    @pytest.mark.parametrize(("separator", "comma"), [(",", False), (",", True), (";", True), ("\t", False)])
    def test_cells_that_a_spreadsheet_leaves_as_they_are(
        self, tmp_path: Path, separator: str, comma: bool, opened: str, closed: str
    ) -> None:
        """Some programs write ="0.00", which Excel shows as it stands; saved again it is "=""0.00\"""."""
        rows = [line.split("|") for line in text_table("|", comma).splitlines()]
        text = "\n".join(separator.join(f"{opened}{cell}{closed}" for cell in row) for row in rows)
        (tmp_path / "a.csv").write_text(text + "\n", encoding="utf-8")
        notes = ("commas read as decimal commas",) if comma else ()
        assert_the_recording(read_recording(tmp_path / "a.csv", radius="flat"), *notes)

    def test_an_attribute_above_the_table_is_no_such_cell(self, tmp_path: Path) -> None:
        (tmp_path / "a.csv").write_text('# machine="press 2"\n' + text_table(","), encoding="utf-8")
        provenance = read_recording(tmp_path / "a.csv", radius="flat").provenance
        assert any('machine="press 2"' in line for line in provenance), provenance

    @pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
    @pytest.mark.parametrize("separator", [";", ","])
    def test_the_minus_of_typography(self, tmp_path: Path, encoding: str, separator: str) -> None:
        rows = [f"{i / 10}{separator}{i}{separator}{10 * i - 5}.0E+00" for i in range(60)]
        text = "\n".join([separator.join(("t [s]", "stroke [mm]", "load [N]")), *rows]) + "\n"
        (tmp_path / "a.csv").write_text(text.replace("-", "\N{MINUS SIGN}"), encoding=encoding)
        force = read_recording(tmp_path / "a.csv", radius="flat").force
        np.testing.assert_array_equal(force, 10.0 * np.arange(60) - 5.0)

    @pytest.mark.parametrize("mark", ["D", "d"])
    @pytest.mark.parametrize("separator", [";", ",", "\t", "   "])
    def test_the_exponents_of_fortran(self, tmp_path: Path, separator: str, mark: str) -> None:
        rows = [separator.join(f"{v:.4E}" for v in (0.1 * i, 1e-3 * i, 10.0 * i - 5.0)) for i in range(60)]
        text = separator.join(("t[s]", "stroke[mm]", "load[N]")) + "\n" + "\n".join(rows).replace("E", mark)
        (tmp_path / "a.csv").write_text(text)
        force = read_recording(tmp_path / "a.csv", radius="flat").force
        np.testing.assert_allclose(force, 10.0 * np.arange(60) - 5.0)

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
        monkeypatch.setattr("tirelab.recordings.formats.delimited.BLOCK", 100)
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


def test_rows_that_the_parser_loses_are_read_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, recwarn: pytest.WarningsRecorder
) -> None:
    """A parser that joins rows warns and goes on: no row is lost, and its own words are not shown."""
    path = tmp_path / "a.csv"
    path.write_text(text_table(","), encoding="utf-8")
    parse, lost = pl.read_csv, []

    def losing(*given: Any, **more: Any) -> pl.DataFrame:
        warnings.warn("CSV malformed", UserWarning, stacklevel=1)
        frame = parse(*given, **more)
        lost.append(frame.height - 2)
        return frame.head(2)

    monkeypatch.setattr(pl, "read_csv", losing)
    assert_the_recording(read_recording(path, radius="flat"))
    assert sum(lost) > 0
    assert not [w for w in recwarn if "malformed" in str(w.message)]
