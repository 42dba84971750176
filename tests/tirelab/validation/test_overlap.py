"""Overlap of stated and true places, on spans whose Jaccard index is known by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tirelab.diagnosis.diagnosis_file import StatedPlace
from tirelab.recordings.recording import Recording
from tirelab.validation.overlap import place_scores


def recording(name: str = "train_0") -> Recording:
    """0 to 10 s, pressed evenly from 0 to 20 mm: as many samples in every span as it is wide."""
    time = np.linspace(0.0, 10.0, 10_001)
    return Recording(name, time, 2e-3 * time, np.full(10_001, math.inf), 100.0 * time)


def true(
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


def said(
    by: str, begin: Any, end: Any, unit: str, share: float = 1.0, name: str | None = None
) -> StatedPlace:
    return StatedPlace(by, begin, end, unit, share, name)


def overlap(where: list[dict[str, Any]], stated: list[StatedPlace]) -> float:
    (found,) = place_scores(where, stated, [recording()])
    return found.overlap


def test_the_same_span_in_another_unit_overlaps_wholly() -> None:
    assert overlap(
        [true("deflection", 0.01, 0.015, "m")], [said("deflection", 10.0, 15.0, "mm")]
    ) == pytest.approx(1.0, abs=1e-3)


def test_an_open_end_reaches_as_far_as_the_recordings() -> None:
    # true 12 to 20 mm, stated 10 to 20 mm: 8 of 10
    assert overlap(
        [true("deflection", 0.012, None, "m")], [said("deflection", 0.010, None, "m")]
    ) == pytest.approx(0.8, abs=1e-3)


def test_spans_apart_do_not_overlap() -> None:
    assert overlap([true("time", 1.0, 2.0, "s")], [said("time", 3.0, 4.0, "s")]) == 0.0


def test_a_coordinate_that_is_not_stated_is_not_found() -> None:
    assert overlap([true("time", 1.0, 2.0, "s")], [said("deflection", 0.0, None, "m")]) == 0.0


def test_neighbouring_spans_with_most_of_the_error_make_one_region() -> None:
    tenths = [
        said("deflection", 2e-3 * i, 2e-3 * (i + 1), "m", share)
        for i, share in enumerate([0.02] * 7 + [0.3] * 3)
    ]
    assert overlap([true("deflection", 0.014, None, "m")], tenths) == pytest.approx(1.0, abs=1e-3)


def test_several_true_moments_are_one_region() -> None:
    moments = [true("time", 1.0, 2.0, "s"), true("time", 5.0, 6.0, "s")]
    assert overlap(moments, [said("time", 1.0, 2.0, "s")]) == pytest.approx(0.5, abs=1e-3)


def test_a_place_in_another_recording_does_not_count() -> None:
    assert overlap([true("time", 1.0, 2.0, "s")], [said("time", 1.0, 2.0, "s", name="train_1.csv")]) == 0.0


@pytest.mark.parametrize(("begin", "end"), [("unloading", "unloading"), (-1.5, 0.0), (-1.0, -1.0)])
def test_a_direction_is_found_by_word_or_by_sign(begin: Any, end: Any) -> None:
    where = [true("direction", "unloading", "unloading", "1")]
    assert overlap(where, [said("direction", begin, end, "1")]) == 1.0


def test_the_direction_with_the_larger_share_counts() -> None:
    where = [true("direction", "unloading", "unloading", "1")]
    stated = [said("direction", -1.5, 0.0, "1", 0.2), said("direction", 0.0, 1.5, "1", 0.8)]
    assert overlap(where, stated) == 0.0


def test_a_unit_that_measures_something_else_is_no_place() -> None:
    assert overlap([true("time", 1.0, 2.0, "s")], [said("time", 1.0, 2.0, "mm")]) == 0.0


def test_samples_count_and_not_widths() -> None:
    # nine tenths of the time at the ceiling of 1 kN, which is a tenth of the range of force
    time = np.linspace(0.0, 10.0, 10_001)
    r = Recording("train_0", time, 2e-3 * time, np.full(10_001, math.inf), np.minimum(1000.0 * time, 1000.0))
    (found,) = place_scores([true("force", 995.0, None, "N")], [said("force", 0.9, 1.0, "kN")], [r])
    assert found.overlap == pytest.approx(9.005 / 9.1, abs=1e-3)


def test_the_rate_of_a_ramp_is_found() -> None:
    assert overlap([true("rate", 0.001, None, "m/s")], [said("rate", 1.5, 3.0, "mm/s")]) == 1.0
    assert overlap([true("rate", 0.001, None, "m/s")], [said("rate", -3.0, -1.5, "mm/s")]) == 0.0


def test_a_recording_that_never_reaches_the_place_does_not_count() -> None:
    where = [true("force", 900.0, None, "N"), true("force", 900.0, None, "N", name="train_1.csv")]
    weak = Recording(
        "train_1",
        *(getattr(recording(), n) for n in ("time", "deflection", "surface_radius")),
        np.ones(10_001),
    )
    (found,) = place_scores(where, [said("force", 900.0, None, "N")], [recording(), weak])
    assert found.overlap == 1.0
