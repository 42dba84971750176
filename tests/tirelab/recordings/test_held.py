"""Readings that a logger holds over several rows are told from coarse gauges, rests and steps of a drive."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tirelab.recordings.held import held_readings
from tirelab.recordings.recording import Recording

FloatArray = NDArray[np.float64]

TIME = np.arange(0.0, 60.0, 0.02)
STROKE = 0.5 * (1.0 - np.cos(2.0 * np.pi * TIME / 11.0))


def held(values: FloatArray, rows: float) -> FloatArray:
    """Return what a logger writes that gets a new reading every so many rows, a whole number or not."""
    at = np.floor(np.floor(np.arange(values.size) / rows) * rows + 0.999).astype(int)
    return values[np.minimum(at, values.size - 1)]


def noise(seed: int, size: float) -> FloatArray:
    return np.random.default_rng(seed).normal(0.0, size, TIME.size)


@pytest.mark.parametrize("rows", [2, 3, 8, 3.4])
@pytest.mark.parametrize("name", ["deflection", "force"])
def test_a_held_channel_is_found(name: str, rows: float) -> None:
    x, f = STROKE + noise(1, 1e-4), 200.0 * STROKE + noise(2, 1.0)
    x, f = (held(x, rows), f) if name == "deflection" else (x, held(f, rows))
    found, usual, repeats = held_readings(x, f)
    assert found == name
    assert usual == int(rows)
    kept = np.delete(x if name == "deflection" else f, repeats)
    assert np.all(np.diff(kept) != 0.0)
    assert kept.size == pytest.approx(TIME.size / rows, abs=1.0)


def test_of_two_held_channels_the_slower_is_thinned() -> None:
    x, f = held(STROKE + noise(1, 1e-4), 2), held(200.0 * STROKE + noise(2, 1.0), 9)
    assert held_readings(x, f)[:2] == ("force", 9)


def test_a_rest_that_repeats_a_reading_was_read_as_often() -> None:
    x = np.minimum(STROKE, 0.8)
    f = held(np.round(200.0 * x, 2), 5)
    _, _, repeats = held_readings(x, f)
    kept = np.setdiff1d(np.arange(TIME.size), repeats)
    assert np.max(np.diff(kept)) <= 6  # no gap where the force rests at the top
    assert kept.size == pytest.approx(TIME.size / 5, rel=0.02)


@pytest.mark.parametrize(
    ("deflection", "force"),
    [
        (STROKE + noise(1, 1e-4), 200.0 * STROKE + noise(2, 1.0)),
        (np.round(STROKE / 0.02) * 0.02, 200.0 * STROKE + noise(2, 1.0)),  # a coarse gauge
        (
            np.append(1e-4, np.round(STROKE / 0.02) * 0.02)[:-1],
            200.0 * STROKE + noise(2, 1.0),
        ),  # begun off its steps
        (STROKE, np.round(20.0 * STROKE + noise(2, 0.3))),  # a coarse load cell that trembles
        (
            np.round(STROKE / 0.04) * 0.04,
            100.0 * np.round(STROKE / 0.04) * 0.04,
        ),  # a drive in steps, without noise
        (held(STROKE, 25), 200.0 * held(STROKE, 25) + noise(2, 0.1)),  # and with it, of unequal steps
        (STROKE, 200.0 * np.maximum(STROKE - 0.9, 0.0)),  # nothing touches most of the time
        (STROKE[:30], held(STROKE, 2)[:30]),  # too few to tell
    ],
)
def test_what_else_repeats_is_not_held(deflection: FloatArray, force: FloatArray) -> None:
    assert held_readings(deflection, force)[:2] == ("", 1)


def test_a_recording_has_one_row_of_each_reading_and_says_so() -> None:
    read = held(200.0 * STROKE + noise(2, 1.0), 8)
    recording = Recording.from_arrays(TIME, 1e-3 * STROKE, read, "flat")
    assert len(recording) == TIME.size // 8
    assert recording.time[1] == pytest.approx(8 * 0.02)
    (said,) = [note for note in recording.notes if "repeats" in note]
    assert "force, which is new in one of 8 rows only" in said
