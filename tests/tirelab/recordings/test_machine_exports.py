"""Exports of test machines and loggers are read as they come, or asked for in one command that works when copied."""

from __future__ import annotations

import importlib
import json
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from exported import EXPORTS, Motion, damped, mm, pressed, table
from tirelab.cli import main
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.reading import Reading
from tirelab.recordings.recording import Recording, RecordingError, read_recording

for _family in ("machine", "logger", "table", "language", "binary"):
    importlib.import_module(f"{_family}_exports")

ASKED = {
    "roehrig_damper.csv": "'lbs' is not a unit of force; did you mean lbf?",
    "catman.asc": "no column for time",
    "scale_in_grams.csv": "no column for force; its columns are 'millis', 'position_um', 'weight_g'",
    "labview_short_rows.lvm": "no column for time; its columns are 'X_Value', 'Displacement'",
    "arduino_ms.txt": "has no header row",
    "epoch_ms.csv": "column 'timestamp': has no unit",
    "epoch_us.csv": "column 'ts': has no unit",
    "version_7_3.mat": "no unit",
    "capitals.dat": "no column for deflection",
}
"""What these leave open: the command that is printed, copied, reads them."""

REFUSED = {
    "arduino_monitor.log": "make columns of them: sed -i 's/ -> /,/' ",
    "repeated_stamps.csv": "row 3, column 'Time (s)': time repeats 0 s, as do 199 others: the clock is coarser than "
    "the samples; if these are evenly spaced, give their rate: --sampling 10Hz",
}
"""What these cannot be read for; each says what to do."""

UNTIMED = ("sample_numbers.csv", "labview_headings.lvm")
"""Those without a time: it is said."""

SAID = {
    "two_gauges.csv": "deflection taken from 'Displacement (mm)'; not from 'Crosshead (mm)' (#2)",
    "set_point_beside.csv": "force taken from 'Axial Force (N)'; not from 'Axial Force Command (N)' (#4)",
    "peak_beside.csv": "force taken from 'Actual Load [N]'; not from 'Peak Load [N]' (#2)",
    "summary_below.csv": "rows below the table left out: row 403 ('Maximum'), 404 ('Minimum')",
    "summary_in_sheet.xlsx": "rows below the table left out: row 403 ('Maximum')",
    "header_again.csv": "header written again, its rows read on: row 122, 263",
    "mts_flextest_blocks.dat": "header written again, its rows read on: row 166, 324",
    "remarks_between.csv": "rows of text among the numbers left out: row 304 ('// second cycle')",
    "step_names_between.txt": "rows of text among the numbers left out: row 2 ('Step 1: load'), 203 "
    "('Step 2: load again')",
    "epoch.csv": "time counted from the first sample, which is at 1748959500.250000 s since 1970",
    "numbers_as_text.xlsx": "numbers that are stored as text read with decimal commas",
    "trapezium_ja.csv": "not UTF-8 (byte 0x8e at 0): read as Shift-JIS (CP 932)",
    "korean.csv": "not UTF-8 (byte 0xbd at 0): read as EUC-KR (CP 949)",
    "taiwan.csv": "not UTF-8 (byte 0xae at 0): read as Big5 (CP 950)",
    "full_counter.csv": "the counter of the time is full before row 102: it goes on from there",
    "labview_headings.lvm": "units taken from the row above the names that begins with 'Y_Unit_Label'",
    "negative_compression.csv": "the rig counts compression negative: deflection and force turned in sign",
}
"""What is done to the numbers of these, and has to be said."""


def inspected(words: Sequence[str]) -> Any:
    return CliRunner().invoke(main, ["inspect", *words, "--json"])


def assert_the_motion(recording: Recording, motion: Motion, without: Sequence[int] = ()) -> None:
    """Every value within half a digit of those that were written, of which none has fewer than four."""
    for values, truth in (
        (recording.time - recording.time[0], motion.time),
        (recording.deflection, motion.deflection),
        (recording.force, motion.force),
    ):
        whole = np.delete(truth, without)
        assert values.shape == whole.shape
        np.testing.assert_allclose(values, whole, atol=1e-4 * np.ptp(truth))


@pytest.mark.parametrize("name", EXPORTS)
def test_it_is_read_or_asked_for(name: str, tmp_path: Path) -> None:
    export, path = EXPORTS[name], tmp_path / name
    export.write(path, export.motion)
    options = ["--part"] if export.signed else ["--radius", "flat"]
    result = inspected([str(path), *options])
    if name in REFUSED:
        assert result.exit_code == 2
        assert REFUSED[name] in result.stderr
        return
    if name in ASKED:
        assert result.exit_code == 2
        assert ASKED[name] in result.stderr
        command = shlex.split(result.stderr.rpartition("guesses to check: ")[2])
        assert command[:2] == ["tirelab", "inspect"]
        result = inspected(command[2:])
    assert result.exit_code == 0, result.stderr
    shown = json.loads(result.stdout)["recordings"][0]
    assert SAID.get(name, "") in "\n".join([*shown["notes"], ""])
    assert shown["doubts"] == []
    # the settings that were written are read now
    trial = "@trial1" if name.startswith("trapezium_trials") else ""
    recording = read_recording(f"{path}{trial}")
    assert recording.timed == (name not in UNTIMED)
    motion = export.motion
    if name in UNTIMED:
        motion = Motion(recording.time - recording.time[0], motion.deflection, motion.force)
    assert_the_motion(recording, motion, without=(30, 31, 90, 250) if name.startswith("nan") else ())


def test_the_second_trial_is_as_long_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    EXPORTS["trapezium_trials.csv"].write(path, pressed())
    assert len(read_recording(f"{path}@trial2", radius="flat")) == 240


def written(path: Path, head: str, *lines: str) -> Path:
    """Return a file with rows of a motion below a header, and lines after the 200th of them."""
    m = pressed()
    rows = table((m.time, mm(m), m.force)).splitlines()
    path.write_text("\n".join([head, *rows[:200], *lines, *rows[200:]]) + "\n")
    return path


HEAD = "Time (s),Displacement (mm),Force (N)"


class TestNothingIsLostWithoutAWord:
    @pytest.mark.parametrize(
        ("lines", "said"),
        [
            (["Maximum,20.0,1500.0"], "row 202, column 'Time (s)': 'Maximum' is not a number"),
            (["20.05,x,1500.0"], "row 202, column 'Displacement (mm)': 'x' is not a number"),
            (["x,5.0,1500.0"], "row 202, column 'Time (s)': 'x' is not a number"),
            (["Time (s),Temperature (C),Pressure (bar)"], "row 202: another table begins here"),
            ([HEAD, "s,cm,N"], "row 203, column 'Displacement (mm)': the unit is 'cm' here and 'mm' above"),
        ],
    )
    def test_a_row_with_numbers_in_it_or_of_another_table(
        self, lines: list[str], said: str, tmp_path: Path
    ) -> None:
        with pytest.raises(RecordingError) as caught:
            read_recording(written(tmp_path / "a.csv", HEAD, *lines), radius="flat")
        assert said in str(caught.value)

    def test_the_part_above_another_table_is_read_as_it_is_named(self, tmp_path: Path) -> None:
        path = written(tmp_path / "a.csv", HEAD, "Time (s),Temperature (C),Pressure (bar)")
        with pytest.raises(
            RecordingError, match=r"read the one above it, a\.csv@2:201, or this one, --skip-rows 201"
        ):
            read_recording(path, radius="flat")
        assert len(read_recording(f"{path}@2:201", radius="flat")) == 200

    @pytest.mark.parametrize(
        "names", [["Peak (N)", "Rise (mm)", "Gauge A", "1281068"], ["Peak (N)", "Rise (mm)"]]
    )
    def test_a_table_of_another_width_below_is_named_with_the_part_above_it(
        self, names: list[str], tmp_path: Path
    ) -> None:
        """As a controller writes the largest reading of each gauge at the end, in columns of their own."""
        m = pressed()
        path = tmp_path / "a.txt"
        rows = table((m.time, mm(m), m.force)).replace(",", "\t")
        below = [
            "",
            "Data Acquisition\t\t\t\tTime:\t320.0\ts",
            "\t".join(names),
            "\t".join("2.5" for _ in names),
        ]
        path.write_text("\n".join([HEAD.replace(",", "\t"), rows.rstrip(), *below]) + "\n")
        with pytest.raises(RecordingError, match=r"row 404: another table begins here; .* a\.txt@2:402, or"):
            read_recording(path, radius="flat")
        assert len(read_recording(f"{path}@2:402", radius="flat")) == 400
        later = read_recording(f"{path}@302:401", radius="flat")
        assert later.history is not None
        assert (len(later.history), len(later)) == (300, 100)

    def test_statistics_below_a_column_that_is_not_read(self, tmp_path: Path) -> None:
        m = pressed()
        path = tmp_path / "a.csv"
        rows = table((np.arange(1.0, 401.0), mm(m), m.force))
        path.write_text("Sample,Displacement (mm),Force (N)\n" + rows + "Mean,10.0,612.5\n")
        recording = read_recording(path, radius="flat", sampling="10Hz")
        assert_the_motion(recording, m)
        assert "rows below the table left out: row 402 ('Mean')" in recording.notes

    @pytest.mark.parametrize("cell", ["39.9x", "3q.9", "~400"])
    def test_a_damaged_last_row_is_no_row_of_statistics(self, tmp_path: Path, cell: str) -> None:
        m = pressed()
        path = tmp_path / "a.csv"
        rows = table((np.arange(1.0, 401.0), mm(m), m.force)).splitlines()
        rows[-1] = cell + rows[-1][rows[-1].index(",") :]
        path.write_text("\n".join(["Sample,Displacement (mm),Force (N)", *rows]))
        with pytest.raises(RecordingError, match=r"row 401, column 'Sample'"):
            read_recording(path, radius="flat", sampling="10Hz")

    def test_tests_one_below_the_other_are_named(self, tmp_path: Path) -> None:
        m = pressed()
        path = tmp_path / "a.csv"
        path.write_text(HEAD + "\n" + 2 * (table((m.time, mm(m), m.force)) + HEAD + "\n"))
        with pytest.raises(
            RecordingError, match=r"row 403.*goes back.*read one of them: a\.csv@2:401, a\.csv@403:802"
        ):
            read_recording(path, radius="flat")
        assert_the_motion(read_recording(f"{path}@2:401", radius="flat"), m)
        assert_the_motion(read_recording(f"{path}@403:802", radius="flat"), m)

    def test_a_radius_that_is_given_is_no_other_deflection(self, tmp_path: Path) -> None:
        m = pressed()
        path = tmp_path / "a.csv"
        rows = table((m.time, mm(m), 0.0 * m.time + 127.0, m.force))
        path.write_text("Time (s),Displacement (mm),Radius (mm),Force (N)\n" + rows)
        notes = read_recording(path, radius="flat").notes
        assert notes == ("surface radius flat as given, not taken from 'Radius (mm)'",)

    @pytest.mark.parametrize("unit", ["counts", "%", "V", "deg"])
    def test_what_is_no_length_is_asked_for_without_a_guess(self, unit: str, tmp_path: Path) -> None:
        with pytest.raises(RecordingError) as caught:
            read_recording(
                written(tmp_path / "a.csv", f"Time (s),Displacement ({unit}),Force (N)"), radius="flat"
            )
        assert not isinstance(caught.value, IncompleteRecording)
        assert (
            f"column 'Displacement ({unit})': {unit!r} is not a unit of length" in str(caught.value)
            or unit == "%"
        )
        assert "did you mean" not in str(caught.value)


class TestErrors:
    def test_a_workbook_of_words(self, tmp_path: Path) -> None:
        book = openpyxl.Workbook()
        for row in (("only", "words"), ("no", "numbers"), ("at", "all")):
            book.active.append(row)
        book.save(tmp_path / "a.xlsx")
        result = inspected([str(tmp_path / "a.xlsx"), "--radius", "flat"])
        assert result.exit_code == 2
        assert "a.xlsx: no column holds numbers (its columns are 'only', 'words'); export" in result.stderr
        assert "NAME" not in result.stderr

    @pytest.mark.parametrize(
        ("name", "options"), [("a.csv@20s:10s", []), ("a.csv", ["--from", "20s", "--to", "10s"])]
    )
    def test_a_part_that_ends_before_it_begins(self, name: str, options: list[str], tmp_path: Path) -> None:
        written(tmp_path / "a.csv", HEAD)
        result = inspected([str(tmp_path / name), "--radius", "flat", *options])
        assert result.exit_code == 2
        assert "20s to 10s ends before it begins; write the earlier bound first: 10s:20s" in result.stderr


class TestParts:
    def part(self, path: Path, scale: float = 1.0) -> Path:
        m = damped()
        path.write_text("Time (s),Displacement (mm),Force (N)\n" + table((m.time, mm(m), scale * m.force)))
        return path

    @pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
    def test_the_force_of_a_part_is_compared_with_no_tires(self, scale: float, tmp_path: Path) -> None:
        how = {"radius": "flat"}
        recording = read_recording(self.part(tmp_path / "a.csv", scale), **how)
        assert recording.doubts == ()

    def test_inspect_asks_a_part_for_no_surface_and_keeps_that_it_is_one(self, tmp_path: Path) -> None:
        path = self.part(tmp_path / "a.csv")
        assert inspected([str(path)]).exit_code == 2
        result = inspected([str(path), "--part"])
        assert result.exit_code == 0, result.stderr
        shown = json.loads(result.stdout)["recordings"][0]
        assert shown["facts"]["surface"] == "none: a part, not a tire"
        assert "radius" not in [channel["channel"] for channel in shown["channels"]]
        assert "part = true" in (tmp_path / "recording.toml").read_text()
        assert_the_motion(read_recording(path), damped())

    def test_a_soft_spring_is_no_part_unless_it_is_said(self, tmp_path: Path) -> None:
        m = pressed()
        path = tmp_path / "a.csv"
        path.write_text(HEAD + "\n" + table((m.time, mm(m), 1e-3 * m.force), digits=8))
        (doubt,) = read_recording(path, radius="flat").doubts
        assert doubt.endswith(
            "kN? Then --units force=kN; if this is no tire, write part = true into recording.toml"
        )
        (tmp_path / "recording.toml").write_text("part = true\n")
        assert read_recording(path).doubts == ()

    def test_rebound_that_is_stronger_leaves_the_signs_as_they_are(self, tmp_path: Path) -> None:
        m = damped()
        path = tmp_path / "a.csv"
        force = np.where(m.force < 0.0, 3.0 * m.force, m.force)
        path.write_text(HEAD + "\n" + table((m.time, mm(m), force)))
        (tmp_path / "recording.toml").write_text("part = true\n")
        assert_the_motion(read_recording(path), Motion(m.time, m.deflection, force))

    def test_the_words_of_another_command_ask_for_no_surface(self) -> None:
        assert Reading().of_part().words() == ["--radius", "flat"]
        assert Reading(radius="25.4cm").of_part().words() == ["--radius", "25.4cm"]

    def test_part_is_true_or_false(self, tmp_path: Path) -> None:
        path = self.part(tmp_path / "a.csv")
        (tmp_path / "recording.toml").write_text('part = "yes"\n')
        with pytest.raises(RecordingError, match="part is 'yes'; write part = true, or leave it out"):
            read_recording(path)
