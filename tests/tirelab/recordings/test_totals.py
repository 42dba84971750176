"""Of several load cells and the column of all of them that one is the force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from house_form import loading, refusal, write_rows
from tirelab.recordings.recording import read_recording
from tirelab.recordings.totals import sum_among

TIME, DEFLECTION, FORCE = loading()
LEFT = 0.4 * FORCE + 3.0 * np.sin(5.0 * TIME)
RIGHT = FORCE - LEFT


@pytest.mark.parametrize(
    ("names", "values"),
    [
        ("F1 (N),F2 (N),F_total (N)", (LEFT, RIGHT, FORCE)),
        ("F1 (N),F2 (N),Fsum (N)", (LEFT, RIGHT, FORCE)),
        ("Kraft 1 (N),Kraft 2 (N),Gesamtkraft (N)", (LEFT, RIGHT, FORCE)),
        ("Total force (N),Force 1 (N),Force 2 (N)", (FORCE, LEFT, RIGHT)),
        ("Left cell (N),Right cell (N),Both (N)", (LEFT, RIGHT, FORCE)),
        ("Load Cell 1 (N),Load Cell 2 (N),Idle (N),Total Load (N)", (LEFT, RIGHT, 0.0 * FORCE, FORCE)),
        ("F1,F2,F_total", (LEFT, RIGHT, FORCE)),
    ],
)
def test_the_sum_of_the_others_is_the_force(
    tmp_path: Path, names: str, values: tuple[np.ndarray, ...]
) -> None:
    path = write_rows(tmp_path / "a.csv", f"Time (s),Stroke (cm),{names}", TIME, DEFLECTION, *values)
    found = read_recording(path, radius="flat", units={} if "(N)" in names else {"force": "N"})
    np.testing.assert_allclose(found.force, FORCE, rtol=1e-5, atol=1e-3)
    assert any("it is the sum of" in note for note in found.notes)
    assert not any("; not from" in note for note in found.notes)


@pytest.mark.parametrize("digits", [0, 1, 3])
def test_numbers_that_were_rounded_are_a_sum_within_that(digits: int) -> None:
    columns = dict(enumerate(np.round(10.0 * column, digits) for column in (FORCE, LEFT, RIGHT)))
    total = sum_among(columns)
    assert total is not None
    assert (total.column, set(total.addends)) == (0, {1, 2})


def test_what_is_no_sum_or_one_of_two_is_left_alone() -> None:
    assert sum_among({0: FORCE + 1e-3 * FORCE.max() * np.sin(TIME), 1: LEFT, 2: RIGHT}) is None
    assert sum_among({0: FORCE, 1: LEFT, 2: RIGHT, 3: FORCE + 1e-9}) is None
    assert sum_among({0: FORCE, 1: FORCE, 2: 0.0 * FORCE}) is None


def test_two_cells_alone_are_asked_about(tmp_path: Path) -> None:
    header = "Time (s),Stroke (cm),Force 1 (N),Force 2 (N)"
    path = write_rows(tmp_path / "a.csv", header, TIME, DEFLECTION, LEFT, RIGHT)
    assert "'Force 1 (N)' (#3) and 'Force 2 (N)' (#4) may each be the force" in refusal(path, radius="flat")


def test_a_force_that_is_a_part_of_a_sum_is_asked_about(tmp_path: Path) -> None:
    """What a cell read, and the same with the inertia of the plate: nobody knows which one is meant."""
    header = "Time (s),Stroke (cm),Force (N),Inertia (N),Force raw (N)"
    path = write_rows(tmp_path / "a.csv", header, TIME, DEFLECTION, LEFT, RIGHT, FORCE)
    told = (
        "'Force (N)' (#3) and 'Force raw (N)' (#5) may each be the force; say which with --columns force=#5"
    )
    assert told in refusal(path, radius="flat")
    assert read_recording(path, radius="flat", columns={"force": "#3"}).force.max() == pytest.approx(
        LEFT.max()
    )
