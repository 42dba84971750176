"""What a file beside a recording may say of it."""

from pathlib import Path

import pytest
from house_form import loading, write_rows
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
            ('diameter = "3 cm"', "not known"),
            ('[columns]\nstroke = "x"', "no channel"),
            ('columns = "x"', "table"),
        ],
    )
    def test_a_wrong_sidecar_is_told_by_its_name(self, bare: Path, text: str, said: str) -> None:
        bare.with_name("recording.toml").write_text(text, encoding="utf-8")
        with pytest.raises(RecordingError, match=rf"recording\.toml.*{said}"):
            read_recording(bare)
