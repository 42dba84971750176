"""What a file beside a recording may say of it."""

import shlex
from pathlib import Path

import pytest
from house_form import loading, refusal, write_rows
from tirelab.recordings.channels import parse_columns
from tirelab.recordings.metadata import Settings, Sidecar, read_sidecar
from tirelab.recordings.recording import RecordingError, read_recording


class TestSidecar:
    @pytest.fixture
    def bare(self, tmp_path: Path) -> Path:
        return write_rows(tmp_path / "bump.csv", "Zeit [s],Weg,Kraft [N]", *loading())

    def test_a_sidecar_names_radius_columns_and_units(self, bare: Path) -> None:
        bare.with_name("recording.toml").write_text(
            'radius = "25.4 cm"\n[columns]\ntime = "Zeit"\ndeflection = "Weg"\nforce = "Kraft"\n'
            '[units]\ndeflection = "cm"\n',
            encoding="utf-8",
        )
        recording = read_recording(bare)
        assert recording.surface_radius[0] == 0.254
        assert recording.deflection.max() == pytest.approx(0.025)
        assert "settings read from recording.toml" in recording.notes

    def test_a_sidecar_of_the_file_is_taken_before_that_of_the_folder(self, bare: Path) -> None:
        columns = (
            '[columns]\ntime = "Zeit"\ndeflection = "Weg"\nforce = "Kraft"\n[units]\ndeflection = "cm"\n'
        )
        bare.with_name("recording.toml").write_text('radius = "flat"\n' + columns, encoding="utf-8")
        bare.with_suffix(".toml").write_text('radius = "-50.8cm"\n', encoding="utf-8")
        recording = read_recording(bare)
        assert recording.surface_radius[0] == -0.508
        assert read_recording(bare, radius="10cm").surface_radius[0] == 0.1

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("radius = 25.4", "not text"),
            ("radius = \n", "not TOML"),
            ("radius = " + "9" * 5000, "not TOML"),
            ("skip_rows = " + "9" * 400, r"not TOML \(skip_rows is an integer of more than 64 bits\)"),
            ('diameter = "3 cm"', "not known"),
            ('[columns]\nstroke = "x"', "no channel"),
            ('columns = "x"', "table"),
            ('name = "all"', r'below \[files\."bump\.csv"\]'),
            ('[files."bump.csv"]\nname = ""', "not text"),
        ],
    )
    def test_a_wrong_sidecar_is_told_by_its_name(self, bare: Path, text: str, said: str) -> None:
        bare.with_name("recording.toml").write_text(text, encoding="utf-8")
        with pytest.raises(RecordingError, match=rf"recording\.toml.*{said}"):
            read_recording(bare)

    @pytest.mark.parametrize(
        ("file", "above"), [("recording.toml", '[files."bump.csv"]\n'), ("bump.toml", "")]
    )
    def test_a_recording_can_be_given_a_name(self, bare: Path, file: str, above: str) -> None:
        told = f'{above}name = "front, 2 bar"\nradius = "flat"\n'
        bare.with_name(file).write_text(told, encoding="utf-8")
        columns, units = {"time": "Zeit", "deflection": "Weg", "force": "Kraft"}, {"deflection": "cm"}
        assert read_recording(bare, columns=columns, units=units).name == "front, 2 bar"
        part = read_recording(f"{bare}@2:8", columns=columns, units=units)
        assert part.name.startswith("front, 2 bar@")

    def test_a_radius_in_the_file_of_settings_is_not_used_beside_a_column(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "a.csv", "time [s],x [cm],Rb [cm],F [N]", time, deflection, [25.4] * len(time), force
        )
        (tmp_path / "recording.toml").write_text('radius = "flat"\n', encoding="utf-8")
        recording = read_recording(path)
        assert recording.surface_radius[0] == pytest.approx(0.254)
        assert "radius of recording.toml not used: column 'Rb [cm]' gives it" in recording.notes

    def test_without_a_sidecar_nothing_is_known(self, tmp_path: Path) -> None:
        assert read_sidecar(tmp_path / "a.csv") == Sidecar()

    def test_one_file_that_is_both_sidecars_is_read_once(self, tmp_path: Path) -> None:
        (tmp_path / "recording.toml").write_text('radius = "flat"\n', encoding="utf-8")
        assert read_sidecar(tmp_path / "recording.csv").sources == ("recording.toml",)

    def test_the_own_sidecar_goes_over_the_folders_channel_by_channel(self, tmp_path: Path) -> None:
        (tmp_path / "recording.toml").write_text(
            'radius = "flat"\n[columns]\ntime = "a"\nforce = "b"\n', encoding="utf-8"
        )
        (tmp_path / "own.toml").write_text('[columns]\nforce = "c"\n', encoding="utf-8")
        sidecar = read_sidecar(tmp_path / "own.csv")
        assert sidecar.columns == {"time": "a", "force": "c"}
        assert (sidecar.radius, sidecar.radius_source) == ("flat", "recording.toml")
        assert sidecar.sources == ("recording.toml", "own.toml")

    def test_the_users_settings_go_over_a_sidecars(self) -> None:
        sidecar = Sidecar("flat", "a.toml", {"time": "a", "force": "b"}, {"force": "kN"}, ("a.toml",))
        assert sidecar.overruled({"force": "c"}, None, 0.3) == Settings(
            {"time": "a", "force": "c"}, {"force": "kN"}, 0.3, "flat", "a.toml"
        )
        assert sidecar.overruled(None, {"force": "N"}, None).units == {"force": "N"}

    @pytest.mark.parametrize(
        ("text", "advice"),
        [
            ('radius = ""', "radius is '', not text; write radius = \"25.4 cm\""),
            ("pressure = 2.6", 'pressure is 2.6, not text; write pressure = "2.6 bar"'),
            ("pressure = 35", 'pressure is 35, not text; write pressure = "35 psi"'),
            ("pressure = true", 'pressure is True, not text; write pressure = "3.447e+05 Pa"'),
            ("temperature = 23.5", 'temperature is 23.5, not text; write temperature = "23.5 degC"'),
            ("radius = 0.3", 'radius is 0.3, not text; write radius = "0.3 m"'),
            ("sampling = 1000", 'sampling is 1000, not text; write sampling = "1000 Hz"'),
            ("[zero]\nforce = -12", 'zero.force is -12, not text; write zero.force = "-12 N"'),
            ("[units]\nforce = 3", 'units.force is 3, not text; write units.force = "..."'),
        ],
    )
    def test_what_to_write_is_said(self, tmp_path: Path, text: str, advice: str) -> None:
        (tmp_path / "recording.toml").write_text(text, encoding="utf-8")
        with pytest.raises(RecordingError) as caught:
            read_sidecar(tmp_path / "a.csv")
        assert str(caught.value) == f"recording.toml: {advice}"

    def test_an_empty_column_leaves_a_channel_out(self, tmp_path: Path) -> None:
        (tmp_path / "recording.toml").write_text('[columns]\nspeed = ""\n', encoding="utf-8")
        assert read_sidecar(tmp_path / "a.csv").columns == {"speed": ""}

    def test_one_pressure_for_the_whole_recording(self, tmp_path: Path) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force [N]", *loading())
        (tmp_path / "recording.toml").write_text(
            'radius = "flat"\ntemperature = "21 degC"\n[files."a.csv"]\npressure = "2.5 bar"\n'
        )
        recording = read_recording(path)
        assert set(recording.pressure.tolist()) == {2.5e5}
        assert recording.temperature[0] == pytest.approx(294.15)
        assert "pressure 2.5 bar in every row, as the settings say" in recording.notes

    def test_a_column_of_pressure_goes_over_the_one_value(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "time [s],deflection [cm],force [N],pressure [kPa]"
        path = write_rows(tmp_path / "a.csv", header, time, deflection, force, [300.0] * len(time))
        (tmp_path / "recording.toml").write_text('radius = "flat"\npressure = "2.5 bar"\n')
        recording = read_recording(path)
        assert recording.pressure[0] == pytest.approx(3e5)
        assert "pressure = 2.5 bar of the settings not used: a column gives it" in recording.notes

    @pytest.mark.parametrize("text", ["2.5", "high", "2.5 N"])
    def test_a_pressure_that_is_none_is_told(self, tmp_path: Path, text: str) -> None:
        path = write_rows(tmp_path / "a.csv", "time [s],deflection [cm],force [N]", *loading())
        (tmp_path / "recording.toml").write_text(f'radius = "flat"\npressure = "{text}"\n')
        with pytest.raises(RecordingError, match=r"pressure in the settings: .*(write|mean)"):
            read_recording(path)


class TestAnotherTableBesideTheSettings:
    """Settings of a folder that fit one table and not the other: the file that says them is named, and the way out."""

    @pytest.fixture
    def other(self, tmp_path: Path) -> Path:
        rows = "".join(f"{0.1 * i:.1f};{i};{20 * i}\n" for i in range(30))
        (tmp_path / "a.csv").write_text("Zeit [s];Traversenweg [mm];Kraft [N]\n" + rows)
        (tmp_path / "b.csv").write_text("Press 2\nTemps [s];Course [mm];Effort [N]\n" + rows)
        return tmp_path / "b.csv"

    def settle(self, other: Path, text: str) -> None:
        (other.parent / "recording.toml").write_text(f'radius = "flat"\n{text}', encoding="utf-8")
        assert len(read_recording(other.with_name("a.csv"))) == 30

    def test_other_names_are_listed_with_the_columns_to_take(self, other: Path) -> None:
        self.settle(other, '[columns]\ntime = "Zeit"\ndeflection = "Traversenweg"\nforce = "+Kraft"\n')
        said = refusal(other)
        assert "has no columns 'Zeit', 'Traversenweg', '+Kraft', as recording.toml says" in said
        words, _, rest = said.partition("give --columns ")[2].partition(", or say it of this file alone in ")
        assert rest == 'recording.toml: [files."b.csv".columns]'
        assert len(read_recording(other, columns=parse_columns(shlex.split(words)[0]))) == 30

    def test_the_own_table_of_the_file_goes_over_them(self, other: Path) -> None:
        own = '[files."b.csv".columns]\ntime = ""\ndeflection = "Course"\nforce = "Effort"\n'
        self.settle(other, f'[columns]\ndeflection = "Traversenweg"\nforce = "Kraft"\n{own}')
        assert not read_recording(other).timed

    def test_what_the_user_names_is_his(self, other: Path) -> None:
        self.settle(other, '[columns]\nforce = "Kraft"\n')
        assert "recording.toml" not in refusal(other, columns={"force": "Load"})

    def test_other_units(self, other: Path) -> None:
        (other.parent / "recording.toml").write_text('radius = "flat"\n[units]\nforce = "mm"\n')
        said = refusal(other)
        assert "column 'Effort [N]', unit in recording.toml: 'mm' is not a unit of force" in said

    def test_other_rows_above_the_names(self, other: Path) -> None:
        (other.parent / "recording.toml").write_text('radius = "flat"\nskip_rows = 2\n')
        assert "has no header row below the rows that skip_rows in recording.toml leaves out" in refusal(
            other
        )
