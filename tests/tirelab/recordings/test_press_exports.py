"""Every export of a press is read without preparation, or asked for with one command that works when it is copied."""

import io
import shlex
from pathlib import Path

import numpy as np
import pandas as pd
import polars as pl
import pytest
from click.testing import CliRunner
from tirelab.cli import main
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.recording import Recording, RecordingError, read_recording

READ = (
    "datetime.parquet",
    "de_meta.csv",
    "de_meta_hash.csv",
    "de_timestamps.csv",
    "de_unit_row.csv",
    "de_units_header.csv",
    "zweg_kraft_offset.csv",
    "kN_said_N.csv",
    "no_time.csv",
)
"""All of them lack the surface alone."""

WHOLE = ("mm_but_radius_m.csv", "neg_force.csv", "neg_defl.csv")


@pytest.fixture
def exports(shared: Path) -> Path:
    folder = shared / "recordings" / "press_exports"
    if not folder.is_dir():
        pytest.skip("no exports of a press")
    return folder


def plain_numbers(file: Path) -> np.ndarray:
    """Return deflection and force as the text has them, parsed here a second time: the last cells of a line."""
    rows = []
    for line in file.read_text(encoding="latin-1").splitlines():
        cells = line.split(";" if ";" in line else ",")
        try:
            rows.append([float(cell.replace(",", ".")) for cell in cells[-2:]])
        except ValueError:
            continue
    return np.array(rows)


def of(source: Path, as_frame: bool, **options: str) -> Recording:
    return (
        Recording.from_dataframe(frame_of(source), **options)
        if as_frame
        else read_recording(source, **options)
    )


def frame_of(file: Path) -> object:
    """Return the file as a user of pandas reads it: lines above the header skipped, and nothing else."""
    if file.suffix == ".parquet":
        return pl.read_parquet(file)
    text = file.read_text(encoding="latin-1")
    lines = text.splitlines()
    start = next(
        i for i, line in enumerate(lines) if line.lower().startswith(("zeit", "time", "stroke", "0.000"))
    )
    separator = ";" if ";" in lines[start] else ","
    header = None if lines[start].startswith("0") else 0
    return pd.read_csv(io.StringIO("\n".join(lines[start:])), sep=separator, header=header)


@pytest.mark.parametrize("as_frame", [False, True], ids=["file", "frame"])
@pytest.mark.parametrize("name", READ)
def test_what_lacks_the_surface_alone_is_asked_for_it_and_read(
    exports: Path, name: str, as_frame: bool
) -> None:
    with pytest.raises(IncompleteRecording) as caught:
        of(exports / name, as_frame)
    assert caught.value.words() == ["--radius", "flat"]
    recording = of(exports / name, as_frame, radius="flat")
    assert len(recording) == 300
    assert np.isinf(recording.surface_radius).all()
    scale = 1e-3 if name.startswith("kN") else 1.0
    assert recording.force.max() == pytest.approx(2038.0 * scale, rel=1e-3)
    zero = 5.0 if name.startswith("zweg") else 0.0
    assert 1e3 * recording.deflection.max() - zero == pytest.approx(22.0, abs=0.05)
    assert recording.timed == (name != "no_time.csv")
    if recording.timed:
        np.testing.assert_allclose(np.diff(recording.time), 0.1, atol=1e-9)


@pytest.mark.parametrize("name", [n for n in READ if n.endswith(".csv") and n not in ("no_time.csv",)])
def test_every_number_is_that_of_the_text(exports: Path, name: str) -> None:
    recording = read_recording(exports / name, radius="flat")
    numbers = plain_numbers(exports / name)
    np.testing.assert_allclose(recording.deflection, numbers[:, -2] / 1000.0, rtol=1e-15)
    np.testing.assert_array_equal(recording.force, numbers[:, -1])


def test_the_lines_above_the_table_are_kept(exports: Path) -> None:
    assert read_recording(exports / "de_timestamps.csv", radius="flat").provenance == (
        "Prüfmaschine;ZwickRoell Z010",
        "Prüfer;Labor 2",
        'Reifen;Maxxis 2,1" 30 psi',
        "Datum;03.06.2025",
    )
    assert read_recording(exports / "de_meta_hash.csv", radius="flat").provenance == (
        "Prüfmaschine;ZwickRoell Z010",
        "Reifen;Maxxis 30 psi",
    )


@pytest.mark.parametrize("as_frame", [False, True], ids=["file", "frame"])
class TestWhatIsDoubtful:
    def test_a_gauge_whose_zero_is_off(self, exports: Path, as_frame: bool) -> None:
        (doubt,) = of(exports / "zweg_kraft_offset.csv", as_frame, radius="flat").doubts
        assert doubt.startswith("column 'Weg (mm)': the force begins at 5.0 mm of deflection")

    def test_kilonewtons_called_newtons(self, exports: Path, as_frame: bool) -> None:
        recording = of(exports / "kN_said_N.csv", as_frame, radius="flat")
        (doubt,) = recording.doubts
        assert doubt.startswith(("row 152, column 'Load (N)'", "sample 151, column 'Load (N)'"))
        assert "about 1000 times too small for a tire at 22 mm of deflection: kN? Then" in doubt
        assert f"doubtful: {doubt}" in recording.notes

    def test_millimetres_called_metres(self, exports: Path, as_frame: bool) -> None:
        with pytest.raises(
            RecordingError, match=r"22\.0027 m is deeper than a wheel.*in mm it would be 22 mm"
        ):
            of(exports / "m_declared.csv", as_frame)

    def test_a_radius_of_127_metres(self, exports: Path, as_frame: bool) -> None:
        (doubt,) = of(exports / "mm_but_radius_m.csv", as_frame).doubts
        first = "sample 1" if as_frame else "row 2"
        said = "a surface radius of 127 m is as good as flat: mm? Then it is 12.7 cm"
        assert doubt.startswith(f"{first}, column 'Radius (m)': {said}")

    def test_signs_are_turned_and_said(self, exports: Path, as_frame: bool) -> None:
        right = read_recording(exports / "de_units_header.csv", radius="flat")
        for channel in ("force", "defl"):
            recording = of(exports / f"neg_{channel}.csv", as_frame)
            np.testing.assert_allclose(recording.deflection, right.deflection, atol=1e-12)
            np.testing.assert_allclose(recording.force, right.force, atol=1e-12)
            named = "deflection" if channel == "defl" else channel
            assert f"the rig counts compression negative: {named} turned in sign" in recording.notes

    def test_what_is_right_is_not_doubted(self, exports: Path, as_frame: bool) -> None:
        for name in ("de_meta.csv", "de_timestamps.csv", "no_time.csv"):
            assert of(exports / name, as_frame, radius="flat").doubts == ()


@pytest.mark.parametrize("name", ["no_units.csv", "noheader.csv"])
def test_all_that_is_missing_is_listed_once_and_works_when_it_is_given(exports: Path, name: str) -> None:
    right = read_recording(exports / "de_units_header.csv", radius="flat")
    with pytest.raises(IncompleteRecording) as caught:
        read_recording(exports / name)
    given = caught.value.settings
    recording = read_recording(exports / name, columns=given.columns, units=given.units, radius=given.radius)
    np.testing.assert_allclose(recording.force, right.force)
    np.testing.assert_allclose(recording.time, right.time)
    with pytest.raises(IncompleteRecording) as framed:
        Recording.from_dataframe(frame_of(exports / name))
    given = framed.value.settings
    framed_recording = Recording.from_dataframe(
        frame_of(exports / name), columns=given.columns, units=given.units, radius=given.radius
    )
    np.testing.assert_allclose(framed_recording.deflection, right.deflection)


@pytest.mark.parametrize("name", [*READ, "no_units.csv", "noheader.csv"])
def test_the_command_that_is_proposed_works_when_it_is_copied(
    exports: Path, name: str, tmp_path: Path
) -> None:
    run = CliRunner()
    words = ["inspect", str(exports / name), "--out", str(tmp_path / "settings.toml")]
    refused = run.invoke(main, words)
    assert refused.exit_code == 2
    assert not (tmp_path / "settings.toml").exists()
    proposed = refused.stderr.splitlines()[-1].split("check: ", 1)[1]
    assert shlex.split(proposed)[: len(words) + 1] == ["tirelab", *words]
    done = run.invoke(main, shlex.split(proposed)[1:])
    assert done.exit_code == 0, done.output
    # what was written is what every command then reads, without a further word
    again = run.invoke(
        main,
        [
            "inspect",
            str(exports / name),
            "--settings",
            str(tmp_path / "settings.toml"),
            "--out",
            str(tmp_path / "b"),
        ],
    )
    assert again.exit_code == 0, again.output
    assert "settings read from settings.toml" in again.output


@pytest.mark.parametrize("name", WHOLE)
def test_what_says_everything_is_read_at_once(exports: Path, name: str) -> None:
    assert len(read_recording(exports / name)) == 300
