"""The places of the first screen in words, and the recording that is drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tirelab.report.header import header
from tirelab.report.loops import Case


def place(by: str, start: float, stop: float, share: float) -> dict[str, Any]:
    unit = {"deflection": "m", "rate": "m/s"}.get(by, "1")
    return {"by": by, "from": start, "to": stop, "unit": unit, "share": share, "mean_residual": 9.0}


def shown(made: Any, where: list[dict[str, Any]]) -> dict[str, Any]:
    beside = dict.fromkeys(("located", "delivered", "correction"))
    cases = [Case(r, b, a) for r, b, a in zip(made.recordings, made.before, made.after, strict=True)]
    return header({**beside, **made.diagnosis, "where": where}, cases, [])


LOW, MIDDLE, HIGH = (
    place("deflection", 0.002, 0.003, 0.3),
    place("deflection", 0.01, 0.011, 0.2),
    place("deflection", 0.02, 0.0205, 0.1),
)


@pytest.mark.parametrize(
    ("where", "told", "is_shaded"),
    [
        ([], "no place differs from noise", False),
        ([LOW], "deflection 2.00 to 3.00 mm (30 % of the error)", True),
        ([LOW, MIDDLE], "deflection 2.00 to 3.00 mm (30 % of the error) and 10.0 to 11.0 mm (20 %)", True),
        (
            [LOW, MIDDLE, HIGH],
            "deflection 2.00 to 3.00 mm (30 % of the error), 10.0 to 11.0 mm (20 %) and 1 more",
            True,
        ),
        # none of these is drawn: nothing is shaded, and the two are told with their coordinates
        (
            [place("acceleration", -1.0, 1.0, 0.5), place("deflection", -1.0, 1.0, 0.9)],
            "acceleration −1.00 to 1.00 (50 % of the error) and deflection −1000 to 1000 mm (90 %)",
            False,
        ),
    ],
)
def test_places_are_told_in_a_line(
    kinds: dict[str, Any], where: list[dict[str, Any]], told: str, is_shaded: bool
) -> None:
    top = shown(kinds["one"], where)
    assert top["where"] == told
    assert top["is_shaded"] is is_shaded


def test_the_recording_with_the_largest_error_is_drawn(kinds: dict[str, Any]) -> None:
    made = kinds["one"]
    worse = [made.before[0], made.recordings[1].force + 1e3]
    assert shown(replace(made, before=worse), [LOW])["recording"] == made.recordings[1].name
    alone = replace(made, recordings=made.recordings[:1], before=made.before[:1], after=made.after[:1])
    assert shown(alone, [LOW])["recording"] == ""


def test_places_are_looked_for_in_the_residual_that_they_lie_in(kinds: dict[str, Any]) -> None:
    made = kinds["one"]
    located = [np.full(len(made.recordings[0]), 900.0), np.zeros(len(made.recordings[1]))]
    told = replace(made, diagnosis={**made.diagnosis, "located": located})
    assert shown(told, [LOW])["recording"] == made.recordings[0].name
