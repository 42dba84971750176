"""A clock that counts from a known day is counted from the first sample, and the day is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.epochs import began
from tirelab.recordings.recording import read_recording

DAY = 86_400.0


@pytest.mark.parametrize(
    ("first", "one", "said"),
    [
        # 2023-03-15 is the day 45000 of Excel, and 738960 of MATLAB (datenum(2023,3,15))
        (45_000.125 * DAY, DAY, "day 45000.125000 of a spreadsheet (2023-03-15 03:00:00)"),
        (738_960.5 * DAY, DAY, "day 738960.500000 of MATLAB (2023-03-15 12:00:00)"),
        (19_431.0 * DAY, DAY, "day 19431.000000 since 1970 (2023-03-15 00:00:00)"),
        (1_748_959_500.25, 1.0, "1748959500.250000 s since 1970"),
        (1_748_959_500.25, 1e-3, "1748959500.250000 s since 1970"),
        (3_832_000_000.0, 1.0, "3832000000.000000 s since 1904"),
        (0.0, 1.0, ""),
        (0.5 * DAY, DAY, ""),
        (1000.0 * DAY, DAY, ""),
        (5e9, 1.0, ""),
    ],
)
def test_when_a_clock_began(first: float, one: float, said: str) -> None:
    assert began(first, one) == said


def test_days_of_a_workbook_become_seconds_from_the_first(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    time = 0.1 * np.arange(60)
    book = openpyxl.Workbook()
    book.active.append(["Time [d]", "stroke [mm]", "load [N]"])
    for t in time.tolist():
        book.active.append([45_000.123 + t / DAY, 2.0 * t, 300.0 * t])
    book.save(tmp_path / "a.xlsx")
    found = read_recording(tmp_path / "a.xlsx", radius="flat")
    np.testing.assert_allclose(found.time, time, atol=2e-6)
    said = "time counted from the first sample, which is at day 45000.123000 of a spreadsheet (2023-03-15 02:57:07)"
    assert said in found.notes
    assert not found.doubts
