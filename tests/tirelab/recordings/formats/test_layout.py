"""The table is found below any lines, in any language and encoding, and nothing of a clean file changes."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tirelab.recordings.formats.clock import Clock, ClockError, is_clock
from tirelab.recordings.formats.layout import find_layout
from tirelab.recordings.formats.number_style import NumberStyle, style_of
from tirelab.recordings.recording import RecordingError, read_recording

X = 20.0 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 81)))
F = 900.0 * (X / 10.0) ** 1.45
T = np.arange(81) / 10.0
SIGNED = {"deflection": "+Stroke", "force": "+Load"}


def rows(separator: str = ";", comma: bool = True, number: str = "{:.3f}") -> str:
    lines = [separator.join(number.format(v) for v in row) for row in zip(T, X, F, strict=True)]
    text = "\n".join(lines) + "\n"
    return text.replace(".", ",") if comma else text


def read(path: Path, text: str, encoding: str = "utf-8", **options: object) -> object:
    path.write_bytes(text.encode(encoding))
    return read_recording(path, radius="flat", **options)  # type: ignore[arg-type]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "press.csv"


PREAMBLES = (
    "",
    "Results Table 1\n\n",
    "Machine;Instron 5565\nOperator;A. B.\nDate;03.06.2025\nPreload;5;N\n\n",
    'Test;"Tire 2,1"" at 30 psi"\nSpeed;2;mm/s\n',
    # a table of results above the table of readings
    "Specimen;Max load;Max travel\n1;2458,9;20,0\n\n",
    'Tire;2.1" wide; "open quote\nA;b;c\n',
)


class TestPreamble:
    @pytest.mark.parametrize("preamble", PREAMBLES)
    def test_the_table_is_found_below_it(self, path: Path, preamble: str) -> None:
        text = preamble + "Zeit [s];Weg [mm];Kraft [N]\n" + rows()
        recording = read(path, text)
        np.testing.assert_allclose(recording.force, np.round(F, 3))
        layout = find_layout(path)
        assert layout.table_line == preamble.count("\n") + 1
        kept = [line for line in preamble.splitlines() if line.strip(" ;")]
        assert len(recording.provenance) == len(kept)

    def test_a_broken_first_row_is_not_taken_for_a_header(self, path: Path) -> None:
        path.write_text("Zeit [s];Weg [mm];Kraft [N]\n0,0;oops;0,0\n" + rows(), encoding="utf-8")
        with pytest.raises(RecordingError, match=r"row 2, column 'Weg \[mm\]': 'oops' is not a number"):
            read_recording(path, radius="flat")

    def test_rows_to_skip_are_obeyed(self, path: Path) -> None:
        text = "Zeit [s];Weg [mm];Kraft [N]\n1;2;3\n2;3;4\nt;Hub;Kraft\ns;mm;kN\n" + rows()
        recording = read(path, text, skip_rows=3, columns={"time": "t"})
        assert recording.force.max() == pytest.approx(1000.0 * F.max(), rel=1e-6)
        with pytest.raises(RecordingError, match="no table below its first 500 rows"):
            read_recording(path, radius="flat", skip_rows=500)

    def test_names_units_and_a_row_of_text_below_them(self, path: Path) -> None:
        recording = read(path, "Zeit;Weg;Kraft\nKanal 1;Kanal 2;Kanal 3\ns;mm;N\n" + rows())
        np.testing.assert_allclose(recording.deflection, np.round(X, 3) / 1000.0)
        assert "units taken from row 3, below the names" in recording.notes
        assert "text between the names and the numbers skipped: row 2" in recording.notes

    @pytest.mark.parametrize(
        "units",
        [
            '"(s)";"(mm)";"(N)";"(MPa)";"(N/tex)";"(mm/mm)";',
            "(s);(mm);(N);(%);(°);(count);",
            "s;mm;N;V;N/mm;deg;",
        ],
    )
    def test_units_of_columns_that_are_no_channels_are_units_too(self, path: Path, units: str) -> None:
        names = "Zeit;Weg;Kraft;Tensile stress;Tenacity;Tensile strain (Extension);Count"
        numbers = "\n".join(f"{line};1,5;2,5;3,5;4" for line in rows().splitlines())
        recording = read(path, f"{names}\n{units}\n{numbers}\n")
        np.testing.assert_allclose(recording.deflection, np.round(X, 3) / 1000.0)
        np.testing.assert_allclose(recording.force, np.round(F, 3))
        assert "units taken from row 2, below the names" in recording.notes


class TestLanguages:
    @pytest.mark.parametrize(
        ("header", "encoding"),
        [
            ("Prüfzeit [s];Traversenweg [mm];Prüfkraft [N]", "latin-1"),
            ("Zeit in s;Weg in mm;Kraft in N", "utf-8"),
            ("Temps (s);Déplacement traverse (mm);Effort (N)", "latin-1"),
            ("Tiempo (s);Desplazamiento (mm);Fuerza (N)", "utf-16"),
            ("Tiempo / s;Deformación / mm;Carga / N", "utf-8-sig"),
            ("时间 (s);位移 (mm);试验力 (N)", "gbk"),
            ("Time, s;Crosshead, mm;Compressive load, N", "utf-16-le"),
            ("Time 1 [s];Weg 1 [mm];Kraft 1 [N]", "utf-8"),
        ],
    )
    def test_names_of_channels(self, path: Path, header: str, encoding: str) -> None:
        recording = read(path, f"{header}\n{rows()}", encoding)
        np.testing.assert_allclose(recording.time, np.round(T, 3))
        np.testing.assert_allclose(recording.deflection, np.round(X, 3) / 1000.0)
        np.testing.assert_allclose(recording.force, np.round(F, 3))

    def test_our_own_names_go_before_foreign_ones(self, path: Path) -> None:
        lines = rows().splitlines()
        text = "Time [s];Stroke [mm];Load [N];Weg [mm];Kraft [N]\n"
        text += "\n".join(f"{line};1{line.split(';')[1]};{line.split(';')[2]}" for line in lines)
        np.testing.assert_allclose(read(path, text).deflection, np.round(X, 3) / 1000.0)


class TestNumbers:
    @pytest.mark.parametrize(
        ("cells", "style"),
        [
            (["0,5", "1.234,5"], NumberStyle(True, ".")),
            (["0.5", "1,234.5"], NumberStyle(False, ",")),
            (["1 234,5"], NumberStyle(True, " ")),
            (["1\u202f234,5"], NumberStyle(True, "\u202f")),
            (["1'234.5"], NumberStyle(False, "'")),
            (["1.234.567"], NumberStyle(True, ".")),
            (["1,234"], NumberStyle()),
            (["0,25"], NumberStyle(True)),
        ],
    )
    def test_marks(self, cells: list[str], style: NumberStyle) -> None:
        assert style_of(cells) == style

    @pytest.mark.parametrize(
        ("decimal", "thousands", "separator"),
        [
            (",", ".", ";"),
            (".", ",", ";"),
            (".", ",", "\t"),
            (",", " ", ";"),
            (".", "'", ";"),
            (".", ",", ","),
        ],
    )
    @pytest.mark.parametrize("comment", ["", "# one comment sends the file to the reader of rows\n"])
    def test_thousands(self, path: Path, decimal: str, thousands: str, separator: str, comment: str) -> None:
        def cell(value: float) -> str:
            text = f"{value:,.2f}".replace(",", "T").replace(".", decimal).replace("T", thousands)
            return f'"{text}"' if separator in text else text

        lines = [separator.join(map(cell, row)) for row in zip(T, X, F, strict=True)]
        header = separator.join(["Zeit [s]", "Weg [mm]", "Kraft [N]"])
        recording = read(path, "\n".join([header, *lines]) + "\n" + comment)
        np.testing.assert_allclose(recording.force, np.round(F, 2))
        assert f"{thousands!r} read as the mark between thousands" in recording.notes

    def test_clean_columns_are_not_read_row_by_row(self, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        stamps = [f"2025-06-03T14:05:{t:06.3f};{x:.3f};{f:,.3f}" for t, x, f in zip(T, X, F, strict=True)]
        text = "Zeit;Weg [mm];Kraft [N]\n" + "\n".join(stamps) + "\n"
        plain = read(path, text + "# one comment\n")

        def never(*_: object) -> None:
            raise AssertionError("read row by row")

        monkeypatch.setattr("tirelab.recordings.formats.careful.RowReader.read", never)
        monkeypatch.setattr("tirelab.recordings.formats.delimited.BLOCK", 500)
        recording = read(path, text)
        np.testing.assert_array_equal(recording.time, plain.time)
        np.testing.assert_array_equal(recording.force, plain.force)

    def test_a_second_decimal_mark_is_refused_among_thousands_too(self, path: Path) -> None:
        path.write_text("Zeit [s];Weg [mm];Kraft [N]\n" + rows() + "9,0;1.234,5;1.5\n", encoding="utf-8")
        with pytest.raises(RecordingError, match=r"row 83.*'1\.5' has the decimal mark"):
            read_recording(path, radius="flat")


class TestGauges:
    """Hand-held gauges put a unit behind every number, in a column of its own, and settings above the table."""

    def text(self, unit: str = "gf") -> str:
        lines = [
            f"{i},{f:.1f},{'gf' if i < 60 else unit},{x:.3f},mm,OK,--,9:59:{i // 10:02d} AM,7/3/2025,"
            for i, (x, f) in enumerate(zip(X, F, strict=True))
        ]
        above = "Maximum,191.4,@,No.60,,,,,,\nData Quantity,81,,,,,,,,\n"
        return (
            above + "No.,Force,Unit,Displacement,Unit,Judge,Position,Time,Date,\n" + "\n".join(lines) + "\n"
        )

    def test_units_in_columns_of_their_own(self, path: Path) -> None:
        recording = read(path, self.text(), columns={"time": ""})
        np.testing.assert_allclose(recording.force, np.round(F, 1) * 9.80665e-3, rtol=1e-12)
        np.testing.assert_allclose(recording.deflection, np.round(X, 3) / 1e3, rtol=1e-12)
        assert "units taken from the columns beside: gf, mm" in recording.notes
        assert recording.provenance[0] == "Maximum,191.4,@,No.60"

    def test_another_unit_further_down_is_refused(self, path: Path) -> None:
        path.write_text(self.text("kgf"), encoding="utf-8")
        with pytest.raises(
            RecordingError, match=r"row 64, column 'Force': the unit is 'kgf' here and 'gf' above"
        ):
            read_recording(path, radius="flat", columns={"time": ""})

    def test_settings_above_numbers_without_names(self, path: Path) -> None:
        above = "MAX FORCE = 194.1,4.230\nUNIT = gf,mm\nRECORDING RATE = 0.0005,\n1ST PEAK = ---,---\n"
        text = above + "".join(f"{f:.1f},{x:.3f}\n" for x, f in zip(X, F, strict=True))
        path.write_text(text, encoding="utf-8")
        with pytest.raises(RecordingError) as caught:
            read_recording(path, radius="flat")
        assert str(caught.value).endswith("by number: --columns deflection=#2,force=#1")
        recording = read(path, text, columns={"deflection": "#2", "force": "#1"})
        np.testing.assert_allclose(recording.force, np.round(F, 1) * 9.80665e-3, rtol=1e-12)
        assert len(recording) == len(F)


class TestThousandsBeyondTheHeadOfTheFile:
    """A machine marks thousands from the row on where the force, or the time, exceeds 1,000."""

    FORCE = np.concatenate(
        [np.full(800, 0.125), np.linspace(0.5, 1234.5, 800), np.linspace(1234.5, 0.5, 800)]
    )

    def text(self, decimal: str, thousands: str, separator: str, quote: str = "") -> str:
        def cell(value: float) -> str:
            text = f"{value:,.3f}".replace(",", "T").replace(".", decimal).replace("T", thousands)
            return f"{quote}{text}{quote}"

        lines = [separator.join(map(cell, (i, i % 20, f))) for i, f in enumerate(self.FORCE)]
        return "\n".join([separator.join(("Time [s]", "Stroke [mm]", "Load [N]")), *lines]) + "\n"

    @pytest.mark.parametrize(
        ("decimal", "thousands", "separator", "quote"),
        [
            (".", ",", ",", '"'),
            (".", ",", ";", ""),
            (",", ".", ";", ""),
            (".", "'", ",", ""),
            (",", "\u202f", "\t", ""),
        ],
    )
    @pytest.mark.parametrize("comment", ["", "# one comment sends the file to the reader of rows\n"])
    def test_they_are_read(
        self, path: Path, decimal: str, thousands: str, separator: str, quote: str, comment: str
    ) -> None:
        recording = read(path, self.text(decimal, thousands, separator, quote) + comment, columns=SIGNED)
        np.testing.assert_allclose(recording.force, np.round(self.FORCE, 3))
        np.testing.assert_array_equal(recording.time, np.arange(len(self.FORCE)))
        assert f"{thousands!r} read as the mark between thousands" in recording.notes

    def test_a_damaged_number_does_not_make_thousands_of_decimals(self, path: Path) -> None:
        text = self.text(".", "", ",").replace("\n1500.000,", "\n1.234.567,")
        path.write_text(text, encoding="utf-8")
        with pytest.raises(RecordingError, match=r"'1\.234\.567' is not a number"):
            read_recording(path, radius="flat", columns=SIGNED)

    def test_what_may_be_either_is_refused_as_before(self, path: Path) -> None:
        path.write_text(self.text(".", "", ",").replace(",0.125\n", ',"1,234"\n', 1), encoding="utf-8")
        with pytest.raises(RecordingError, match="'1,234' is not a number"):
            read_recording(path, radius="flat", columns=SIGNED)


class TestClocks:
    @pytest.mark.parametrize(
        ("texts", "seconds"),
        [
            (["2025-06-03T14:05:00.000", "2025-06-03T14:05:00.100"], 0.1),
            (["03.06.2025 14:05:00,5", "03.06.2025 14:05:01,25"], 0.75),
            (["6/3/2025 11:59:59.5 PM", "6/4/2025 12:00:00.5 AM"], 1.0),
            (["31/05/2025 23:59:59", "01/06/2025 00:00:01"], 2.0),
            (["23:59:59.25", "24:00:00.25"], 1.0),
            (["9:59:59 AM", "10:00:01 AM"], 2.0),
            (["11:59:59.5 am", "12:00:01 pm"], 1.5),
            (["00:01.5", "01:02.0"], 60.5),
            (["31-May-2025 23:59:59", "01-Jun-2025 00:00:01"], 2.0),
            (["03-OCT-2025 14:05:00.1", "03-OCT-2025 14:05:01.6"], 1.5),
            (["2025-06-03 14:05:00Z", "2025-06-03 14:05:00.000000001Z"], 1e-9),
            (["2024-10-27T02:59:59+02:00", "2024-10-27T02:00:01+01:00"], 2.0),
            (["2025-06-03 00:05:00-0330", "2025-06-03 04:35:00 +01"], 0.0),
        ],
    )
    def test_seconds_from_the_first(self, texts: list[str], seconds: float) -> None:
        assert all(map(is_clock, texts))
        np.testing.assert_allclose(Clock().seconds(pl.Series(texts)), [0.0, seconds], rtol=1e-12)

    def test_blanks_are_nan_and_pieces_count_from_the_first(self) -> None:
        clock = Clock()
        np.testing.assert_array_equal(clock.seconds(pl.Series(["", "10:00:01"])), [np.nan, 0.0])
        np.testing.assert_array_equal(clock.seconds(pl.Series(["10:00:03", None])), [2.0, np.nan])

    def test_what_is_no_time_is_named(self) -> None:
        with pytest.raises(ClockError) as caught:
            Clock().seconds(pl.Series(["10:00:01", "soon", "10:00:03"]))
        assert caught.value.index == 1

    def test_an_ambiguous_date_is_that_of_the_shorter_recording_and_said(self) -> None:
        clock = Clock()
        found = clock.seconds(pl.Series(["03/06/2025 23:00:00", "04/06/2025 01:00:00"]))
        np.testing.assert_array_equal(found, [0.0, 7200.0])
        assert clock.notes == ["dates read as day/month/year, not as month/day/year: the shorter recording"]

    @pytest.mark.parametrize("comment", ["", "# a comment\n"])
    def test_a_column_of_a_file(self, path: Path, comment: str) -> None:
        stamps = [f"2025-06-03 14:{5 + int(t) // 60:02d}:{t % 60:06.3f}" for t in T]
        lines = [
            f"{stamp};{x:.3f};{f:.3f}".replace(".", ",") for stamp, x, f in zip(stamps, X, F, strict=True)
        ]
        text = "Zeit;Weg [mm];Kraft [N]\n" + "\n".join(lines) + "\n" + comment
        np.testing.assert_allclose(read(path, text).time, T, atol=1e-9)
        lines[40] = "later" + lines[40][23:]
        path.write_text("Zeit;Weg [mm];Kraft [N]\n" + "\n".join(lines) + "\n", encoding="utf-8")
        with pytest.raises(RecordingError, match="row 42, column 'Zeit': 'later' is not a time like those"):
            read_recording(path, radius="flat")


@pytest.mark.parametrize("switch", ["False", "TRUE", "false"])
def test_a_switch_beside_numbers_makes_no_header_of_the_first_row(tmp_path: Path, switch: str) -> None:
    path = tmp_path / "a.tsv"
    path.write_text("".join(f"{0.1 * i:g}\t{2.0 * i:g}\t{switch}\t{0.5 * i:g}\n" for i in range(40)))
    columns = {"time": "#1", "deflection": "#2", "force": "#4"}
    units = {"time": "s", "deflection": "mm", "force": "N"}
    found = read_recording(path, radius="flat", columns=columns, units=units)
    assert "the file has no header row: its columns are known by number only" in found.notes
    np.testing.assert_allclose(found.force, 0.5 * np.arange(40))


def test_the_settings_above_the_end_of_a_header_name_no_columns(tmp_path: Path) -> None:
    """X_Dimension of a LabVIEW measurement file names the time once for each channel, and is as wide as the names."""
    head = (
        "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\nChannels\t2\t\t\nSamples\t50\t50\t\n"
        "X_Dimension\tTime\tTime\t\nX0\t0.0\t0.0\t\nDelta_X\t0.1\t0.1\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tDisplacement\tForce\tComment\n"
    )
    rows = "".join(f"{0.1 * i:.1f}\t{0.2 * i:.3f}\t{5.0 * i:.2f}\t\n" for i in range(50))
    (tmp_path / "a.lvm").write_text(head + rows)
    with pytest.raises(RecordingError, match="no unit for 'Displacement', 'Force'"):
        read_recording(tmp_path / "a.lvm", radius="flat")
    found = read_recording(tmp_path / "a.lvm", units={"deflection": "mm", "force": "N"}, radius="flat")
    assert found.force[-1] == 245.0
    np.testing.assert_allclose(found.time, 0.1 * np.arange(50))
    assert "X_Value is the time, as X_Dimension says" in found.notes
    (tmp_path / "b.lvm").write_text(head.replace("Time", "Frequency") + rows)
    with pytest.raises(RecordingError, match="no column for time"):
        read_recording(tmp_path / "b.lvm", units={"deflection": "mm", "force": "N"}, radius="flat")


def test_voltages_of_a_logger_are_told_as_its_channels_units(tmp_path: Path) -> None:
    head = (
        "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\tOne\n***End_of_Header***\t\nChannels\t2\t\t\n"
        "Y_Unit_Label\tVolts\tVolts\t\nX_Dimension\tTime\tTime\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tDisplacement\tForce\tComment\n"
    )
    rows = "".join(f"{0.1 * i:.1f}\t{0.02 * i:.3f}\t{0.05 * i:.3f}\t\n" for i in range(50))
    (tmp_path / "a.lvm").write_text(head + rows)
    with pytest.raises(RecordingError, match="'Volts' is not a unit of force; write the force of 1 Volts"):
        read_recording(tmp_path / "a.lvm", radius="flat")
    units = {"deflection": "10 mm", "force": "250 N"}
    found = read_recording(tmp_path / "a.lvm", units=units, radius="flat")
    assert found.force[-1] == pytest.approx(250.0 * 2.45)
    assert found.deflection[-1] == pytest.approx(0.0098)


def test_a_clock_of_two_parts_says_that_it_may_be_either(path: Path) -> None:
    lines = "".join(f"00:{i:02d};{X[i]:.3f};{F[i]:.3f}\n" for i in range(60))
    with pytest.raises(
        RecordingError, match=r"'00:00' may be hours and minutes or minutes and seconds; write it with"
    ):
        read(path, "Time;Stroke [mm];Load [N]\n" + lines)


@pytest.mark.parametrize(
    "names", ["Time;X(Absolute);F", "Time;X (step);F (sum)", "Time;Stroke (abs);Load (raw)"]
)
def test_a_word_in_brackets_is_no_unit_beside_the_one_below(path: Path, names: str) -> None:
    found = read(path, f"{names}\ns;mm;N\n" + rows())
    np.testing.assert_allclose(found.deflection, 1e-3 * X, atol=1e-6)
    np.testing.assert_allclose(found.force, F, atol=1e-3)


def test_a_unit_in_the_name_and_another_one_below_are_asked_about(path: Path) -> None:
    text = "Zeit [s];Stroke [mm];Load [N]\ns;mm;kN\n" + rows()
    with pytest.raises(
        RecordingError, match=r"'Load \[N\]': unknown unit 'N or kN' of force.*--units force=UNIT"
    ):
        read(path, text)
    assert read(path, text, units={"force": "kN"}).force.max() == pytest.approx(1e3 * F.max(), abs=1.0)
    assert read(path, text.replace("kN", "Newton")).force.max() == pytest.approx(F.max(), abs=1e-3)
