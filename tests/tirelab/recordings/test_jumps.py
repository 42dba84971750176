"""Two runs in one table are doubted; what a drive does in one run is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from house_form import write_rows
from tirelab.recordings.choices import Choices
from tirelab.recordings.jumps import jump_doubt
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
