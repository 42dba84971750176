"""A gauge that does not read zero when nothing is loaded: its zero is given, or proposed in a command that works."""

import json
import shlex
from functools import partial
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from click.testing import CliRunner
from house_form import loading, refusal, write_rows
from tirelab.cli import main
from tirelab.errors import TirelabError
from tirelab.identification.identify import identify
from tirelab.recordings.choices import Choices
from tirelab.recordings.inspection import inspect_recording
from tirelab.recordings.reading import Reading
from tirelab.recordings.recording import Recording, read_recording, understand
from tirelab.recordings.settings_file import settings_text
from tirelab.recordings.zero import FARTHEST, Zero, parse_zeros, refuse_far_zeros

HEADER = "time [s],Weg [mm],force [N]"


def press(folder: Path, shift: float, tare: float = 0.0, *, turned: float = 1.0) -> Path:
    """A file with one triangle of 25 mm; shift [mm] and tare [N]: what the gauges read with nothing loaded."""
    time, deflection, force = loading(201)
    x, f = shift + turned * 10.0 * deflection, tare + turned * force
    return write_rows(folder / "press.csv", HEADER, time, x, f)


def test_a_zero_is_subtracted_shown_kept_and_said_in_commands(tmp_path: Path) -> None:
    file = press(tmp_path, 30.0, 200.0)
    reading = Reading(radius="flat", zero={"deflection": "30 mm", "force": "0.2 kN"})
    found = inspect_recording(file, reading)
    # 25 mm and 550.9 N/cm^B 2.5^1.422 of the article's tire
    assert np.ptp(found.recording.deflection) == pytest.approx(0.025)
    assert (found.recording.deflection[0], found.recording.force[0]) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert "force less 0.2 kN, its zero as given" in found.recording.notes
    assert found.recording.doubts == ()
    assert {row.channel: row.zero for row in found.channels if row.zero} == {
        "deflection": "30 mm",
        "force": "0.2 kN",
    }
    settings = tmp_path / "recording.toml"
    settings.write_text(settings_text(settings, {found.key: found.settings}), encoding="utf-8")
    assert read_recording(file).deflection.min() == pytest.approx(0.0, abs=1e-9)
    assert reading.words() == [
        *("--radius", "flat"),
        *("--zero", "deflection=30 mm", "--zero", "force=0.2 kN"),
    ]


@pytest.mark.parametrize(
    ("begins", "stroke", "shown"),
    [
        (0.0012, 0.025, "1.2 mm"),
        (-1e-6, 0.025, "0.0 mm"),
        (2.77e-8, 2.8e-7, "0.00003 mm"),
        (0.0, 2e-4, "0.00 mm"),
    ],
)
def test_where_the_force_begins_is_told_to_the_tenth_of_what_counts(
    begins: float, stroke: float, shown: str
) -> None:
    assert Zero(begins, stroke, begins, 0.0).shown == shown


def test_a_zero_stands_in_the_file_of_settings_in_one_line(tmp_path: Path) -> None:
    file = press(tmp_path, 30.0)
    (tmp_path / "recording.toml").write_text('radius = "flat"\nzero = {deflection = "3 cm"}\n')
    assert read_recording(file).deflection.max() == pytest.approx(0.025)
    (tmp_path / "recording.toml").write_text('radius = "flat"\nzero = {deflection = "3 N"}\n')
    assert "'N' is not a unit of length" in refusal(file)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("deflection=30", "no length"),
        ("force=3mm", "not a unit of force"),
        (
            "deflection=0.4V",
            "write what `tirelab inspect` shows there with its unit, such as deflection=30mm",
        ),
        ("time=3s", "'time' has no zero"),
        ("stroke=3mm", "no channel"),
    ],
)
def test_a_zero_that_is_none_is_refused(text: str, said: str) -> None:
    with pytest.raises(TirelabError, match=said):
        parse_zeros([text])


@pytest.mark.parametrize(("shift", "tare", "words"), [
    (30.0, 0.0, ["deflection=30mm"]),
    (150.0, 200.0, ["deflection=150mm", "force=200N"]),
])  # fmt: skip
def test_the_command_that_a_doubt_proposes_works(
    tmp_path: Path, shift: float, tare: float, words: list[str]
) -> None:
    (doubt,) = read_recording(press(tmp_path, shift, tare), radius="flat").doubts
    assert "let the diagnosis find" not in doubt  # its offset is bounded
    proposed = shlex.split(doubt.split("`")[1])
    assert proposed[-2 * len(words) :] == [w for word in words for w in ("--zero", word)]
    done = CliRunner().invoke(main, proposed[1:])
    assert done.exit_code == 0, done.output
    assert "DOUBTFUL" not in done.output
    assert read_recording(tmp_path / "press.csv").deflection.max() == pytest.approx(0.025, abs=1e-4)


def test_a_zero_that_the_diagnosis_can_find_is_left_to_it(tmp_path: Path) -> None:
    file = press(tmp_path, 5.0)
    recording = read_recording(file, radius="flat")
    assert recording.doubts[0].endswith("--zero deflection=5mm`, or let the diagnosis find the offset")
    refuse_far_zeros([recording])
    assert pytest.approx(0.01) == FARTHEST


def test_what_goes_on_before_the_first_reading_is_no_beginning(tmp_path: Path) -> None:
    """A tare of 200 N at 150 mm: a law through both would begin at some other deflection that nobody saw."""
    found = inspect_recording(press(tmp_path, 150.0, 200.0), Choices(radius="flat"))
    assert dict(found.facts)["zero"] == (
        "not seen: the readings begin at 150.0 mm of deflection with a force of 200 N"
    )


def test_a_zero_that_no_effect_holds_is_refused_by_what_judges(tmp_path: Path) -> None:
    file = press(tmp_path, 150.0, 200.0)
    with pytest.raises(TirelabError, match=r"farther off than 10\.0 mm is the gauge's zero; give it: `"):
        identify([read_recording(file, radius="flat")])
    for command in ("compare", "diagnose"):
        done = CliRunner().invoke(
            main, [command, str(file), "--radius", "flat", "--out", str(tmp_path / "out")]
        )
        assert done.exit_code == 2
        assert "--zero deflection=150mm --zero force=200N" in done.output


@pytest.mark.parametrize("low", [0.005, 0.015, 0.025])
def test_a_tire_that_is_loaded_all_the_time_is_neither_doubted_nor_refused(low: float) -> None:
    time, deflection, _ = loading(201)
    x = low + 0.004 * deflection
    recording = Recording.from_arrays(time, x, 550.9 * (100.0 * x) ** 1.422, "flat")
    assert (recording.doubts, recording.far_zero) == ((), "")


def test_arrays_are_told_what_to_subtract() -> None:
    time, deflection, force = loading(201)
    recording = Recording.from_arrays(time, 0.03 + deflection / 100.0, force, "flat")
    assert "subtract 30mm from the deflection" in recording.far_zero


@pytest.mark.parametrize("as_frame", [False, True], ids=["file", "frame"])
def test_python_says_zeros_as_the_command_line_does(tmp_path: Path, as_frame: bool) -> None:
    file = press(tmp_path, 30.0, 200.0)
    source = (
        partial(Recording.from_dataframe, pl.read_csv(file)) if as_frame else partial(read_recording, file)
    )
    recording = source(radius="flat", zero={"deflection": "30 mm", "force": "0.2 kN"})
    # 25 mm, and 550.9 N/cm^B 2.5^1.422 of the article's tire
    assert recording.deflection.max() == pytest.approx(0.025)
    assert recording.force.max() == pytest.approx(550.9 * 2.5**1.422)
    assert (recording.deflection.min(), recording.force.min()) == pytest.approx((0.0, 0.0), abs=1e-9)
    for zero, said in (
        ({"deflection": 0.03}, "'0.03' is no length"),
        ({"force": "3 mm"}, "not a unit of force"),
        ({"time": "3 s"}, "'time' has no zero"),
    ):
        with pytest.raises(TirelabError, match=said):
            source(radius="flat", zero=zero)


def test_the_zero_that_a_doubt_proposes_of_a_frame_works(tmp_path: Path) -> None:
    frame = pl.read_csv(press(tmp_path, 30.0))
    proposed = Recording.from_dataframe(frame, radius="flat").far_zero.rpartition("zero=")[2]
    recording = Recording.from_dataframe(frame, radius="flat", zero=json.loads(proposed))
    assert recording.deflection.max() == pytest.approx(0.025, abs=1e-4)
    assert recording.doubts == ()


def test_a_frame_with_signs_in_doubt_is_told_signs_and_zeros_at_once(tmp_path: Path) -> None:
    frame = pl.read_csv(press(tmp_path, 30.0, turned=-1.0))
    with pytest.raises(TirelabError) as caught:
        Recording.from_dataframe(frame, radius="flat")
    columns, zero = str(caught.value).rpartition("columns=")[2].split(", zero=")
    recording = Recording.from_dataframe(
        frame, radius="flat", columns=json.loads(columns), zero=json.loads(zero)
    )
    assert recording.deflection.max() == pytest.approx(0.025, abs=1e-4)
    assert recording.doubts == ()


def test_python_refuses_what_it_does_not_know(tmp_path: Path) -> None:
    file = press(tmp_path, 0.0)
    with pytest.raises(TypeError, match=r"'zeros'; beside those of the signature: sampling, skip_rows, zero"):
        read_recording(file, radius="flat", zeros={})  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"'skip_rows'; beside those of the signature: sampling, zero"):
        Recording.from_dataframe(pl.read_csv(file), radius="flat", skip_rows=0)  # type: ignore[call-arg]


def test_a_part_that_is_reached_far_away_is_told_the_zero_of_its_gauge(tmp_path: Path) -> None:
    """A crosshead that counts the separation of its tools, which falls; slack of some millimetres is the part's own."""
    travel = np.linspace(0.0, 3.0, 200)
    force = 2.0 * np.maximum(travel - 1.0, 0.0) ** 2
    for start, begins in ((14.0, 13.0), (3.0, 2.0)):
        path = write_rows(
            tmp_path / "a.csv", "t [s],separation [mm],force [N]", travel, start - travel, force
        )
        how = Choices({"deflection": "-separation [mm]", "force": "+force [N]"}, part=True)
        doubts = understand(path, how).recording.doubts
        assert len(doubts) == (begins > 10.0)
        assert all(f"--part --zero deflection={begins:g}" in doubt for doubt in doubts)
