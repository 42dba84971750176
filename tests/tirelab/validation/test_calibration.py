"""Brier skill and reliability of stated probabilities, on scores made by hand."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from tirelab.validation.calibration import (
    answers,
    confidence_pairs,
    effect_pairs,
    effect_reliability,
    reliability,
    skill,
    skills,
)
from tirelab.validation.metrics import Rate, brier
from tirelab.validation.page import Proof, numbers
from tirelab.validation.score import Score
from tirelab.validation.terminal import lines

Make = Callable[..., Score]


def test_who_knows_has_a_skill_of_one_and_who_says_the_rate_has_none() -> None:
    assert skill([[(1.0, True)], [(0.0, False)]] * 10).value == pytest.approx(1.0)
    assert skill([[(0.5, True)], [(0.5, False)]] * 10).value == pytest.approx(0.0)


def test_skill_of_two_groups_follows_from_their_rates() -> None:
    """Half of the trials come true in 0.9, half in 0.3: rate 0.6, skill 0.3^2 / (0.6 * 0.4) = 3/8 (Murphy 1973)."""
    sure = [[(0.9, i < 9)] for i in range(10)]
    unsure = [[(0.3, i < 3)] for i in range(10)]
    found = skill([*sure, *unsure] * 20)
    assert found.value == pytest.approx(0.375)
    assert found.interval[0] < 0.375 < found.interval[1]


def test_where_all_comes_true_skill_is_not_defined() -> None:
    assert math.isnan(skill([[(0.9, True)]] * 5).value)
    assert math.isnan(skill([]).value)


def test_an_effect_is_there_where_it_was_hidden_not_where_it_is_arguable(score: Make) -> None:
    stated = {"probabilities": {"friction": 0.6, "lag": 0.3}}
    arguable = score("pair", "friction", "friction lag", also_right=["lag"], **stated)
    assert effect_pairs([arguable]) == [[(0.6, True), (0.3, False)]]
    assert confidence_pairs([score("single", "friction", "lag", also_right=["lag"])]) == [[(0.9, True)]]


def test_where_several_sets_are_right_those_that_leave_the_same_belong_to_the_confidence(score: Make) -> None:
    """A lag and a damper beside a linear spring are one force: either is right, and 0.5 and 0.4 are stated."""
    stated = {"confidence": 0.5, "same": 0.4}
    either = score("single", "friction", "lag", also_right=["lag"], **stated)
    one = score("single", "friction", "friction", **stated)
    assert confidence_pairs([either, one]) == [[(0.9, True)], [(0.5, True)]]
    assert brier([either, one]).value == pytest.approx((0.1**2 + 0.5**2) / 2.0)


def test_reliability_has_every_verdict_in_one_class(score: Make) -> None:
    stated = (0.0, 0.5, 0.95, 1.0)
    points = reliability([score("single", "lag", "lag", confidence=c) for c in stated])
    assert [p.rate.trials for p in points] == [2, 1, 1]


def test_a_verdict_is_right_in_the_sense_of_its_kind(score: Make) -> None:
    """Outside the catalogue a verdict that names nothing is right, though not exact."""
    silent = score("outside", "unknown", "none", confidence=0.9)
    assert not silent.exact
    assert [(p.rate, p.at) for p in reliability([silent])] == [(Rate(1, 1), 0.9)]


def test_the_reliability_of_effects_counts_every_name_once(score: Make) -> None:
    found = effect_reliability(
        [
            score("loud", "lag", "lag gas unknown", probabilities={"lag": 0.96, "gas": 0.3}),
            score("single", "lag", "lag", probabilities={"lag": 0.97}),
        ]
    )
    assert [(p.rate, p.at) for p in found] == [(Rate(0, 1), 0.3), (Rate(2, 2), pytest.approx(0.965))]


def test_answers_are_counted_by_the_rule_and_by_the_rigs_own_fits(score: Make) -> None:
    scores = [
        score("single", "lag", "lag"),
        score("single", "lag", "gas", also_right=["gas"], derived=["lag"], alternatives=["lag", "damping"]),
        score("loud", "lag", "gas"),
    ]
    found = answers(scores)
    assert (found.several, found.exact_single) == (Rate(1, 3), Rate(1, 2))
    assert (found.several_as_derived, found.exact_as_derived) == (Rate(0, 2), Rate(1, 2))
    assert found.exact_single_as_derived == Rate(1, 2)
    assert found.alternatives.value == pytest.approx(2.0 / 3.0)


def test_the_proof_judges_wide_kinds_apart_and_all_kinds_by_their_skill(score: Make) -> None:
    """A wide kind enters none of the present figures."""
    own = [score("single", "lag", "lag", confidence=0.9)] * 3
    loud = [score("loud", "lag", name, confidence=0.9) for name in ("lag", "gas")] * 2
    alone, together = Proof(1, tuple(own)), Proof(1, (*own, *loud), "all")
    assert alone.own_criteria == together.own_criteria
    figures = [c.figure for c in together.criteria]
    assert len(figures) == len(alone.criteria) + 2
    assert figures[-1] == "Brier skill of the confidence over the constant rate"
    content = numbers(together)
    assert content["command"] == "tirelab prove --trials 7 --seed 1 --kind all --out DIR"
    assert content["criteria"][-2]["result"] == "too few trials"
    assert content["exact_by_kind"]["loud"]["hits"] == 2
    # 5 of 7 right at 0.9: squares 5 * 0.01 + 2 * 0.81 over 7 * 5/7 * 2/7
    expected = 1.0 - (5 * 0.01 + 2 * 0.81) / (7 * (5 / 7) * (2 / 7))
    assert content["brier_skill"]["confidence of the verdict"]["value"] == pytest.approx(expected)
    assert skills(alone.scores)["confidence of the verdict"].trials == 3


def test_the_terminal_says_when_trials_are_drawn_again(score: Make) -> None:
    text = "\n".join(lines(Proof(1, (score("loud", "lag", "lag"), score("foreign", "lag", "gas")), "all")))
    assert "drawn again unless every hidden effect matters" in text
    assert "More than one answer counts as right in 0.0 % (0 of 2)" in text
    assert "foreign: held-out misfit at most a quarter: 0.0 % (0 of 1)" in text
    assert "By the rig's own fits" not in text
