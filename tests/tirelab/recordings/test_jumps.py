"""Two runs in one table are doubted; what a drive does in one run is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from house_form import write_rows
from tirelab.recordings.choices import Choices
from tirelab.recordings.jumps import (
    false_force_doubt,
    false_readings,
    jump_doubt,
    lost_readings,
    mark_doubt,
    unevenly_read,
)
from tirelab.recordings.recording import understand

TIME = np.arange(0.0, 20.0, 0.01)
CYCLES = 5e-3 * np.sin(2.0 * np.pi * TIME)


def test_two_runs_in_one_table_are_doubted() -> None:
    runs = np.concatenate([CYCLES[:700], 4e-3 - CYCLES[:1300]])
    # The second run begins 4 mm from zero; the first one ends there, and no step of either is over 0.32 mm.
    ((at, said),) = jump_doubt(runs)
    assert at == 700
    assert "jumps by 4" in said
    assert "two runs in one table" in said


def test_the_doubt_names_the_row(tmp_path: Path) -> None:
    runs = 1e3 * np.concatenate([CYCLES[:700], 4e-3 - CYCLES[:1300]])
    path = write_rows(tmp_path / "a.csv", "time [s],deflection [mm],force [N]", TIME, runs, 100.0 * runs)
    doubts = understand(path, Choices(part=True)).recording.doubts
    (told,) = [doubt for doubt in doubts if "two runs" in doubt]
    assert "row 702" in told  # the header is row 1


@pytest.mark.parametrize(
    "deflection",
    [
        CYCLES,
        np.where(TIME < 10.0, 0.0, 5e-3),
        np.where(TIME < 10.0, 1e-5 * np.sin(TIME), 5e-3 + 1e-5 * np.sin(TIME)),
        np.round(CYCLES, 3),
        5e-3 * np.sign(np.sin(2.0 * np.pi * TIME)),
        CYCLES[:10],
        np.zeros(1000),
    ],
    ids=[
        "cycles",
        "a step",
        "a step between two trembling holds",
        "a coarse gauge",
        "many steps",
        "few",
        "rest",
    ],
)
def test_one_run_is_not_doubted(deflection: np.ndarray) -> None:
    assert jump_doubt(deflection) == ()


def lost_at(*samples: int, value: float = 0.0) -> np.ndarray:
    read = CYCLES.copy()
    read[list(samples)] = value
    return read


def test_readings_that_are_there_again_in_the_next_sample_were_lost() -> None:
    """Of a sine of 5 mm at 1 Hz, read at 100 Hz, no step is over 0.32 mm; two lost ones may enclose a good one."""
    force = 100.0 * CYCLES
    assert lost_readings(CYCLES, force).size == 0
    assert lost_readings(lost_at(222, 525, 527), force).tolist() == [222, 525, 527]
    assert lost_readings(lost_at(222, value=-0.02), force).tolist() == [222]


def test_a_camera_that_follows_something_else_for_a_few_samples_lost_its_reading() -> None:
    """Of a run of four, and of one that encloses a good reading, the good one stays."""
    force = 100.0 * CYCLES
    assert lost_readings(lost_at(222, 223, 224, 225, value=0.15), force).tolist() == [222, 223, 224, 225]
    run = [222, 223, 224, 226, 525]
    assert lost_readings(lost_at(*run, value=0.15), force).tolist() == run


@pytest.mark.parametrize("place", [0, 1, 2, -3, -2, -1])
def test_at_an_end_the_reading_is_lost_and_not_those_beside_it(place: int) -> None:
    at = place % CYCLES.size
    force = 100.0 * CYCLES
    assert lost_readings(lost_at(at, value=0.5), force).tolist() == [at]


@pytest.mark.parametrize(("begin", "missing"), [(295, 129), (1317, 149), (2263, 147), (651, 36), (1939, 119)])
def test_the_readings_before_a_pause_of_the_recording_were_not_lost(begin: int, missing: int) -> None:
    """Triangles of which some samples are missing: the motion goes on elsewhere, or where it was by chance."""
    triangles = 1.0 - np.abs(np.linspace(0.0, 9.0, 3000) % 2.0 - 1.0)
    kept = np.delete(triangles, np.arange(begin, begin + missing))
    assert lost_readings(kept, np.full(kept.size, 3.0)).size == 0


def test_what_the_force_follows_or_stays_or_is_frequent_was_not_lost() -> None:
    tapped = lost_at(222, 525)
    assert lost_readings(tapped, 100.0 * tapped).size == 0
    assert lost_readings(lost_at(*range(222, 227)), CYCLES).size == 0
    often = lost_at(*range(20, 1980, 12))
    assert lost_readings(often, CYCLES).size == 0
    stepped = np.where(TIME % 2.0 < 1.0, 0.0, 5e-3)
    assert lost_readings(stepped, CYCLES).size == 0


def test_a_row_whose_deflection_was_lost_is_skipped_and_named(tmp_path: Path) -> None:
    read = 1e3 * lost_at(222, 525)
    path = write_rows(tmp_path / "a.csv", "time [s],deflection [mm],force [N]", TIME, read, 1e5 * CYCLES)
    found = understand(path, Choices(part=True)).recording
    (said,) = [note for note in found.notes if "lost" in note]
    assert said.endswith(": row 224, row 527")  # the header is row 1
    assert len(found) == TIME.size - 2


STROKES = 20e-3 * np.abs(2.0 * ((TIME / 4.0) % 1.0) - 1.0)
"""Strokes of 20 mm at 10 mm/s, read at 100 Hz: as far from one reading to the next as a false one is off."""


def with_noise(seed: int, size: float = 15e-6) -> np.ndarray:
    return STROKES + size * np.random.default_rng(seed).normal(size=TIME.size)


def test_single_readings_off_the_motion_are_false() -> None:
    """Off by 13 to 30 times the noise of the gauge, in no two neighbouring windows."""
    rng = np.random.default_rng(3)
    at = np.arange(33, 1950, 61)
    read = with_noise(1)
    read[at] += rng.choice([-1.0, 1.0], at.size) * rng.uniform(0.2e-3, 0.45e-3, at.size)
    found = false_readings(read, 300.0 + 2e3 * STROKES)
    assert set(found) <= set(at)
    # One in a hundred neighbourhoods is noisier than it may be; those of corners are judged by one side.
    assert len(found) >= 0.85 * at.size


def test_noise_makes_hardly_any_reading_look_false() -> None:
    seen = sum(false_readings(with_noise(seed), STROKES).size > 0 for seed in range(100))
    # Once in a hundred by BY_CHANCE; of a noise that is known from the readings themselves a little more often.
    assert seen <= 5


def test_a_gauge_is_as_noisy_as_where_it_moves() -> None:
    """Two fifths of the time are held, and the reading repeats there, as that of a machine which counts its steps."""
    moves = np.arange(TIME.size) % 100 < 60
    way = np.cumsum(moves) * (TIME[1] - TIME[0])
    strokes = 20e-3 * np.abs(2.0 * ((way / 4.0) % 1.0) - 1.0)
    last = np.maximum.accumulate(np.where(moves, np.arange(TIME.size), 0))
    noise = [15e-6 * np.random.default_rng(seed).normal(size=TIME.size) for seed in range(100)]
    assert sum(false_readings((strokes + own)[last], strokes).size > 0 for own in noise) <= 5


def test_a_gauge_may_be_louder_in_a_part_of_the_recording() -> None:
    """The first quarter has three times the noise of the rest, in which a false reading is still seen."""
    seen = 0
    for seed in range(100):
        read = STROKES + (with_noise(seed) - STROKES) * np.where(TIME < 5.0, 3.0, 1.0)
        seen += false_readings(read, STROKES).size > 0
    assert seen <= 5
    read[[1333, 1777]] += 0.4e-3
    assert false_readings(read, STROKES).tolist() == [1333, 1777]


@pytest.mark.parametrize(
    "deflection",
    [
        STROKES,
        CYCLES,
        CYCLES[::12],
        np.round(STROKES / 50e-6) * 50e-6,
        np.round(with_noise(4) / 50e-6) * 50e-6,
        np.round(with_noise(4, 4e-6) / 30e-6) * 30e-6,
        np.round(CYCLES / 0.3e-3) * 0.3e-3,
        np.interp(TIME, [0.0, 5.0, 5.03, 12.0, 12.02, 20.0], [0.0, 0.0, 5e-3, 5e-3, 1e-3, 1e-3]),
        np.zeros(2000),
        STROKES[:15],
    ],
    ids=[
        "corners",
        "a sine",
        "a sine read eight times a cycle",
        "steps of a gauge",
        "steps and noise",
        "steps beside less noise",
        "a coarse gauge",
        "driven steps",
        "rest",
        "few",
    ],
)
def test_what_a_motion_or_the_steps_of_a_gauge_do_is_not_false(deflection: np.ndarray) -> None:
    assert false_readings(deflection, np.zeros(deflection.size)).size == 0


def test_what_the_force_follows_or_is_frequent_was_read_rightly() -> None:
    tapped = with_noise(1)
    tapped[[333, 777]] += 0.4e-3
    assert false_readings(tapped, 1e4 * STROKES).tolist() == [333, 777]
    assert false_readings(tapped, 1e4 * tapped).size == 0
    often = with_noise(1)
    often[20:1980:25] += 0.4e-3
    assert false_readings(often, 1e4 * STROKES).size == 0


def test_without_a_time_a_reading_between_its_neighbours_may_be_one_of_another_moment() -> None:
    """Rows are 20 micrometres apart; one is taken 8 of them later, another stands 0.4 mm beside the motion."""
    uneven = 20e-6 * np.arange(400.0) + 0.1e-6 * np.random.default_rng(3).standard_normal(400)
    later, beside = uneven.copy(), uneven.copy()
    later[200] += 8e-6
    beside[200] += 0.4e-3
    assert false_readings(later, np.zeros(400)).tolist() == [200]
    assert false_readings(later, np.zeros(400), uneven=np.ones(400, dtype=bool)).size == 0
    assert false_readings(beside, np.zeros(400), uneven=np.ones(400, dtype=bool)).tolist() == [200]


def test_around_an_uneven_step_of_the_clock_a_reading_between_its_neighbours_is_of_another_moment() -> None:
    """200 rows a second and one 4 ms later: read where the motion is by then, 0.8 of a step further."""
    time = 0.005 * np.arange(400.0)
    time[200] += 0.004
    motion = 4e-3 * time + 0.1e-6 * np.random.default_rng(3).standard_normal(400)
    uneven = unevenly_read(time)
    assert np.flatnonzero(uneven).tolist() == list(range(196, 205))
    assert false_readings(motion, np.zeros(400)).tolist() == [200]
    assert false_readings(motion, np.zeros(400), uneven).size == 0
    assert not unevenly_read(0.005 * np.arange(400.0)).any()


def test_rows_that_are_skipped_without_a_time_leave_no_gap_in_it(tmp_path: Path) -> None:
    deflection = with_noise(1)
    deflection[777] += 0.4e-3
    path = write_rows(tmp_path / "untimed.csv", "deflection [mm],force [N]", 1e3 * deflection, 1e4 * STROKES)
    notes = understand(path, Choices(part=True)).recording.notes
    assert any("false readings of the deflection" in note for note in notes)
    assert not any("gap" in note for note in notes)


def test_a_row_that_was_read_falsely_is_skipped_and_named(tmp_path: Path) -> None:
    read = with_noise(1)
    read[[333, 777]] += 0.4e-3
    header = "time [s],deflection [mm],force [N]"
    path = write_rows(tmp_path / "a.csv", header, TIME, 1e3 * read, 1e4 * STROKES)
    found = understand(path, Choices(part=True)).recording
    (said,) = [note for note in found.notes if "false readings" in note]
    assert said.endswith(": row 335, row 779")  # the header is row 1
    assert len(found) == TIME.size - 2


def marked(*samples: int, mark: float) -> np.ndarray:
    force = 100.0 * CYCLES
    force[list(samples)] = mark
    return force


@pytest.mark.parametrize("mark", [-999.0, 9999.9, 32767.0])
def test_a_mark_for_no_reading_in_the_force_is_doubted_at_its_first_row(mark: float) -> None:
    ((at, said),) = mark_doubt(CYCLES, marked(300, 711, 1200, mark=mark))
    assert at == 300
    assert f"{mark:.6g} N at 3 samples" in said


@pytest.mark.parametrize("mark", [-999.0, 32767.0])
def test_marks_at_more_samples_than_are_lost_readings_are_doubted_too(mark: float) -> None:
    often = range(25, CYCLES.size, 25)
    ((at, said),) = mark_doubt(CYCLES, marked(*often, mark=mark))
    assert at == 25
    assert f"{mark:.6g} N at {len(often)} samples" in said


@pytest.mark.parametrize(
    "force",
    [
        100.0 * CYCLES,
        marked(300, mark=-999.0),
        marked(300, 711, mark=0.5),
        marked(300, mark=-999.0) - np.where(np.arange(CYCLES.size) == 711, 998.0, 0.0),
        marked(*range(300, 420), mark=-999.0),
    ],
    ids=["none", "once", "within the others", "not one number", "it stays"],
)
def test_what_is_no_mark_is_not_doubted(force: np.ndarray) -> None:
    assert mark_doubt(CYCLES, force) == ()


def test_marks_that_the_deflection_has_too_are_a_motion() -> None:
    taps = CYCLES.copy()
    taps[[300, 711, 1200]] = 0.5
    assert mark_doubt(taps, marked(300, 711, 1200, mark=-999.0)) == ()


def spoiled(values: dict[int, float]) -> np.ndarray:
    force = 100.0 * CYCLES + 0.01 * np.sin(np.arange(CYCLES.size))
    force[list(values)] = list(values.values())
    return force


@pytest.mark.parametrize("value", [-9999.0, 32767.0, 6.0, 0.0])
def test_a_force_that_goes_far_and_comes_back_is_doubted_at_its_row(value: float) -> None:
    ((at, said),) = false_force_doubt(CYCLES, spoiled({CYCLES.size // 4: 300.0 + value}))
    assert at == CYCLES.size // 4
    assert f"the force is {300.0 + value:.6g} N and " in said
    assert "more" not in said


def test_several_of_them_are_counted() -> None:
    ((at, said),) = false_force_doubt(CYCLES, spoiled({300: 900.0, 711: -900.0, 1200: 1200.0}))
    assert at == 300
    assert "(and so at 2 more)" in said


def test_a_force_that_goes_with_the_deflection_is_none_that_was_read_falsely() -> None:
    assert false_force_doubt(CYCLES, spoiled({})) == ()
    tapped = CYCLES.copy()
    tapped[300] += 0.5
    assert false_force_doubt(tapped, spoiled({300: 900.0})) == ()
    assert false_force_doubt(tapped, spoiled({301: 900.0})) == ()  # it comes a sample after its tap


def test_the_force_of_a_damper_that_is_driven_in_steps_was_not_read_falsely() -> None:
    stairs = 1e-3 * (np.arange(2000) // 100 % 10)
    assert false_force_doubt(stairs, 100.0 * np.gradient(stairs) + 0.01 * np.sin(np.arange(2000.0))) == ()


def test_a_line_that_was_cut_within_its_force_is_doubted(tmp_path: Path) -> None:
    """ESP32 and Arduino loggers lose the end of a line at a reset: 6 for 614.35."""
    rows = [f"{0.1 * i:.1f},{0.1 * i:.3f},{4.0 * i:.2f}" for i in range(200)]
    rows[150] = rows[150][: rows[150].rindex(",") + 2]
    (tmp_path / "a.csv").write_text("\n".join(["time [s],deflection [mm],force [N]", *rows]) + "\n")
    found = understand(tmp_path / "a.csv", Choices(part=True)).recording
    (doubt,) = found.doubts
    assert doubt.startswith("row 152, column 'force [N]': the force is 6 N and ")
    assert len(found) == 200
