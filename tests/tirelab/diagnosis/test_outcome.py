"""The content of diagnosis.json and of the page, from a verdict's parts made by hand."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from tirelab.diagnosis.alternatives import Alternative
from tirelab.diagnosis.discriminating_test import DiscriminatingTest, Test
from tirelab.diagnosis.outcome import (
    Replayed,
    alternative_detail,
    content_of,
    finite,
    page_content,
    split_reason,
)
from tirelab.diagnosis.residual_model import ResidualModel
from tirelab.estimation.findings import Evidence
from tirelab.recordings.recording import Recording

TIME = np.arange(4.0)
RECORDING = Recording("r", TIME, np.full(4, 0.01), np.full(4, np.inf), np.array([10.0, 20.0, 30.0, 40.0]))
NONE = Replayed((), (), ())


def replayed(before: float, after: float) -> Replayed:
    """A recording from which the forces differ by so much [N] everywhere."""
    return Replayed((RECORDING,), (RECORDING.force - before,), (RECORDING.force + after,))


def stated(test=None):
    fit = {"noise": 1.0, "before": 99.0, "after": 99.0, "held_out_before": 5.0, "held_out_after": None}
    return {
        "schema": 2,
        "verdict": {"effects": [], "separating_test": test},
        "fit": fit,
        "held_out_by": "time block 1-2 s",
        "tire": None,
    }


def test_the_errors_are_those_of_the_replayed_fmu():
    content = content_of(stated(), replayed(3.0, 2.0), replayed(7.0, 4.0))
    assert content["fit"] == {
        "noise": 1.0,
        "before": 3.0,
        "after": 2.0,
        "held_out_before": 7.0,
        "held_out_after": 4.0,
    }
    assert (content["tire"], content["corrected_fmu"], content["report"]) == (
        "tire.json",
        "BicycleTire.fmu",
        "report.html",
    )


def test_without_held_out_recordings_the_errors_of_the_held_out_part_stay():
    content = content_of(stated(), replayed(3.0, 2.0), NONE)
    assert content["fit"]["held_out_before"] == 5.0
    assert content["fit"]["held_out_after"] is None
    assert NONE.rmse(()) is None


def test_the_test_names_its_file_and_the_verdict_stays_as_it_was():
    given = stated({"waveform": "sweep"})
    content = content_of(given, replayed(3.0, 2.0), NONE)
    assert content["verdict"]["separating_test"] == {"waveform": "sweep", "file": "separating_test.csv"}
    assert given["verdict"]["separating_test"] == {"waveform": "sweep"}


def test_numbers_that_are_not_finite_become_null():
    values = {"a": math.nan, "b": [np.float64(1.5), -math.inf], 3: (np.int64(2), "x", True, None)}
    found = finite(values)
    assert found == {"a": None, "b": [1.5, None], "3": [2, "x", True, None]}
    assert json.loads(json.dumps(found, allow_nan=False)) == found


def test_the_page_shows_evidence_reasons_and_the_motion():
    motion = Test("sweep", TIME, TIME / 1e3, np.full(4, np.inf))
    test = DiscriminatingTest(motion, ((), ("inertia",)), gain=30.0, separation=10.0, typical=1.0, missed=0.0)
    rows = (
        Evidence(("inertia",), 0.0, 1.21, (), 0.95),
        Evidence((), -3.0, 4.0, (), 0.05),
    )
    page = page_content(rows, (Alternative((), 3.0, "one surface", 0.05),), (), test)
    assert [e["misfit"] for e in page["evidence"]] == pytest.approx([1.1, 2.0])
    assert [e["remark"] for e in page["evidence"]] == ["the verdict", ""]
    assert page["reasons"] == ["one surface"]
    assert page["waveform"] == {"time": TIME.tolist(), "deflection": (TIME / 1e3).tolist()}
    assert page_content((), (), (), None)["waveform"] is None


@pytest.mark.parametrize(
    ("r2", "after", "held_out", "said"),
    [
        (
            0.88,
            6.4,
            6.5,
            "explains 88 % of the remainder on held-out blocks of time. With it the RMS error is 6.40 N, and ",
        ),
        (0.88, 6.4, math.nan, "With it the RMS error is 6.40 N."),
        (math.nan, 6.4, math.nan, "whether it repeats is not known. With it the RMS error is 6.40 N."),
        (-0.1, math.nan, math.nan, "It does not repeat on held-out blocks of time: do not use it."),
    ],
)
def test_a_regression_says_whether_it_repeats(r2, after, held_out, said):
    model = ResidualModel("rate", "m/s", TIME, TIME, r2, after, held_out)
    (shown,) = page_content((), (), (model,), None)["correction"]
    assert said in shown["repeats"]
    assert (shown["by"], shown["unit"], shown["x"], shown["std"]) == ("rate", "m/s", TIME.tolist(), None)


@pytest.mark.parametrize(
    ("reason", "lacks", "action"),
    [
        ("no hold: hold 10 s at 15 mm", "no hold", "hold 10 s at 15 mm"),
        (
            "one speed only: repeat at 3 mm/s; no hold: hold",
            "one speed only; no hold",
            "repeat at 3 mm/s; hold",
        ),
        ("the recording has no time", "the recording has no time", ""),
    ],
)
def test_a_reason_is_what_lacks_and_what_to_do(reason, lacks, action):
    assert split_reason(reason) == (lacks, action)


def test_an_alternative_is_told_as_a_difference():
    told = alternative_detail(
        ["inertia"], Alternative(("force_lag", "inertia"), 3.0, "no hold: hold it", 0.05)
    )
    assert told == {
        "difference": "+ force lag",
        "probability": 0.05,
        "same": False,
        "reason": "no hold",
        "action": "hold it",
    }
