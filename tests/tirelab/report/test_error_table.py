"""The rows of the table of errors and the scale of its bars."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.recordings.recording import Recording
from tirelab.report.error_table import errors
from tirelab.report.loops import Case

FIT = {"noise": 6.0, "before": 50.0, "after": 6.5, "held_out_before": None, "held_out_after": None}


def case(name: str, before: float, after: float) -> Case:
    """A recording whose residuals are those constants [N]."""
    force = np.full(10, 100.0)
    recording = Recording(name, np.arange(10.0), np.full(10, 0.01), np.full(10, np.inf), force)
    return Case(recording, force - before, force + after)


def test_several_recordings_have_a_row_each() -> None:
    table = errors(FIT, "", [case("a", 60.0, 5.0), case("b", 40.0, 8.0)], [case("c", 1.0, 1.0)])
    assert [row[:2] for row in table["rows"]] == [("Fitted", None), ("fitted", "a"), ("fitted", "b")]
    assert table["rows"][1][2:] == pytest.approx((60.0, 5.0))
    assert table["rows"][2][2:] == pytest.approx((40.0, 8.0))


def test_the_bars_hold_the_largest_error() -> None:
    held_out = {**FIT, "held_out_before": 90.0, "held_out_after": 7.0}
    table = errors(held_out, "time block 3-5 s", [case("a", 60.0, 5.0)], [])
    assert table["rows"][1] == ("Held-out (time block 3-5 s)", None, 90.0, 7.0)
    assert 90.0 < table["full"] < 100.0
    silent = {**FIT, "noise": 0.0, "before": 0.0, "after": 0.0}
    assert errors(silent, "", [case("a", 0.0, 0.0)], [])["full"] > 0.0
