"""A recording without time is read, with its sampling or without, and says so."""

from pathlib import Path

import numpy as np
import pytest
from house_form import loading, refusal, write_rows
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.recording import Recording, RecordingError, read_recording
from tirelab.recordings.sampling import parse_interval
from tirelab.recordings.units import UnitError


@pytest.fixture
def timeless(tmp_path: Path) -> Path:
    _, deflection, force = loading()
    return write_rows(tmp_path / "a.csv", "Stroke [cm],Load [N]", deflection, force)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("10Hz", 0.1),
        ("10 Hz", 0.1),
        ("0.1s", 0.1),
        ("100 ms", 0.1),
        ("2 kHz", 5e-4),
        (10.0, 0.1),
        ("2min", 120.0),
    ],
)
def test_a_sampling_is_a_rate_or_an_interval(text: str | float, seconds: float) -> None:
    assert parse_interval(text) == pytest.approx(seconds, rel=1e-15)


@pytest.mark.parametrize("text", ["10", "fast", "0Hz", "-1s", "3 mm", -5.0])
def test_what_is_none_is_refused(text: str | float) -> None:
    with pytest.raises(UnitError):
        parse_interval(text)


def test_with_a_sampling_the_time_counts_as_measured(timeless: Path) -> None:
    recording = read_recording(timeless, radius="flat", sampling="5Hz")
    np.testing.assert_array_equal(recording.time, np.arange(101) * 0.2)
    assert recording.timed
    assert "time made of samples 0.2 s apart, as given" in recording.notes


def test_without_one_it_is_made_up_and_said(timeless: Path) -> None:
    recording = read_recording(timeless, radius="flat")
    np.testing.assert_array_equal(recording.time, np.arange(101.0))
    assert not recording.timed
    assert any(note.startswith("time was not measured: one second") for note in recording.notes)
    assert "time not measured" in repr(recording)


def test_a_rate_in_the_lines_above_the_table_is_proposed(timeless: Path) -> None:
    """Not taken: what these lines state may be of another channel."""
    text = timeless.read_text(encoding="utf-8")
    timeless.write_text(f"Sample Frequency (Hz): 250\n\n{text}", encoding="utf-8")
    (note,) = [n for n in read_recording(timeless, radius="flat").notes if "was not measured" in n]
    assert note.endswith("(the lines above the table state the sampling: --sampling 250Hz)")


def test_a_skipped_row_leaves_its_gap(timeless: Path) -> None:
    lines = timeless.read_text(encoding="utf-8").splitlines()
    lines[11] = ","
    timeless.write_text("\n".join(lines) + "\n", encoding="utf-8")
    recording = read_recording(timeless, radius="flat", sampling="1 s")
    np.testing.assert_array_equal(recording.time, [*range(10), *range(11, 101)])
    assert "1 gap in time, not filled: 2 s after 9 s" in recording.notes


def test_a_column_that_rises_like_a_clock_is_asked_about(tmp_path: Path) -> None:
    path = write_rows(tmp_path / "a.csv", "Elapsed [s],Stroke [cm],Load [N]", *loading())
    with pytest.raises(RecordingError, match=r"no column for time.*--columns time=#1"):
        read_recording(path, radius="flat")
    assert not read_recording(path, radius="flat", columns={"time": ""}).timed
    assert read_recording(path, radius="flat", columns={"time": "Elapsed"}).timed


def test_a_time_is_not_asked_for_where_no_column_can_be_one(tmp_path: Path) -> None:
    """A command with time=NAME to copy would ask for what was never measured."""
    _, deflection, force = loading()
    path = write_rows(tmp_path / "a.csv", "Channel A,Channel B", deflection, force)
    with pytest.raises(RecordingError, match="no column for deflection, force") as caught:
        read_recording(path, radius="flat")
    assert "time" not in str(caught.value)
    columns, units = {"deflection": "#1", "force": "#2"}, {"deflection": "cm", "force": "N"}
    assert not read_recording(path, radius="flat", columns=columns, units=units).timed


@pytest.mark.parametrize("header", ["", "A,B"])
def test_of_two_columns_none_is_asked_for_as_the_time(tmp_path: Path, header: str) -> None:
    """A stroke that is driven evenly one way rises as a clock does; the two other channels need both columns."""
    stroke = np.linspace(0.0, 0.3, 61)
    path = write_rows(tmp_path / "a.csv", header, stroke, 20.0 * stroke**1.4)
    with pytest.raises(IncompleteRecording) as caught:
        read_recording(path, radius="flat")
    assert caught.value.words()[:2] == ["--columns", "deflection=#1,force=#2"]


@pytest.mark.parametrize(
    ("header", "said"),
    [
        ("time_ms,force_N", "no column is left for the deflection (its columns are 'time_ms', 'force_N')"),
        (
            "time_ms,deflection_mm",
            "no column is left for the force (its columns are 'time_ms', 'deflection_mm')",
        ),
    ],
)
def test_a_channel_that_no_column_is_left_for_is_to_be_exported(
    tmp_path: Path, header: str, said: str
) -> None:
    time, _, force = loading()
    path = write_rows(tmp_path / "a.csv", header, 1e3 * time, force)
    refused = refusal(path, radius="flat")
    assert f"{said}; export it with the others" in refused
    assert "--columns" not in refused


def test_arrays_and_frames_alike() -> None:
    _, deflection, force = loading()
    arrays = Recording.from_arrays(None, deflection / 100.0, force, "flat")
    import polars as pl

    frame = pl.DataFrame({"Weg [cm]": deflection, "Kraft [N]": force})
    framed = Recording.from_dataframe(frame, radius="flat")
    assert not arrays.timed
    assert not framed.timed
    np.testing.assert_array_equal(arrays.deflection, framed.deflection)
    sampled = Recording.from_dataframe(frame, radius="flat", sampling=5.0)
    assert sampled.timed
    assert sampled.sampling_interval == pytest.approx(0.2)


def test_a_sampling_goes_over_a_column_and_says_so(rig: Path) -> None:
    recording = read_recording(rig, sampling="1s")
    assert recording.duration == 100.0
    assert "time made of samples 1 s apart, as given, not taken from its column" in recording.notes


def test_a_blank_line_above_a_header_that_is_written_again_is_no_sample(tmp_path: Path) -> None:
    """As controllers part the blocks of an acquisition: the next block goes on with the next sample."""
    block = "\n\nData Acquisition,Time,{}\nstroke [mm],force [N]\nmm,N\n"
    rows = [f"{0.1 * i:.1f},{2.0 * i:.1f}" for i in range(90)]
    text = "".join(block.format(10 * n) + "\n".join(rows[30 * n : 30 * (n + 1)]) for n in range(3))
    path = tmp_path / "a.csv"
    path.write_text(text.lstrip() + "\n\n", encoding="utf-8")
    found = read_recording(path, radius="flat", sampling="10 Hz")
    np.testing.assert_allclose(found.time, 0.1 * np.arange(90), atol=1e-12)
    assert [note for note in found.notes if "gap" in note or "empty" in note] == []
    assert any(note.startswith("header written again") for note in found.notes)
