"""Which column is which channel, in which unit, and where the surface's radius is told."""

import math
from pathlib import Path

import numpy as np
import pytest
from house_form import edited, loading, refusal, write_rows
from tirelab.recordings.channels import parse_columns, parse_units
from tirelab.recordings.recording import RecordingError, read_recording


class TestColumns:
    def test_columns_are_named_as_on_the_command_line(self) -> None:
        assert parse_columns('deflection=Stroke,force="Load cell"') == {
            "deflection": "Stroke",
            "force": "Load cell",
        }
        assert parse_columns("Force='F, left [N]', time = #1") == {"force": "F, left [N]", "time": "#1"}
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

    def test_a_column_is_found_whatever_its_case(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "TIME [s],Actuator [cm],Cell 2 [N]", *loading())
        columns = {"deflection": "ACTUATOR", "force": "cell 2 [n]"}
        assert len(read_recording(path, columns=columns, radius="flat")) == 101

    def test_two_columns_that_may_be_the_deflection_are_not_chosen_between(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],stroke [cm],displacement [cm],force [N]"
        path = write_rows(tmp_path / "a.csv", header, time, deflection, deflection * 2.0, force)
        said = refusal(path, radius="flat")
        assert "'stroke [cm]' (#2) and 'displacement [cm]' (#3)" in said
        assert "--columns deflection=#2" in said
        chosen = read_recording(path, radius="flat", columns={"deflection": "#3"})
        assert chosen.deflection.max() == pytest.approx(0.05)

    def test_volts_beside_the_reading_they_stand_for_are_not_chosen(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],force (V),force (N),stroke (V),stroke (mm),temp (V),temp (C)"
        values = (time, force / 200.0, force, deflection / 9.0, 10.0 * deflection, time / 50.0, time)
        found = read_recording(write_rows(tmp_path / "a.csv", header, *values), radius="flat")
        np.testing.assert_allclose(found.force, force, rtol=1e-5)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)
        assert found.temperature is not None
        np.testing.assert_allclose(found.temperature, time + 273.15)

    @pytest.mark.parametrize(
        ("stroke", "cell"),
        [
            ("Position(Actuator (0,1):Position) (cm)", "Load(Actuator (0,1):Load) (N)"),
            ("Lead Actuator Displacement [cm]", "Lead Actuator Force [N]"),
            ("actuator_stroke_cm", "upper load cell (N)"),
        ],
    )
    def test_a_channel_with_its_source_in_its_name(self, tmp_path: Path, stroke: str, cell: str) -> None:
        time, deflection, force = loading()
        header = f'time [s],"{stroke}","{cell}","Mean force so far"'
        path = write_rows(tmp_path / "a.csv", header, time, deflection, force, time)
        found = read_recording(path, radius="flat")
        np.testing.assert_allclose(found.force, force, rtol=1e-5)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)

    def test_our_own_names_go_before_foreign_ones_with_a_source_too(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],Position(A:Position) (mm),Displacement(A:Digital position) (cm),Load(A:Load) (N)"
        path = write_rows(tmp_path / "a.csv", header, time, time, deflection, force)
        np.testing.assert_allclose(
            read_recording(path, radius="flat").deflection, deflection / 100.0, rtol=1e-5
        )

    def test_of_two_sources_none_is_chosen(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],stroke [cm],left cell load [N],right cell load [N]"
        path = write_rows(tmp_path / "a.csv", header, time, deflection, force, force)
        assert "'left cell load [N]' (#3) and 'right cell load [N]' (#4)" in refusal(path, radius="flat")

    def test_what_is_proposed_goes_by_the_units_before_the_sizes(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],Cell 1 [kN],Displacment [mm],"
        path = write_rows(tmp_path / "a.csv", header, time, force / 1e3, 10.0 * deflection)
        lines = path.read_text(encoding="utf-8").splitlines()
        path.write_text("\n".join([lines[0], *(f"{line}," for line in lines[1:])]), encoding="utf-8")
        said = refusal(path, radius="flat")
        assert "--columns deflection=#3,force=#2" in said
        # a column without a number, as a comma at the end of each row leaves it, is none to propose
        assert "NAME" not in said

    def test_what_is_proposed_can_be_copied(self, tmp_path: Path) -> None:
        """By the beginnings of names, and of trials side by side the columns of the first one."""
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "Tout,forc,dist,x_F:1", time, force, deflection, force)
        assert "--columns time=#1,deflection=#3,force=#2" in refusal(path, radius="flat")
        names = "Trial 1_x,Trial 1_y,Trial 2_x,Trial 2_y"
        path = write_rows(tmp_path / "b.csv", names, deflection, force, deflection, force)
        assert "--columns deflection=#1,force=#2" in refusal(path, radius="flat")

    def test_a_doubtful_optional_channel_can_be_left_out(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],deflection [cm],force [N],temp [degC],temperature [degC]"
        path = write_rows(tmp_path / "a.csv", header, time, deflection, force, time, time)
        assert "leave it out with --columns temperature=" in refusal(path, radius="flat")
        assert read_recording(path, radius="flat", columns={"temperature": ""}).temperature is None

    def test_a_symbol_needs_its_own_case_or_a_fitting_unit(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "T [s],X [cm],f [N],F [Hz]", time, deflection, force, time)
        np.testing.assert_allclose(read_recording(path, radius="flat").force, force, rtol=1e-5)
        path = write_rows(tmp_path / "b.csv", "time [s],deflection [cm],f", time, deflection, force)
        assert "no column for force" in refusal(path, radius="flat", units={"force": "N"})

    def test_a_missing_column_is_told_with_those_there_are(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],cell [N]", *loading())
        said = refusal(path, radius="flat")
        assert "no column for force" in said
        assert "'cell [N]'" in said
        assert "--columns force=#3" in said

    def test_a_column_named_and_not_there_is_told(self, rig: Path) -> None:
        assert "has no column 'Stroke'" in refusal(rig, columns={"deflection": "Stroke"})
        assert "has no column '#9'" in refusal(rig, columns={"deflection": "#9"})
        assert "one column is given for two" in refusal(rig, columns={"deflection": "#2", "force": "#2"})

    def test_columns_of_the_same_name_are_told_apart_by_number(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "a.csv", "time [s],x [cm],cell [N],cell [N]", time, deflection, force, force
        )
        assert "force=#3" in refusal(path, radius="flat", columns={"force": "cell"})


class TestUnitsOfColumns:
    def test_a_unit_may_end_the_name(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time_s,deflection_cm,force_N", *loading())
        assert read_recording(path, radius="flat").deflection.max() == pytest.approx(0.025)

    def test_a_missing_unit_is_told(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection,force [N]", *loading())
        said = refusal(path, radius="flat")
        assert "column 'deflection': has no unit" in said
        assert "--units deflection=cm" in said
        assert read_recording(
            path, radius="flat", units={"deflection": "mm"}
        ).deflection.max() == pytest.approx(0.0025)

    @pytest.mark.parametrize(
        ("unit", "said"), [("furlongs per day", "'furlongs per day'"), ("kg", "kgf"), ("KN", "kN")]
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
