"""What is understood of a file is shown and kept, and read again the same from what was kept."""

import shlex
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from house_form import loading, write_rows
from tirelab.cli import main
from tirelab.recordings.choices import Choices
from tirelab.recordings.description import surface_text
from tirelab.recordings.inspection import Inspection, inspect_recording
from tirelab.recordings.recording import RecordingError, read_recording
from tirelab.recordings.settings_file import settings_text

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@pytest.fixture
def press(tmp_path: Path) -> Path:
    """A press that counts compression negative, with two lines above its table and a gauge of 1.25 mm."""
    time, deflection, force = loading()
    stepped = -np.round(10.0 * deflection / 1.25) * 1.25
    path = write_rows(
        tmp_path / "press.csv", "Zeit [s];Weg [mm];Kraft [kN]", time, stepped, -force / 1e3, separator=";"
    )
    path.write_text("Prüfer;B\nReifen;2.1\n" + path.read_text(encoding="utf-8"), encoding="latin-1")
    return path


def keep(file: Path, found: Inspection) -> None:
    file.write_text(settings_text(file, {found.key: found.settings}), encoding="utf-8")


def test_a_radius_that_was_given_goes_over_the_column_in_the_file_of_settings_too(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(
        tmp_path / "a.csv",
        "time [s],deflection [cm],radius [cm],F [N]",
        time,
        deflection,
        12.7 + 0.0 * time,
        force,
    )
    found = inspect_recording(path, Choices(radius="flat"))
    keep(path.with_name("recording.toml"), found)
    again = read_recording(path)
    assert np.all(np.isinf(found.recording.surface_radius))
    assert np.all(np.isinf(again.surface_radius))
    assert inspect_recording(path, Choices()).settings == found.settings


def test_a_channel_that_is_left_out_stays_so_in_the_file_of_settings(tmp_path: Path) -> None:
    time, deflection, force = loading()
    header = "time [s],deflection [cm],speed,F [N]"
    path = write_rows(tmp_path / "a.csv", header, time, deflection, 0.0 * time, force)
    keep(path.with_name("recording.toml"), inspect_recording(path, Choices({"speed": ""}, radius="flat")))
    assert read_recording(path).speed is None


def test_a_radius_that_is_as_good_as_flat_is_shown_in_metres() -> None:
    assert surface_text(np.array([127.0])) == "radius 127 m"
    assert surface_text(np.array([-0.127, np.inf])) == "radius -12.7 cm, flat"


def test_the_facts_are_those_of_the_file(press: Path) -> None:
    found = inspect_recording(press, Choices(radius="25.4cm"))
    rows = {row.channel: row for row in found.channels}
    assert rows["deflection"].column == "Weg [mm] (#2)"
    assert rows["deflection"].step == "1.25 mm"
    assert rows["deflection"].remark == "turned in sign"
    assert (rows["force"].unit, rows["force"].remark) == ("kN", "turned in sign")
    facts = dict(found.facts)
    assert facts["table"].startswith("names in row 3, numbers from row 4; semicolons between columns")
    assert facts["sampling"] == "5 Hz (0.2 s, even) over 20 s"
    assert facts["surface"] == "radius 25.4 cm"
    assert found.recording.provenance == ("Prüfer;B", "Reifen;2.1")


def test_what_is_kept_reads_the_same(press: Path) -> None:
    first = inspect_recording(press, Choices(radius="flat"))
    keep(press.with_name("recording.toml"), first)
    again = read_recording(press)
    for (_, one), (_, other) in zip(first.recording.channels(), again.channels(), strict=True):
        np.testing.assert_array_equal(one, other)
    assert "settings read from recording.toml" in again.notes
    assert inspect_recording(press, Choices()).settings == first.settings
    # and it holds for that file alone
    other = write_rows(press.with_name("other.csv"), "time [s],x [cm],F [N]", *loading())
    with pytest.raises(RecordingError, match="radius of the surface is not known"):
        read_recording(other)


@pytest.mark.parametrize(("units", "pulls"), [(True, 200.0), (False, 200.0), (True, 10.0)])
def test_what_pulls_is_offered_to_be_no_tire(tmp_path: Path, units: bool, pulls: float) -> None:
    """A damper has no surface; of a tire whose force is hardly negative a radius alone is asked for."""
    names = ("time [s]", "travel [mm]", "force [N]") if units else ("time", "travel", "force")
    turn = np.linspace(0.0, 20.0, 300)
    force = np.where(np.cos(turn) > 0.0, 300.0, pulls) * np.cos(turn)
    damper = write_rows(tmp_path / "damper.csv", ",".join(names), turn, 10.0 * np.sin(turn), force)
    with pytest.raises(RecordingError, match="radius of the surface is not known") as told:
        read_recording(damper)
    assert ("tirelab inspect FILE --part" in str(told.value)) == (pulls == 200.0)


def test_what_others_wrote_there_stays(press: Path) -> None:
    file = press.with_name("recording.toml")
    file.write_text('# by hand\nradius = "25.4 cm"  # the bump\n', encoding="utf-8")
    found = inspect_recording(press, Choices())
    keep(file, found)
    text = file.read_text(encoding="utf-8")
    assert text.startswith('# by hand\nradius = "25.4 cm"  # the bump\n')
    content = tomllib.loads(text)
    assert content["radius"] == "25.4 cm"
    assert content["files"]["press.csv"]["units"]["force"] == "kN"


@pytest.mark.parametrize("files", ["[]", '""', "{}", "1"])
def test_files_that_are_no_table_are_said_before_anything_is_written(tmp_path: Path, files: str) -> None:
    settings = tmp_path / "recording.toml"
    settings.write_text(f"files = {files}\n", encoding="utf-8")
    with pytest.raises(
        RecordingError, match=r"recording\.toml: files = .+ holds no table of a file; write \[files"
    ):
        settings_text(settings, {"press.csv": {"radius": "flat"}})


def test_a_file_of_settings_that_is_named_is_read_instead(press: Path, tmp_path: Path) -> None:
    press.with_name("recording.toml").write_text('radius = "flat"\n', encoding="utf-8")
    other = tmp_path / "bump.toml"
    other.write_text('radius = "25.4 cm"\nfrom = "4 s"\nto = "8 s"\n', encoding="utf-8")
    recording = inspect_recording(press, Choices(settings=other)).recording
    assert recording.surface_radius[0] == 0.254
    assert recording.time[[0, -1]].tolist() == [4.0, 7.8]
    with pytest.raises(RecordingError, match="there is no such file of settings"):
        inspect_recording(press, Choices(settings=tmp_path / "none.toml"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[files."a.csv"]\nstroke = "x"', "'files.\"a.csv\".stroke' is not known here"),
        ('[files]\na = "b"', "files is a table"),
        ("skip_rows = -1", "skip_rows is -1; write the number of rows"),
        ("sampling = 10", 'sampling is 10, not text; write sampling = "10 Hz"'),
    ],
)
def test_a_wrong_file_of_settings_is_told(rig: Path, text: str, said: str) -> None:
    rig.with_name("recording.toml").write_text(text + "\n", encoding="utf-8")
    with pytest.raises(RecordingError) as caught:
        read_recording(rig)
    assert said in str(caught.value)


class TestCommand:
    def test_it_shows_and_writes(self, press: Path, tmp_path: Path) -> None:
        picture = tmp_path / "deep" / "press.png"
        done = CliRunner().invoke(
            main, ["inspect", str(press), "--radius", "flat", "--picture", str(picture)]
        )
        assert done.exit_code == 0, done.output
        assert "Weg [mm] (#2)" in done.output
        assert "turned in sign" in done.output
        assert "Prüfer;B" in done.output
        assert "force [N] over deflection [mm]" in done.output
        assert all(line == line.rstrip() for line in done.output.splitlines())
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert tomllib.loads((tmp_path / "recording.toml").read_text(encoding="utf-8"))["files"]["press.csv"]
        assert CliRunner().invoke(main, ["compare", str(press), "--out", str(tmp_path)]).exit_code == 0

    def test_one_bad_file_keeps_none_of_the_others_away(self, press: Path, tmp_path: Path) -> None:
        bad = write_rows(tmp_path / "bad.csv", "time,x,force", *loading())
        done = CliRunner().invoke(main, ["inspect", str(tmp_path), "--radius", "flat"])
        assert done.exit_code == 2
        assert "1 of 2 files cannot be read" in done.stderr
        assert f"tirelab inspect {bad} --units" in done.stderr
        assert list(tomllib.loads((tmp_path / "recording.toml").read_text(encoding="utf-8"))["files"]) == [
            "press.csv"
        ]

    def test_files_that_lack_the_same_are_told_one_command(self, press: Path, tmp_path: Path) -> None:
        bad = [write_rows(tmp_path / f"bad{n}.csv", "time [s],x,force [N]", *loading()) for n in (1, 2)]
        done = CliRunner().invoke(main, ["inspect", "--part", *map(str, [press, *bad])])
        assert done.exit_code == 2
        words = f"{bad[0]} {bad[1]} --part --columns deflection=x --units deflection=mm".split()
        told = done.stderr.splitlines()[-1]
        assert shlex.split(told)[:5] == ["tirelab", "inspect", *words[:3]]
        assert CliRunner().invoke(main, shlex.split(told)[1:]).exit_code == 0

    def test_guesses_are_shown_and_not_written(self, tmp_path: Path) -> None:
        bad = write_rows(tmp_path / "bad.csv", "time,deflection,force", *loading())
        done = CliRunner().invoke(main, ["inspect", str(bad)])
        assert done.exit_code == 2
        assert "ASSUMED, and not written: --units time=s,deflection=cm,force=N --radius flat" in done.stdout
        assert "surface radius flat as assumed" in done.stdout
        assert "given" not in done.stdout
        assert not (tmp_path / "recording.toml").exists()
