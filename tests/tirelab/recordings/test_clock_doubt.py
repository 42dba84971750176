"""A clock that counts days or milliseconds under another unit is doubted; one of a test is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.clock_doubt import clock_doubt, likely_clock, packed_clock
from tirelab.recordings.origin import Origin
from tirelab.recordings.recording import read_recording

SAMPLES = np.arange(400.0)


@pytest.mark.parametrize(
    ("step", "unit", "size", "said"),
    [
        (1e6, "Ms", 1e6, "lasts 12.6 years; in ms they would be 0.001 s apart over 0.399 s: --units time=ms"),
        (
            0.1 / 86400.0,
            "s",
            1.0,
            "1.16e-06 s apart; in d they would be 0.1 s apart over 39.9 s: --units time=d",
        ),
        (86400.0, "d", 86400.0, "the recording lasts 1.09 years; in s they would be 1 s apart over 399 s"),
        (1e5, "s", 1.0, "lasts 1.26 years; in us they would be 0.1 s apart over 39.9 s: --units time=us"),
    ],
)
def test_what_lasts_for_years_or_is_sampled_too_often(step: float, unit: str, size: float, said: str) -> None:
    assert said in clock_doubt(Origin("a.csv"), step * SAMPLES, unit, size)


@pytest.mark.parametrize("step", [1e-5, 1e-3, 1.0, 3600.0])
def test_the_clock_of_a_test_is_not_doubted(step: float) -> None:
    assert clock_doubt(Origin("a.csv"), step * SAMPLES, "s", 1.0) == ""


def test_of_a_clock_that_moves_a_little_days_are_likely() -> None:
    assert likely_clock(45_000.0 + 0.1 / 86400.0 * SAMPLES) == "d"
    assert likely_clock(0.1 * SAMPLES) == "s"


def test_the_column_of_a_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = [
        f"{i},{5.0 - 5.0 * np.cos(0.05 * i):.4f},{30.0 - 30.0 * np.cos(0.05 * i):.3f}" for i in range(400)
    ]
    path.write_text("time [Ms],stroke [mm],load [N]\n" + "\n".join(rows) + "\n")
    found = read_recording(path, radius="flat").doubts
    assert found[0].startswith("column 'time [Ms]': the recording lasts 12.6 years; in ms they would be")


def test_hours_minutes_and_seconds_in_one_number_are_doubted() -> None:
    seconds = 14 * 3600 + 5 * 60 + 40 + 0.1 * SAMPLES
    packed = seconds // 3600 * 10_000 + seconds % 3600 // 60 * 100 + seconds % 60
    said = packed_clock(np.round(packed, 3))
    assert said.startswith("the time goes from 140559.9 to 140600, and to no seconds from 60 on")
    assert said in clock_doubt(Origin("a.csv"), np.round(packed, 3), "s", 1.0)


@pytest.mark.parametrize(
    "time",
    [
        140_540.0 + 0.1 * SAMPLES,
        np.concatenate([59.0 + 0.1 * np.arange(10.0), 100.0 + 0.1 * np.arange(700.0)]),
        np.concatenate([0.1 * np.arange(300.0), 100.0 + 0.1 * np.arange(300.0)]),
    ],
    ids=["goes on", "seconds from 60 on", "a pause"],
)
def test_seconds_are_no_packed_clock(time: np.ndarray) -> None:
    assert packed_clock(time) == ""
