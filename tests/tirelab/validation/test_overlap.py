"""Overlap of stated and true regions, on spans whose Jaccard index is known by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tirelab.diagnosis.diagnosis_file import StatedPlace
from tirelab.recordings.recording import Recording
from tirelab.validation.overlap import region_scores


def recording(name: str = "train_0") -> Recording:
    """0 to 10 s, pressed evenly from 0 to 20 mm: as many samples in every span as it is wide."""
    time = np.linspace(0.0, 10.0, 10_001)
    return Recording(name, time, 2e-3 * time, np.full(10_001, math.inf), 100.0 * time)


def truth(
    by: str, begin: Any, end: Any, unit: str, effect: str = "bottoming", name: str = "train_0.csv"
) -> dict[str, Any]:
    return {
        "effect": effect,
        "recording": name,
        "by": by,
        "from": begin,
        "to": end,
        "unit": unit,
        "share": 0.1,
    }


def stated(
    by: str, begin: Any, end: Any, unit: str, share: float = 1.0, name: str | None = None
) -> StatedPlace:
    return StatedPlace(by, begin, end, unit, share, name)


def overlap(where: list[dict[str, Any]], spans: list[StatedPlace]) -> float:
    (found,) = region_scores(where, spans, [recording()])
    return found.overlap


def test_the_same_span_in_another_unit_overlaps_wholly() -> None:
    assert overlap(
        [truth("deflection", 0.01, 0.015, "m")], [stated("deflection", 10.0, 15.0, "mm")]
    ) == pytest.approx(1.0, abs=1e-3)


def test_an_open_end_reaches_as_far_as_the_recordings() -> None:
    # true 12 to 20 mm, stated 10 to 20 mm: 8 of 10
    assert overlap(
        [truth("deflection", 0.012, None, "m")], [stated("deflection", 0.010, None, "m")]
    ) == pytest.approx(0.8, abs=1e-3)


def test_disjoint_spans_do_not_overlap() -> None:
    assert overlap([truth("time", 1.0, 2.0, "s")], [stated("time", 3.0, 4.0, "s")]) == 0.0


def test_a_coordinate_that_is_not_stated_is_not_found() -> None:
    assert overlap([truth("time", 1.0, 2.0, "s")], [stated("deflection", 0.0, None, "m")]) == 0.0


def test_neighbouring_spans_with_most_of_the_error_make_one_region() -> None:
    tenths = [
        stated("deflection", 2e-3 * i, 2e-3 * (i + 1), "m", share)
        for i, share in enumerate([0.02] * 7 + [0.3] * 3)
    ]
    assert overlap([truth("deflection", 0.014, None, "m")], tenths) == pytest.approx(1.0, abs=1e-3)


def test_several_true_moments_are_one_region() -> None:
    moments = [truth("time", 1.0, 2.0, "s"), truth("time", 5.0, 6.0, "s")]
    assert overlap(moments, [stated("time", 1.0, 2.0, "s")]) == pytest.approx(0.5, abs=1e-3)


def test_a_span_in_another_recording_does_not_count() -> None:
    assert overlap([truth("time", 1.0, 2.0, "s")], [stated("time", 1.0, 2.0, "s", name="train_1.csv")]) == 0.0


@pytest.mark.parametrize(("begin", "end"), [("unloading", "unloading"), (-1.5, 0.0), (-1.0, -1.0)])
def test_a_direction_is_found_by_word_or_by_sign(begin: Any, end: Any) -> None:
    where = [truth("direction", "unloading", "unloading", "1")]
    assert overlap(where, [stated("direction", begin, end, "1")]) == 1.0


def test_the_direction_with_the_larger_share_counts() -> None:
    where = [truth("direction", "unloading", "unloading", "1")]
    spans = [stated("direction", -1.5, 0.0, "1", 0.2), stated("direction", 0.0, 1.5, "1", 0.8)]
    assert overlap(where, spans) == 0.0


def test_a_span_in_a_unit_of_another_quantity_does_not_count() -> None:
    assert overlap([truth("time", 1.0, 2.0, "s")], [stated("time", 1.0, 2.0, "mm")]) == 0.0


def test_samples_count_and_not_widths() -> None:
    # nine tenths of the time at the ceiling of 1 kN, which is a tenth of the range of force
    time = np.linspace(0.0, 10.0, 10_001)
    r = Recording("train_0", time, 2e-3 * time, np.full(10_001, math.inf), np.minimum(1000.0 * time, 1000.0))
    (found,) = region_scores([truth("force", 995.0, None, "N")], [stated("force", 0.9, 1.0, "kN")], [r])
    assert found.overlap == pytest.approx(9.005 / 9.1, abs=1e-3)


def test_the_rate_of_a_ramp_is_found() -> None:
    assert overlap([truth("rate", 0.001, None, "m/s")], [stated("rate", 1.5, 3.0, "mm/s")]) == 1.0
    assert overlap([truth("rate", 0.001, None, "m/s")], [stated("rate", -3.0, -1.5, "mm/s")]) == 0.0


def test_a_recording_without_samples_in_the_region_does_not_count() -> None:
    where = [truth("force", 900.0, None, "N"), truth("force", 900.0, None, "N", name="train_1.csv")]
    weak = Recording(
        "train_1",
        *(getattr(recording(), n) for n in ("time", "deflection", "surface_radius")),
        np.ones(10_001),
    )
    (found,) = region_scores(where, [stated("force", 900.0, None, "N")], [recording(), weak])
    assert found.overlap == 1.0


def test_a_direction_that_is_not_stated_is_not_found() -> None:
    assert overlap([truth("direction", "unloading", "unloading", "1")], []) == 0.0


def test_a_region_without_samples_in_any_recording_has_no_score() -> None:
    assert region_scores([truth("force", 5000.0, None, "N")], [], [recording()]) == ()
