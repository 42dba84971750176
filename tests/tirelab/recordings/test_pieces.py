"""A part of a file is named by time, by rows, or as one of the tests that stand side by side in it."""

from pathlib import Path

import numpy as np
import pytest
from house_form import HOUSE_FORM, loading, write_rows
from tirelab.recordings.files import recording_files
from tirelab.recordings.pieces import Piece, is_range, parse_piece, split_piece
from tirelab.recordings.reading import Reading
from tirelab.recordings.recording import RecordingError, read_recording

SIDE_BY_SIDE = "Probe 1;;;Probe 2;;\nZeit [s];Weg [mm];Kraft [N];Zeit [s];Weg [mm];Kraft [N]\n"


@pytest.fixture
def side_by_side(tmp_path: Path) -> Path:
    """Two tests, the second with half the deflection and two thirds of the rows."""
    time, deflection, force = loading()
    lines = []
    for i, (t, x, f) in enumerate(zip(time, 10 * deflection, force, strict=True)):
        second = f"{t / 2:.1f};{x / 2:.3f};{f / 2:.3f}" if i < 67 else ";;"
        lines.append(f"{t:.1f};{x:.3f};{f:.3f};{second}")
    path = tmp_path / "both.csv"
    path.write_text(SIDE_BY_SIDE + "\n".join(lines) + "\n", encoding="utf-8")
    return path


class TestNames:
    @pytest.mark.parametrize(
        ("text", "piece"),
        [
            ("10s:20s", Piece(None, "10s", "20s")),
            (":2min", Piece(None, "", "2min")),
            ("100:", Piece(None, "100", "")),
            ("trial2", Piece(2)),
            ("trial3@1.5s:", Piece(3, "1.5s", "")),
        ],
    )
    def test_what_is_read_of_them(self, text: str, piece: Piece) -> None:
        assert parse_piece(text, "a.csv") == piece

    @pytest.mark.parametrize("text", ["", "10s", ":", "trial", "a:b", "10s:20s:30s"])
    def test_what_is_none_is_refused(self, text: str) -> None:
        with pytest.raises(RecordingError, match="is no part of a file; write 10s:20s"):
            parse_piece(text, "a.csv")

    def test_a_file_whose_own_name_has_the_sign_goes_first(self, tmp_path: Path) -> None:
        for name in ("a.csv", "a.csv@10s:20s"):
            (tmp_path / name).touch()
        assert split_piece(tmp_path / "a.csv@10s:20s") == (tmp_path / "a.csv@10s:20s", Piece())
        assert split_piece(tmp_path / "a.csv@5s:") == (tmp_path / "a.csv", Piece(None, "5s", ""))
        assert split_piece(tmp_path / "b.csv@5s:") == (tmp_path / "b.csv@5s:", Piece())

    def test_ranges_are_told_from_files(self) -> None:
        assert is_range("10s:20s")
        assert is_range("1:")
        assert not is_range("held_out.csv")
        assert not is_range(":")
        assert not is_range("C:press.csv")


class TestRanges:
    """The house recording has 101 samples, 0.2 s apart; its first is in row 2."""

    @pytest.mark.parametrize(
        ("piece", "first", "last"),
        [
            ("4s:8s", 4.0, 7.8),
            ("4000ms:0.1min", 4.0, 5.8),
            (":0.6s", 0.0, 0.4),
            ("0.6s:1s", 0.6, 0.8),
            ("2:4", 0.0, 0.4),
            ("100:", 19.6, 20.0),
            ("19.6s:1e400s", 19.6, 20.0),
        ],
    )
    def test_time_has_its_end_left_out_and_rows_have_both(
        self, rig: Path, piece: str, first: float, last: float
    ) -> None:
        recording = read_recording(f"{rig}@{piece}")
        assert recording.time[0] == pytest.approx(first)
        assert recording.time[-1] == pytest.approx(last)
        whole = read_recording(rig)
        inside = (whole.time >= first - 1e-9) & (whole.time <= last + 1e-9)
        np.testing.assert_array_equal(recording.force, whole.force[inside])
        assert any(f"{inside.sum()} of 101 samples read" in note for note in recording.notes)

    def test_two_parts_share_no_sample_and_lose_none(self, rig: Path) -> None:
        parts = [read_recording(f"{rig}@{piece}") for piece in (":7s", "7s:13s", "13s:")]
        np.testing.assert_array_equal(np.concatenate([p.time for p in parts]), read_recording(rig).time)

    def test_a_part_knows_what_was_recorded_before_it(self, rig: Path) -> None:
        part, whole = read_recording(f"{rig}@7s:13s"), read_recording(rig)
        assert part.history is not None
        assert part.history.time[-1] < part.time[0]
        for (name, joined), (_, own) in zip(part.whole.channels(), whole.channels(), strict=True):
            np.testing.assert_array_equal(joined, own[: joined.size], err_msg=name)
        assert whole.history is None
        assert whole.whole is whole
        assert read_recording(f"{rig}@:7s").history is None

    def test_a_part_may_be_a_hold_that_the_gauge_reads_in_steps(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        deflection[60:] = deflection[60]
        path = write_rows(tmp_path / "a.csv", HOUSE_FORM, time, deflection, [25.4] * 101, force)
        assert np.ptp(read_recording(f"{path}@70:").deflection) == 0.0
        with pytest.raises(RecordingError, match="in every row; name the column that moves"):
            read_recording(write_rows(tmp_path / "b.csv", HOUSE_FORM, time, [1.0] * 101, [25.4] * 101, force))

    def test_a_history_that_no_recording_can_have_is_none(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        time[20] = time[19]
        path = write_rows(tmp_path / "a.csv", HOUSE_FORM, time, deflection, [25.4] * 101, force)
        assert read_recording(f"{path}@50:").history is None

    def test_bounds_hold_for_every_file_that_has_none_of_its_own(self, rig: Path) -> None:
        reading = Reading(start="4s", stop="8s")
        assert reading(rig).time[0] == 4.0
        assert reading(f"{rig}@10s:").time[0] == 10.0

    def test_too_few_samples_are_refused_with_what_there_is(self, rig: Path) -> None:
        with pytest.raises(
            RecordingError, match="30s to the end holds 0 samples; the recording has 0 to 20 s, rows 2 to 102"
        ):
            read_recording(f"{rig}@30s:")
        with pytest.raises(RecordingError, match="is not a unit of time"):
            read_recording(f"{rig}@10m:")

    def test_a_wrong_sample_is_named_by_its_row_in_the_file(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        time[60] = time[58]
        path = write_rows(tmp_path / "a.csv", HOUSE_FORM, time, deflection, [25.4] * 101, force)
        with pytest.raises(RecordingError, match=r"row 62, column 'time \[s\]': time goes back"):
            read_recording(f"{path}@50:")


class TestTrials:
    def test_each_is_read_by_its_number(self, side_by_side: Path) -> None:
        time, deflection, force = loading()
        second = read_recording(f"{side_by_side}@trial2", radius="flat")
        assert len(second) == 67
        np.testing.assert_allclose(second.force, np.round(force[:67] / 2, 3))
        np.testing.assert_allclose(second.time, np.round(time[:67] / 2, 1))
        assert second.name == "both@trial2"
        assert second.provenance == ("Probe 1;;;Probe 2",)
        first = read_recording(f"{side_by_side}@trial1", radius="flat")
        np.testing.assert_allclose(first.deflection, np.round(10 * deflection, 3) / 1000.0)

    def test_a_number_behind_the_unit_counts_a_trial_too(self, tmp_path: Path) -> None:
        """As a school's data logger writes them: `Force (N) Run 2`."""
        time, deflection, force = loading()
        names = ",".join(f"Time (s) Run {n},Force (N) Run {n},Position (mm) Run {n}" for n in (1, 2))
        rows = (time, force, 10.0 * deflection, time, 2.0 * force, 10.0 * deflection)
        path = write_rows(tmp_path / "a.csv", names, *rows)
        first, second = (read_recording(f"{path}@trial{n}", radius="flat") for n in (1, 2))
        np.testing.assert_allclose(second.force, 2.0 * first.force, atol=0.011)  # six digits

    def test_none_is_chosen_for_the_user(self, side_by_side: Path) -> None:
        with pytest.raises(
            RecordingError, match=r"holds 2 trials side by side; name one: both\.csv@trial1 to"
        ):
            read_recording(side_by_side, radius="flat")
        with pytest.raises(RecordingError, match="has 2 trials side by side; name @trial1 to @trial2"):
            read_recording(f"{side_by_side}@trial3", radius="flat")

    def test_a_file_given_to_a_command_is_all_of_them(self, side_by_side: Path, rig: Path) -> None:
        files, _ = recording_files([side_by_side, rig])
        assert [file.name for file in files] == ["both.csv@trial1", "both.csv@trial2", "flat.csv"]

    def test_a_trial_that_is_not_there_is_refused_although_columns_are_named(self, tmp_path: Path) -> None:
        """As after `inspect`, which names them; what no words find is for the user to know."""
        time, deflection, force = loading()
        columns = {"deflection": "Stroke [cm]", "force": "Load [N]"}
        path = write_rows(tmp_path / "a.csv", "Time [s],Stroke [cm],Load [N]", time, deflection, force)
        with pytest.raises(
            RecordingError, match="has no trial 7 side by side with others; leave out @trial7"
        ):
            read_recording(f"{path}@trial7", radius="flat", columns=columns)
        own = {"deflection": "a2 [cm]", "force": "b2 [N]"}
        header = "Time [s],a1 [cm],b1 [N],a2 [cm],b2 [N]"
        path = write_rows(tmp_path / "b.csv", header, *(time, deflection, force, deflection, force / 2))
        second = read_recording(f"{path}@trial2", radius="flat", columns=own)
        np.testing.assert_allclose(second.force, force / 2, rtol=1e-5)

    def test_one_time_may_serve_all(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "a.csv",
            "Time [s],Stroke 1 [cm],Load 1 [N],Stroke 2 [cm],Load 2 [N]",
            *(time, deflection, force, deflection, force / 2),
        )
        second = read_recording(f"{path}@trial2", radius="flat")
        np.testing.assert_allclose(second.time, time)
        np.testing.assert_allclose(second.force, force / 2, rtol=1e-5)

    def test_a_numbered_column_is_that_of_each_test_where_their_names_differ_in_numbers(
        self, tmp_path: Path
    ) -> None:
        """As an indenter writes them: each channel with its clock. `#1` is the first test's in the first test alone."""
        time, deflection, force = loading()
        names = "T_{0}_Clock [s],Y_{0}_Fn [N],T_{0}_Clock [s],Y_{0}_Disp [mm]"
        slower = 2.0 * time
        rows = (time, force, time, 10.0 * deflection, slower, 2.0 * force, slower, 10.0 * deflection)
        header = ",".join(map(names.format, (1, 2)))
        path = write_rows(tmp_path / "a.csv", header, *rows)
        for n in (1, 2):
            with pytest.raises(RecordingError, match="--columns time=#1"):
                read_recording(f"{path}@trial{n}", radius="flat")
        first, second = (
            read_recording(f"{path}@trial{n}", radius="flat", columns={"time": "#1"}) for n in (1, 2)
        )
        np.testing.assert_allclose(second.time, 2.0 * first.time, atol=1e-5)
        np.testing.assert_allclose(second.force, 2.0 * first.force, atol=0.011)  # six digits
        whole = read_recording(f"{path}@trial2", radius="flat", columns={"time": "#7"})
        np.testing.assert_array_equal(whole.time, second.time)

    def test_a_numbered_column_that_all_tests_share_stays(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        header = "clock,Stroke 1 [cm],Load 1 [N],Stroke 2 [cm],Load 2 [N]"
        path = write_rows(tmp_path / "a.csv", header, time, deflection, force, deflection, force / 2)
        columns, units = {"time": "#1"}, {"time": "s"}
        second = read_recording(f"{path}@trial2", radius="flat", columns=columns, units=units)
        np.testing.assert_allclose(second.time, time)

    def test_two_gauges_and_one_cell_are_no_trials(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(
            tmp_path / "a.csv", "Time [s],Weg [cm],Hub [cm],Kraft [N]", time, deflection, deflection, force
        )
        with pytest.raises(
            RecordingError, match=r"'Weg \[cm\]' \(#2\) and 'Hub \[cm\]' \(#3\) may each be the"
        ):
            read_recording(path, radius="flat")


class TestTestsOfUnknownNames:
    """Side by side stand tests whose columns have the same names, which are no words for a force or a deflection."""

    @pytest.fixture
    def unknown(self, side_by_side: Path) -> Path:
        text = side_by_side.read_text(encoding="utf-8")
        side_by_side.write_text(text.replace("Weg [mm]", "Capteur A").replace("Kraft [N]", "Capteur B"))
        return side_by_side

    def test_the_unknown_ones_are_asked_for_as_of_one_test(self, unknown: Path) -> None:
        with pytest.raises(RecordingError) as caught:
            read_recording(unknown, radius="flat")
        said = str(caught.value)
        assert (
            "no column for deflection, force; its columns are 'Zeit [s]', 'Capteur A', 'Capteur B'; " in said
        )
        assert "--columns deflection=#2,force=#3 and --units deflection=mm,force=N" in said

    @pytest.mark.parametrize(
        "columns",
        [
            {"deflection": "Capteur A", "force": "Capteur B"},
            {"deflection": "+#2", "force": "+#3"},
        ],
    )
    def test_they_are_named_as_in_one_test(self, unknown: Path, columns: dict[str, str]) -> None:
        units = {"deflection": "mm", "force": "N"}
        files, _ = recording_files([unknown], columns)
        assert [file.name for file in files] == ["both.csv@trial1", "both.csv@trial2"]
        first, second = (read_recording(f, radius="flat", columns=columns, units=units) for f in files)
        assert (len(first), len(second)) == (101, 67)
        np.testing.assert_allclose(second.force, first.force[:67] / 2, atol=2e-3)

    def test_numbers_may_count_the_columns_of_all_tests(self, unknown: Path) -> None:
        whole = {"time": "#4", "deflection": "#5", "force": "#6"}
        units = {"deflection": "mm", "force": "N"}
        without_name = read_recording(unknown, radius="flat", columns=whole, units=units)
        named = read_recording(f"{unknown}@trial2", radius="flat", columns=whole, units=units)
        np.testing.assert_array_equal(without_name.force, named.force)
