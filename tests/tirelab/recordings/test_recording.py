"""Recordings: what is read from a good file, what is said about it, and what a bad one is told."""

import math
from pathlib import Path

import numpy as np
import pytest
import tirelab.recordings.recording
from house_form import HOUSE_FORM, edited, loading, refusal, write_rows
from tirelab.errors import TirelabError
from tirelab.recordings.recording import Recording, RecordingError, read_recording
from tirelab.recordings.writing import write_recording


class TestReading:
    def test_the_house_form_is_read_in_si(self, rig: Path) -> None:
        time, deflection, force = loading()
        recording = read_recording(rig)
        assert (recording.name, recording.source, len(recording)) == ("flat", rig, 101)
        # The file holds six digits.
        np.testing.assert_allclose(recording.time, time, rtol=1e-5)
        np.testing.assert_allclose(recording.deflection, deflection / 100.0, rtol=1e-5)
        np.testing.assert_allclose(recording.force, force, rtol=1e-5)
        assert np.all(np.isinf(recording.surface_radius))
        assert recording.pressure is recording.temperature is recording.speed is None
        assert recording.notes == ()

    def test_sampling_and_duration_are_those_of_the_rig(self, rig: Path) -> None:
        recording = read_recording(rig)
        assert recording.sampling_interval == pytest.approx(0.2)
        assert recording.duration == pytest.approx(20.0)
        assert len(recording.gaps) == 0

    def test_optional_channels_come_in_si(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "ride.csv",
            "t [ms],Stroke (mm),Rb [in],Load cell [kN],Inflation pressure [psi],Temp [degF],Speed [km/h]",
            *(time * 1000.0, deflection * 10.0, [10.0] * 101, force / 1000.0),
            *([50.0] * 101, [68.0] * 101, [36.0] * 101),
        )
        recording = read_recording(path)
        np.testing.assert_allclose(recording.time, time, rtol=1e-5)
        np.testing.assert_allclose(recording.deflection, deflection / 100.0, rtol=1e-5)
        np.testing.assert_allclose(recording.force, force, rtol=1e-5)
        assert recording.pressure is not None
        assert recording.temperature is not None
        assert recording.speed is not None
        assert recording.surface_radius[0] == pytest.approx(0.254)
        assert recording.pressure[0] == pytest.approx(344738.0, abs=1.0)
        assert recording.temperature[0] == pytest.approx(293.15)
        assert recording.speed[0] == pytest.approx(10.0)

    @pytest.mark.parametrize(
        "name", ["absolute pressure", "pressure abs", "abs. pressure", "Absolutdruck", "Druck absolut"]
    )
    def test_an_absolute_pressure_is_told(self, name: str, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = f"time [s],deflection [cm],force [N],{name} [kPa]"
        path = write_rows(tmp_path / "p.csv", header, time, deflection, force, [446.025] * 101)
        recording = read_recording(path, radius="flat")
        assert recording.pressure is not None
        assert recording.pressure[0] == pytest.approx(344700.0)
        assert any("absolute" in note for note in recording.notes)

    @pytest.mark.parametrize("name", ["Reifenfülldruck", "Überdruck", "air pressure"])
    def test_a_gauge_pressure_is_read_by_the_names_it_has(self, name: str, tmp_path: Path) -> None:
        header = f"time [s],deflection [cm],force [N],{name} [kPa]"
        recording = read_recording(
            write_rows(tmp_path / "p.csv", header, *loading(), [344.7] * 101), radius="flat"
        )
        assert recording.pressure is not None
        assert recording.pressure[0] == pytest.approx(344700.0)

    def test_every_concealed_recording_is_what_numpy_reads(self, shared: Path) -> None:
        files = sorted((shared / "recordings" / "concealed").glob("*/*.csv"))
        assert files
        for file in files:
            recording = read_recording(file)
            expected = np.loadtxt(file, delimiter=",", skiprows=1, unpack=True)
            for (_, channel), column, divisor in zip(
                recording.channels(), expected, (1, 100, 100, 1), strict=True
            ):
                np.testing.assert_array_equal(channel, column / divisor)
            # one of them has a gauge whose zero is wrong
            expected_doubts = ["dev_two_viscous_offset"] if recording.doubts else []
            assert expected_doubts in ([], [file.parent.name])
            assert recording.notes == tuple(f"doubtful: {doubt}" for doubt in recording.doubts)

    def test_a_damper_measured_elsewhere_is_read_from_mat(self, shared: Path) -> None:
        recording = read_recording(
            shared / "recordings" / "real" / "mr_damper_sine" / "ensaio4a.mat",
            columns={"time": "Tout", "deflection": "dist", "force": "forc"},
            units={"time": "s", "deflection": "mm", "force": "N"},
            radius="flat",
        )
        # Its description: Ts = 0.01 s, 3001 samples, dist in mm, forc in N.
        assert len(recording) == 3001
        assert recording.sampling_interval == pytest.approx(0.01)
        assert recording.deflection.max() == pytest.approx(0.01991)

    def test_a_file_without_header_is_read_by_number(self, shared: Path) -> None:
        path = shared / "recordings" / "real" / "pneumatic_cylinder_pressure_friction" / "O-ring_7bar.csv"
        assert "has no header row" in refusal(path)
        recording = read_recording(
            path,
            columns={"time": "#1", "deflection": "#5", "pressure": "#6", "force": "#7"},
            units={"time": "ms", "deflection": "mm", "pressure": "bar", "force": "N"},
            radius="flat",
        )
        assert recording.pressure is not None
        # Its description: strokes of 37 mm against 7 bar.
        assert recording.deflection.max() == pytest.approx(0.037, abs=0.001)
        assert np.median(recording.pressure) == pytest.approx(7e5, rel=0.02)
        assert any("gaps in time" in note for note in recording.notes)


class TestRowsAndTime:
    def test_rows_that_lack_a_value_are_skipped_and_named(self, rig: Path) -> None:
        edited(rig, 10, "1.6,,inf,150")
        edited(rig, 20, "3.6,0.9,inf,NaN")
        edited(rig, 30, ",,,")
        edited(rig, 40, "")
        recording = read_recording(rig)
        assert len(recording) == 97
        assert "skipped for want of deflection and force: row 10, row 20" in recording.notes
        assert "skipped as empty: row 30, row 40" in recording.notes
        assert any(note.startswith("4 gaps in time, not filled") for note in recording.notes)
        np.testing.assert_array_equal(recording.gaps, [7, 16, 25, 34])

    def test_too_many_blanks_are_refused(self, rig: Path) -> None:
        for line in range(10, 30):
            edited(rig, line, f"{(line - 2) / 5.0},,inf,1")
        said = refusal(rig)
        assert "20 of 101 rows have no value for deflection (row 10 the first)" in said

    def test_an_optional_channel_with_many_blanks_is_left_out_and_told(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        slow = [20.0 if i % 10 == 0 else math.nan for i in range(101)]
        header = "time [s],deflection [cm],force [N],temperature [degC]"
        recording = read_recording(
            write_rows(tmp_path / "a.csv", header, time, deflection, force, slow), radius="flat"
        )
        assert len(recording) == 101
        assert recording.temperature is None
        assert "temperature left out: 90 of 101 rows have no value for it" in recording.notes

    def test_a_gap_in_time_is_told_and_not_filled(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        time[50:] += 3.0
        recording = read_recording(
            write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force [N]", time, deflection, force),
            radius="flat",
        )
        assert len(recording) == 101
        np.testing.assert_array_equal(recording.gaps, [49])
        assert "1 gap in time, not filled: 3.2 s after 9.8 s" in recording.notes

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("0.8,0.3,inf,90", "time repeats 0.8 s"),
            ("0.1,0.3,inf,90", "time goes back from 0.8 s to 0.1 s"),
            ("1.0,oops,inf,90", "column 'deflection [cm]': 'oops' is not a number"),
            ("1.0,1_0,inf,90", "'1_0' is not a number"),
            ("1.0,0x1F,inf,90", "'0x1F' is not a number"),
            ("1.0,=1+1,inf,90", "'=1+1' is not a number"),
            ("00:00:01,0.3,inf,90", "write times as numbers of seconds"),
            ("1.0,0.3,inf,inf", "column 'force [N]': inf is no force"),
            ("1.0,0.3,inf,1e300", "1e+300 N cannot be"),
            ("1.0,0.3,inf,1e999", "inf is no force"),
            ("1.0,0.3,inf,90,5", "has 5 fields where the header has 4"),
            ("1,0,0,3,inf,90", "separate the columns by semicolons"),
        ],
    )
    def test_a_wrong_row_is_told_by_its_line(self, rig: Path, text: str, said: str) -> None:
        message = refusal(edited(rig, 7, text))
        assert "flat.csv, row 7" in message
        assert said in message

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("", "is empty (0 bytes)"),
            ("\n\n", "no header and no numbers"),
            (HOUSE_FORM + "\n", "no rows below it"),
            (HOUSE_FORM + "\n0,0,inf,0\n", "a single row"),
            (HOUSE_FORM + "\n0,1,inf,0\n1,1,inf,5\n", "deflection [cm]': is 0.01 m in every row"),
            ("just some words\nand more\n", "no comma, semicolon, tab, | or spaces"),
            ('time\n"0.1,""0.2"",""3"""\n"0.2,""0.3"",""4"""\n', "each row is quoted as one cell ('0.2,"),
            (HOUSE_FORM + '\n0,"1,inf,0\n1,2,inf,5\n', "row 2"),
        ],
    )
    def test_a_file_without_a_recording_is_told(self, tmp_path: Path, text: str, said: str) -> None:
        path = tmp_path / "a.csv"
        path.write_text(text, encoding="utf-8")
        assert said in refusal(path)

    def test_a_path_that_leads_nowhere_is_told(self, tmp_path: Path) -> None:
        assert "no such file" in refusal(tmp_path / "none.csv")
        assert "is a folder" in refusal(tmp_path)

    def test_a_file_that_may_not_be_read_is_told(self, rig: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def refuse(*_: object, **__: object) -> None:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(Path, "open", refuse)
        assert "cannot be opened (Permission denied); check its permissions" in refusal(rig)


class TestSize:
    @pytest.fixture
    def huge(self, tmp_path: Path) -> Path:
        """Five thousand rows, and after them two gigabytes of nothing that the disk need not hold."""
        time, deflection, force = loading(5001)
        path = write_rows(tmp_path / "a.csv", HOUSE_FORM, time, deflection, [math.inf] * 5001, force)
        with path.open("a", encoding="utf-8") as file:
            file.truncate(2 * 2**30)
        return path

    def test_a_file_larger_than_memory_is_refused_before_it_is_read(
        self, huge: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(tirelab.recordings.recording, "memory_available", lambda: 2**30)
        said = refusal(huge)
        assert "has 2.15 GB" in said
        assert "keep every tenth row" in said

    def test_two_gigabytes_of_nothing_after_the_rows_are_not_taken_in(
        self, huge: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(tirelab.recordings.recording, "memory_available", lambda: 2**40)
        assert "row 5003: the line does not end" in refusal(huge)


class TestWriting:
    def test_a_recording_written_is_read_the_same(self, tmp_path: Path) -> None:
        noise = np.random.default_rng(3)
        time = np.cumsum(noise.uniform(0.5, 1.0, 2000)) * 1e-3
        deflection = 0.02 * np.abs(np.sin(time * 7.0)) + 1e-9 * noise.normal(size=2000)
        made = Recording(
            name="made",
            time=time,
            deflection=deflection,
            surface_radius=np.where(noise.random(2000) < 0.5, np.inf, -0.508),
            force=1e5 * deflection + noise.normal(size=2000),
            pressure=344.7e3 + noise.normal(size=2000),
            temperature=293.15 + noise.normal(size=2000),
            speed=noise.normal(size=2000),
        )
        write_recording(made, tmp_path / "made.csv")
        again = read_recording(tmp_path / "made.csv")
        for (name, before), (_, after) in zip(made.channels(), again.channels(), strict=True):
            np.testing.assert_allclose(after, before, rtol=1e-11, err_msg=name)
        assert again.notes == ()

    def test_the_house_form_is_short_to_read(self, tmp_path: Path) -> None:
        made = Recording(
            "made", np.array([0.0, 0.2]), np.array([0.0, 0.0254]), np.full(2, 0.0127), np.array([0.0, 1.5])
        )
        write_recording(made, tmp_path / "made.csv")
        assert (tmp_path / "made.csv").read_text(encoding="utf-8").splitlines() == [
            HOUSE_FORM,
            "0.0,0.0,1.27,0.0",
            "0.2,2.54,1.27,1.5",
        ]

    def test_a_folder_that_is_not_there_is_told(self, tmp_path: Path, rig: Path) -> None:
        with pytest.raises(RecordingError, match="cannot be written"):
            write_recording(read_recording(rig), tmp_path / "none" / "made.csv")


class TestTheValue:
    def test_its_arrays_cannot_be_changed(self, rig: Path) -> None:
        recording = read_recording(rig)
        for _, values in recording.channels():
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 1.0

    def test_the_arrays_it_was_made_from_stay_as_they_are(self) -> None:
        time = np.array([0.0, 1.0])
        Recording("a", time, np.array([0.0, 0.01]), np.full(2, np.inf), np.zeros(2))
        assert time.flags.writeable

    @pytest.mark.parametrize(
        ("changed", "said"),
        [
            ({"time": [0.0, 0.0]}, "time repeats"),
            ({"time": [0.0]}, "samples|shape"),
            ({"force": [0.0]}, "shape"),
            ({"force": [0.0, math.nan]}, "nan is no force"),
            ({"surface_radius": [1.0, 0.0]}, "no radius"),
            ({"surface_radius": [1.0, math.nan]}, "no radius"),
            ({"temperature": [20.0, -5.0]}, "cannot be"),
        ],
    )
    def test_it_is_checked_however_it_is_made(self, changed: dict[str, list[float]], said: str) -> None:
        fields: dict[str, list[float]] = {
            "time": [0.0, 1.0],
            "deflection": [0.0, 0.01],
            "surface_radius": [math.inf, math.inf],
            "force": [0.0, 100.0],
        }
        with pytest.raises(TirelabError, match=said):
            Recording("a", **{name: np.array(v) for name, v in {**fields, **changed}.items()})  # type: ignore[arg-type]
