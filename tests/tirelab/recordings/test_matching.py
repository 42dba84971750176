"""Which column of a table is which channel."""

from pathlib import Path

import numpy as np
import pytest
from house_form import loading, refusal, write_rows
from tirelab.recordings.recording import read_recording


class TestColumns:
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

    def test_what_a_machine_counts_again_as_compression_is_not_chosen(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "Time (s),Extension (cm),Load (N),Compressive extension (cm),Compressive load (N)"
        path = write_rows(tmp_path / "a.csv", header, time, -deflection, -force, deflection, force)
        found = read_recording(path, radius="flat")
        np.testing.assert_allclose(found.force, force, rtol=1e-5)
        assert (
            "deflection taken from 'Extension (cm)'; not from 'Compressive extension (cm)' (#4)"
            in found.notes
        )

    def test_volts_beside_the_reading_they_stand_for_are_not_chosen(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],force (V),force (N),stroke (V),stroke (mm),temp (V),temp (C)"
        values = (time, force / 200.0, force, deflection / 9.0, 10.0 * deflection, time / 50.0, time)
        found = read_recording(write_rows(tmp_path / "a.csv", header, *values), radius="flat")
        np.testing.assert_allclose(found.force, force, rtol=1e-5)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)
        assert found.temperature is not None
        np.testing.assert_allclose(found.temperature, time + 273.15)

    def test_a_word_that_is_written_without_a_space_behind_its_source(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "存储时间(秒),350T位移(cm),350T载荷(N),350T目标位移(cm)"
        path = write_rows(tmp_path / "a.csv", header, time, deflection, force, 2.0 * deflection)
        found = read_recording(path, radius="flat")
        np.testing.assert_allclose(found.time, time)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)
        np.testing.assert_allclose(found.force, force, rtol=1e-5)

    def test_the_clock_and_the_potentiometer_of_a_microcontroller(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "Millis,Load_Cell,Linear_Pot", 1e3 * time, force, deflection)
        assert "--units time=ms" in refusal(path, radius="flat")
        found = read_recording(path, radius="flat", units={"time": "ms", "deflection": "cm", "force": "N"})
        np.testing.assert_allclose(found.time, time)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)

    @pytest.mark.parametrize(("depth", "cell"), [("Sinkage", "Force"), ("Pd", "Fn"), ("Displacment", "Load")])
    def test_a_plate_pressed_into_soil_and_an_indenter(self, depth: str, cell: str, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = f"Time (s),{depth} (cm),{cell} (N),FnRef (N),SegmentID"
        path = write_rows(
            tmp_path / "a.csv", header, time, deflection, force, 0.0 * force + 5.0, 0.0 * time + 1.0
        )
        found = read_recording(path, radius="flat")
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)
        np.testing.assert_allclose(found.force, force, rtol=1e-5)

    def test_the_gap_of_a_rheometer_is_proposed_with_its_sign(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "a.csv", "Time (s),Gap (cm),Normal Force (N)", time, 5.0 - deflection, force
        )
        assert "--columns 'deflection=-Gap (cm),force=+Normal Force (N)'" in refusal(path, radius="flat")

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

    @pytest.mark.parametrize(
        "names",
        [
            "Zeit / Time [s],Weg / Displacement [cm],Kraft / Force [N]",
            "时间 Time (s),位移 Displacement (cm),力 Force (N)",
            "Time_Zeit_s,Displacement_Weg_cm,Force_Kraft_N",
            "ElapsedTime [s],AxialDisplacement [cm],AxialForce [N]",
            "TestTime(s),CrossheadDisp(cm),TestForce(N)",
        ],
    )
    def test_names_in_two_languages_and_words_that_are_joined(self, tmp_path: Path, names: str) -> None:
        time, deflection, force = loading()
        found = read_recording(write_rows(tmp_path / "a.csv", names, time, deflection, force), radius="flat")
        np.testing.assert_allclose(found.time, time)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)
        np.testing.assert_allclose(found.force, force, rtol=1e-5)

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
        header = "time [s],Cell 1 [kN],Rod [mm],"
        path = write_rows(tmp_path / "a.csv", header, time, force / 1e3, 10.0 * deflection)
        lines = path.read_text(encoding="utf-8").splitlines()
        path.write_text("\n".join([lines[0], *(f"{line}," for line in lines[1:])]), encoding="utf-8")
        said = refusal(path, radius="flat")
        assert "--columns deflection=#3,force=#2" in said
        # a column without a number, as a comma at the end of each row leaves it, is none to propose
        assert "NAME" not in said

    def test_what_is_proposed_overrules_no_unit_that_the_name_states(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "time [s],stroke [mm],sensor_gf", time, deflection, force)
        assert refusal(path, radius="flat").endswith("name it with --columns force=#3")
        found = read_recording(path, radius="flat", columns={"force": "#3"})
        np.testing.assert_allclose(found.force, force * 9.80665e-3, rtol=1e-5)
        given = read_recording(path, radius="flat", columns={"force": "#3"}, units={"force": "N"})
        assert "force read in N as given, not in gf" in given.notes

    @pytest.mark.parametrize(
        ("header", "column"), [("Fx [N],Fz [N]", 1), ("Fz_N,Fy_N", 0), ("torque,Fx [N]", 1)]
    )
    def test_of_the_forces_along_axes_the_vertical_one_is_taken(
        self, tmp_path: Path, header: str, column: int
    ) -> None:
        time, deflection, force = loading()
        values = [time, deflection, 2.0 * force, 2.0 * force]
        values[2 + column] = force
        path = write_rows(tmp_path / "a.csv", f"time [s],stroke [mm],{header}", *values)
        np.testing.assert_allclose(read_recording(path, radius="flat").force, force, rtol=1e-5)

    @pytest.mark.parametrize(
        ("header", "deflection_at"),
        [
            ("Temps d'essai [s],Force standard [N],Allongement [mm],Ecartement entre outils [mm]", 2),
            ("Temps d'essai [s],Force standard [N],Ecartement entre outils [mm],Course standard [mm]", 3),
            ("Prüfzeit [s],Standardkraft [N],Dehnung [mm],Werkzeugabstand [mm]", 2),
            ("Prüfzeit [s],Standardkraft [N],Werkzeugabstand [mm],Standardweg [mm]", 3),
            ("Test time [s],Standard force [N],Standard travel [mm],Grip to grip separation [mm]", 2),
            ("Test time [s],Standard force [N],Tool separation [mm],Grip [kN]", 2),
            ("Test time [s],Standard force [N],Crosshead [mm],Tool separation [mm]", 2),
        ],
    )
    def test_the_words_of_one_machine_in_three_languages(
        self, tmp_path: Path, header: str, deflection_at: int
    ) -> None:
        time, deflection, force = loading()
        values = [time, force, 5.0 * time + 1.0, 5.0 * time + 1.0]
        values[deflection_at] = 10.0 * deflection
        found = read_recording(write_rows(tmp_path / "a.csv", header, *values), radius="flat")
        np.testing.assert_allclose(found.force, force, rtol=1e-5)
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)

    @pytest.mark.parametrize(
        ("header", "along"),
        [
            ("x [cm],y [cm],z [cm],Fx [N],Fy [N],Fz [N]", "z"),
            ("x_cm,y_cm,z_cm,Fz_N", "z"),
            ("X (cm),Y (cm),Fy (N)", "y"),
        ],
    )
    def test_of_three_axes_that_along_which_the_force_acts_is_taken(
        self, tmp_path: Path, header: str, along: str
    ) -> None:
        time, deflection, force = loading()
        names = header.lower().split(",")
        values = [force if name.startswith("f") else 0.1 * deflection for name in names]
        values[[name[0] for name in names].index(along)] = deflection
        path = write_rows(tmp_path / "a.csv", f"time [s],{header}", time, *values)
        found = read_recording(path, radius="flat")
        np.testing.assert_allclose(found.deflection, deflection / 100.0, rtol=1e-5)

    def test_of_axes_beside_a_force_along_none_no_one_is_chosen(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],x [cm],y [cm],z [cm],force [N]"
        path = write_rows(tmp_path / "a.csv", header, time, *(deflection * k for k in (1, 2, 3)), force)
        said = refusal(path, radius="flat")
        assert "'x [cm]' (#2) and 'y [cm]' (#3) and 'z [cm]' (#4) may each be the deflection" in said

    def test_an_x_alone_is_the_deflection(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "time [s],x [cm],F [N]", time, deflection, force)
        np.testing.assert_allclose(
            read_recording(path, radius="flat").deflection, deflection / 100.0, rtol=1e-5
        )

    def test_of_two_horizontal_forces_none_is_chosen(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "a.csv", "time [s],stroke [mm],Fx [N],Fy [N]", time, deflection, force, force
        )
        assert "'Fx [N]' (#3) and 'Fy [N]' (#4) may each be the force" in refusal(path, radius="flat")

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

    @pytest.mark.parametrize("clock", ["Temps[s]", "C_1_Temps[s]", "Ch 1 Time (s)", "Zeit [s]", "Time [s]"])
    @pytest.mark.parametrize("date", ["System Date", "Timestamp"])
    def test_a_clock_with_its_unit_goes_before_a_date(self, tmp_path: Path, clock: str, date: str) -> None:
        """The date has whole seconds: five samples have the same one."""
        time, deflection, force = loading()
        rows = [
            f"2026-01-01 12:00:{int(t):02d},{t:.6g},{x:.6g},{f:.6g}"
            for t, x, f in zip(time, deflection, force, strict=True)
        ]
        path = tmp_path / "a.csv"
        path.write_text("\n".join([f"{date},{clock},stroke [cm],force [N]", *rows]), encoding="utf-8")
        np.testing.assert_allclose(read_recording(path, radius="flat").time, time)

    def test_a_date_is_the_time_beside_a_clock_without_a_unit_or_beside_several(self, tmp_path: Path) -> None:
        _, deflection, force = loading()
        rows = [
            f"2026-01-01 12:{i // 60:02d}:{i % 60:02d},{i + 9},{i + 7},{x:.6g},{f:.6g}"
            for i, (x, f) in enumerate(zip(deflection, force, strict=True))
        ]
        for clocks in ("Temps,Zeit", "Temps [s],Zeit [s]"):
            path = tmp_path / "a.csv"
            path.write_text("\n".join([f"Date,{clocks},stroke [cm],force [N]", *rows]), encoding="utf-8")
            np.testing.assert_allclose(read_recording(path, radius="flat").time, np.arange(101.0))
