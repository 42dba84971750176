"""Two runs in one table are doubted; what a drive does in one run is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from house_form import write_rows
from tirelab.recordings.choices import Choices
from tirelab.recordings.jumps import jump_doubt, lost_readings
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


def test_what_the_force_follows_or_stays_or_is_frequent_was_not_lost() -> None:
    tapped = lost_at(222, 525)
    assert lost_readings(tapped, 100.0 * tapped).size == 0
    assert lost_readings(lost_at(222, 223, 224), CYCLES).size == 0
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
