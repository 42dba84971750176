"""Statistics of scores made by hand; intervals from a published table."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from tirelab.validation import metrics as summary
from tirelab.validation.acceptance_criteria import criteria
from tirelab.validation.held_out import Errors, HeldOut
from tirelab.validation.metrics import NO_NAME, Mean, Rate
from tirelab.validation.overlap import RegionScore
from tirelab.validation.score import Discrimination, Score

Make = Callable[..., Score]


@pytest.mark.parametrize(
    ("hits", "trials", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_the_interval_of_a_rate_is_wilsons(hits: int, trials: int, low: float, high: float) -> None:
    # Newcombe, Statistics in Medicine 17, 857 (1998), table I, method 3; printed to four digits
    assert Rate(hits, trials).interval == pytest.approx((low, high), abs=5e-5)


def test_without_trials_a_rate_says_nothing() -> None:
    assert Rate(0, 0).interval == (0.0, 1.0)
    assert math.isnan(Rate(0, 0).value)


def test_brier_score_of_a_coin_that_says_half_is_a_quarter(score: Make) -> None:
    scores = [score("single", "lag", named, confidence=0.5) for named in ("lag", "inertia", None)]
    found = summary.brier(scores)
    assert found.value == pytest.approx(0.25)
    assert found.trials == 2


def test_brier_score_of_calibrated_confidence_is_its_variance(score: Make) -> None:
    # right in eight of ten and says so: p (1 - p)
    scores = [score("single", "lag", "lag" if i < 8 else "inertia", confidence=0.8) for i in range(10)]
    assert summary.brier(scores).value == pytest.approx(0.16)


def test_the_interval_of_a_mean_holds_it_and_is_the_same_again() -> None:
    found = Mean.of([0.0, 0.1, 0.4, 0.2, 0.3])
    assert found.interval[0] < found.value < found.interval[1]
    assert found == Mean.of([0.0, 0.1, 0.4, 0.2, 0.3])


def test_rates_take_the_trials_they_are_about(score: Make) -> None:
    scores = [
        score("none", "none", "none"),
        score("none", "none", "lag"),
        score("open", "unknown", "unknown lag"),
        score("open", "unknown", "lag"),
        score("single", "lag", "unknown"),
        score("beside", "lag unknown", "lag unknown"),
    ]
    assert summary.false_alarms(scores) == Rate(1, 2)
    assert summary.recognised(scores) == Rate(1, 2)
    assert summary.wrongly_unknown(scores) == Rate(1, 3)
    assert summary.exact(scores) == Rate(2, 6)


FAR = Errors(before=9.0, after=9.0, noise_free=9.0, noise_floor=1.0, reading_noise_floor=1.0)
"""A correction that does nothing."""


def test_near_the_floor_is_ten_percent_inside_the_catalogue(score: Make) -> None:
    def with_rmse(kind: str, after: float, hidden: str = "lag") -> Score:
        return score(kind, hidden, "lag", held_out=HeldOut(Errors(9.0, after, 1.0, 1.0, 1.0), FAR, None))

    scores = [
        with_rmse("single", 1.09),
        with_rmse("single", 1.11),
        with_rmse("open", 1.0, "unknown"),
        with_rmse("beside", 1.0, "lag unknown"),
        score("pair", "lag", None),
    ]
    assert summary.near_floor(scores, 0.10, alike=True) == Rate(1, 3)
    assert summary.near_floor(scores, 0.10, alike=False) == Rate(0, 3)


def test_confusion_shares_a_missed_effect_among_the_wrong_names(score: Make) -> None:
    scores = [
        score("single", "lag", "lag"),
        score("single", "lag", "inertia friction"),
        score("single", "lag", "none"),
        score("single", "lag", "lag gas"),
        score("none", "none", "gas"),
        score("single", "lag", "friction", also_right=["friction"]),
    ]
    found = summary.confusion(scores)
    assert [*found, *found["lag"]] == [
        NO_NAME,
        "friction",
        "lag",
        "none",
        NO_NAME,
        "friction",
        "inertia",
        "lag",
    ]
    assert found == {
        "lag": {"lag": 2.0, "inertia": 0.5, "friction": 0.5, NO_NAME: 1.0},
        NO_NAME: {"gas": 1.0},
        "none": {"gas": 1.0},
        "friction": {"friction": 1.0},
    }


def test_naming_counts_by_size_and_leaves_out_what_cannot_be_seen(score: Make) -> None:
    scores = [
        score("single", "lag", "none", sizes={"lag": 1.5}),
        score("single", "lag", "lag", sizes={"lag": 1.8}),
        score("single", "lag", "lag", sizes={"lag": 20.0}),
        score("single", "lag", "none", sizes={"lag": 1.2}, also_right=["none"]),
    ]
    first, last = summary.naming(scores)["lag"]
    assert summary.naming(scores)["any effect"] == [first, last]
    assert (first.rate, last.rate) == (Rate(1, 2), Rate(1, 1))
    assert first.at == pytest.approx(1.65)


def test_regions_and_recommended_tests_are_counted(score: Make) -> None:
    scores = [
        score(
            "single",
            "lag",
            "lag",
            regions=(RegionScore("lag", "time", overlap),),
            discrimination=Discrimination(2, overlap > 0.5, "decided rightly", overlap > 0.7),
        )
        for overlap in (0.2, 0.6, 1.0)
    ]
    (region,) = summary.regions(scores)
    assert (region.median, region.half) == (0.6, Rate(2, 3))
    assert summary.discriminations(scores)["truth among the alternatives"] == Rate(2, 3)
    assert summary.discriminations(scores)["of these: decided rightly"] == Rate(2, 2)
    repeated = "verdicts repeated with the recommended recording: right before"
    assert summary.discriminations(scores)[repeated] == Rate(3, 3)
    assert summary.discriminations(scores)["right with it"] == Rate(1, 3)


def test_the_noise_of_the_reading_is_separated_from_the_error_of_the_model(score: Make) -> None:
    noisy = Errors(before=9.0, after=2.5, noise_free=1.05, noise_floor=1.0, reading_noise_floor=2.0)
    found = [score("single", "lag", "lag", held_out=HeldOut(noisy, FAR, None))]
    assert summary.near_floor(found, 0.1, alike=True).hits == 0
    assert summary.near_floor(found, 0.1, alike=True, noise_free=True).hits == 1
    as_good_as_the_truth = replace(noisy, reading_noise_floor=2.3)
    found = [score("single", "lag", "lag", held_out=HeldOut(as_good_as_the_truth, FAR, None))]
    assert summary.near_floor(found, 0.1, alike=True).hits == 1


def test_a_criterion_passes_or_fails_or_is_not_measured(score: Make) -> None:
    at_floor = Errors(before=2.0, after=1.0, noise_free=1.0, noise_floor=1.0, reading_noise_floor=1.0)
    at_both = HeldOut(at_floor, at_floor, None)
    found = criteria([score("single", "lag", "lag", confidence=1.0, held_out=at_both)] * 9)
    assert [c.passes for c in found] == [True, True, None, None, True, True, True, True, True]
    found = criteria([score("single", "lag", "gas", confidence=1.0)] * 9)
    assert [c.passes for c in found] == [False, False, None, None, False, False, False, False, False]
