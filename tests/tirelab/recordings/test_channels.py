"""The names of channels as options give them, in which unit they are, and where the surface's radius is told."""

import math
from pathlib import Path

import numpy as np
import pytest
from house_form import edited, loading, refusal, write_rows
from tirelab.recordings.channels import assignments_text, parse_columns, parse_units, units_stated
from tirelab.recordings.recording import RecordingError, read_recording


class TestColumns:
    def test_columns_are_named_as_on_the_command_line(self) -> None:
        assert parse_columns('deflection=Stroke,force="Load cell"') == {
            "deflection": "Stroke",
            "force": "Load cell",
        }
        assert parse_columns("Force='F, left [N]', time = #1") == {"force": "F, left [N]", "time": "#1"}
        time = "Temps d'essai"
        for text in (f"time={time},force=F", f'time="{time}",force=F', f"time='{time}',force=F"):
            assert parse_columns(text) == {"time": time, "force": "F"}
        assert parse_columns(assignments_text({"time": time, "force": "a'b\"c,d'e"}))["force"] == "a'b\"c,d'e"
        assert parse_columns("temperature=") == {"temperature": ""}
        assert parse_units("time=ms,deflection=mm") == {"time": "ms", "deflection": "mm"}

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("deflection", "has no ="),
            ("stroke=x", "is no channel"),
            ("force=a,force=b", "given twice"),
            ('force="a', "not closed"),
        ],
    )
    def test_a_wrong_assignment_is_told(self, text: str, said: str) -> None:
        with pytest.raises(RecordingError, match=said):
            parse_columns(text)


class TestUnitsOfColumns:
    def test_a_column_may_be_headed_by_a_quantity_over_its_unit(self, tmp_path: Path) -> None:
        """As ISO 80000 and German machines write it: s is the way here and not the seconds below t."""
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "t / s,s / mm,F / kN", time, 10.0 * deflection, 1e-3 * force)
        read = read_recording(path, radius="flat")
        np.testing.assert_allclose(read.deflection, 1e-2 * deflection, rtol=1e-5)
        np.testing.assert_allclose(read.force, force, rtol=1e-5)

    def test_a_unit_may_end_the_name(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time_s,deflection_cm,force_N", *loading())
        assert read_recording(path, radius="flat").deflection.max() == pytest.approx(0.025)

    def test_the_number_of_an_input_may_stand_before_each_name(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        names = "C_1_Temps[s],C_1_D\u00e9placement[mm],C_1_Force[kN]"
        path = write_rows(tmp_path / "a.csv", names, time, 10.0 * deflection, 1e-3 * force)
        read = read_recording(path, radius="flat")
        np.testing.assert_allclose(read.time, time, rtol=1e-5)
        np.testing.assert_allclose(read.force, force, rtol=1e-5)

    def test_a_depth_is_the_deflection_where_nothing_else_is(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "Time [s],Load [N],Depth [cm]", time, force, deflection)
        np.testing.assert_allclose(
            read_recording(path, radius="flat").deflection, 1e-2 * deflection, rtol=1e-5
        )

    def test_a_missing_unit_is_told(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection,force [N]", *loading())
        said = refusal(path, radius="flat")
        assert "column 'deflection': has no unit" in said
        assert "--units deflection=cm" in said
        assert read_recording(
            path, radius="flat", units={"deflection": "mm"}
        ).deflection.max() == pytest.approx(0.0025)

    @pytest.mark.parametrize(
        ("unit", "said"),
        [
            ("furlongs per day", "'furlongs per day'"),
            ("kg", "kgf"),
            ("KN", "kN"),
            ("sum", "unknown unit 'sum' of force; write N, kN, lbf or kgf; then give it: --units force=N"),
        ],
    )
    def test_an_unknown_or_unfit_unit_is_told(self, tmp_path: Path, unit: str, said: str) -> None:
        path = write_rows(tmp_path / "a.csv", f"time [s],deflection [cm],force [{unit}]", *loading())
        message = refusal(path, radius="flat")
        assert f"column 'force [{unit}]'" in message
        assert said in message

    def test_a_unit_given_is_taken_before_that_of_the_file_and_said(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [m],force [N]", *loading())
        recording = read_recording(path, radius="flat", units={"deflection": "cm"})
        assert recording.deflection.max() == pytest.approx(0.025)
        assert "deflection read in cm as given, not in m" in recording.notes
        assert "'stroke' is no channel" in refusal(path, radius="flat", units={"stroke": "cm"})

    def test_millimetres_labelled_as_metres_are_not_believed(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [m],force [N]", *loading())
        said = refusal(path, radius="flat")
        assert "row 52" in said
        assert "deeper than a wheel" in said


class TestRadius:
    @pytest.mark.parametrize(
        ("given", "metres"), [("flat", math.inf), ("25.4cm", 0.254), ("-50.8 cm", -0.508), (0.381, 0.381)]
    )
    def test_a_radius_is_given(self, tmp_path: Path, given: str | float, metres: float) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force [N]", *loading())
        recording = read_recording(path, radius=given)
        np.testing.assert_array_equal(recording.surface_radius, np.full(101, metres))
        assert any(note.startswith("surface radius") for note in recording.notes)

    def test_without_a_radius_the_three_ways_are_told(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force [N]", *loading())
        said = refusal(path)
        assert all(way in said for way in ("column such as radius [cm]", "--radius flat", "recording.toml"))

    def test_a_radius_given_is_taken_before_a_column_and_said(self, rig: Path) -> None:
        recording = read_recording(rig, radius="25.4cm")
        assert recording.surface_radius[0] == 0.254
        assert any("not taken from 'radius [cm]'" in note for note in recording.notes)

    def test_flat_may_be_a_word_or_minus_infinity_in_a_column(self, rig: Path) -> None:
        text = rig.read_text(encoding="utf-8").replace("inf", "flat", 50).replace("inf", "-inf", 10)
        rig.write_text(text, encoding="utf-8")
        assert np.all(read_recording(rig).surface_radius == np.inf)

    def test_a_radius_of_zero_is_refused_with_its_row(self, rig: Path) -> None:
        assert "row 7, column 'radius [cm]': 0 is no radius" in refusal(edited(rig, 7, "1.0,0.25,0,80"))

    @pytest.mark.parametrize("given", ["25.4", "0cm", "wide", "3 kg"])
    def test_a_radius_that_cannot_be_is_refused(self, tmp_path: Path, given: str) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force [N]", *loading())
        refusal(path, radius=given)


class TestUnitsAboveTheTable:
    def test_a_unit_belongs_to_the_channel_that_it_measures(self) -> None:
        lines = ("3/5/2025  10:16 AM", "Units: N", "X-Axis: Travel", "Travel Unit: mm", "Einheit = bar")
        assert units_stated(lines) == {"deflection": "mm", "force": "N", "pressure": "bar"} | {
            "believed_force": "N"
        }

    def test_of_two_units_of_one_quantity_none_is_believed(self) -> None:
        assert units_stated(("Units: N", "Peak Units: kN", "Unit test: passed", "Community: mm")) == {}

    def test_a_file_is_read_with_them_and_says_so(self, tmp_path: Path) -> None:
        """The export of a stand for force gauges: units above the table, none in its header."""
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "Time,Travel,Load", time, 10.0 * deflection, force)
        path.write_text("Units: N\nX-Axis: Travel\nTravel Unit: mm\n" + path.read_text())
        recording = read_recording(path, radius="flat", units={"time": "s"})
        np.testing.assert_allclose(recording.force, force, rtol=1e-5, atol=1e-3)
        np.testing.assert_allclose(recording.deflection, 0.01 * deflection, rtol=1e-4, atol=1e-7)
        assert "force in N, as the lines above the table say" in recording.notes
        other = read_recording(path, radius="flat", units={"time": "s", "force": "kN"})
        np.testing.assert_allclose(other.force, 1000.0 * force, rtol=1e-5, atol=1.0)
