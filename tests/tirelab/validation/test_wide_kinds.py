"""What a verdict has to be in each wide kind, judged on scores made by hand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from tirelab.diagnosis.diagnosis_file import DiagnosisFileError, read_stated
from tirelab.validation.held_out import Errors, HeldOut
from tirelab.validation.metrics import Rate
from tirelab.validation.score import Score
from tirelab.validation.wide_kinds import (
    at_floor,
    corrected,
    holds,
    kind_criteria,
    several_answers,
    sound,
    sound_alternative,
    wrong_names_unlikely,
)

Make = Callable[..., Score]


def errors(before: float, after: float, floor: float = 1.0) -> Errors:
    return Errors(before, after, after, floor, floor)


def test_a_loud_verdict_names_all_and_nothing_else_but_a_remainder(score: Make) -> None:
    assert sound(score("loud", "friction lag", "friction lag"))
    assert sound(score("loud", "friction lag", "friction lag unknown"))
    assert sound(score("loud", "friction lag", "friction gas", also_right=["friction gas"]))
    assert not sound(score("loud", "friction lag", "friction unknown"))
    assert not sound(score("loud", "friction lag", "friction lag gas"))
    assert not sound(score("loud", "friction lag", None))


def test_in_a_kind_that_is_drawn_a_remainder_is_no_right_name(score: Make) -> None:
    assert not sound(score("single", "friction", "friction unknown"))
    assert sound(score("open", "unknown", "unknown"))


def test_what_a_verdict_names_has_to_be_there_for_it_to_hold_however_unlikely_it_is_called(
    score: Make,
) -> None:
    unlikely = score("foreign", "damping", "damping lag", probabilities={"damping": 0.9, "lag": 0.3})
    assert sound(unlikely)
    assert not holds(unlikely)
    assert holds(score("foreign", "damping", "damping unknown", probabilities={"damping": 0.9}))
    assert not holds(score("loud", "friction", None))


def test_the_truth_of_a_first_file_may_be_an_alternative(score: Make) -> None:
    missed = score(
        "press", "friction recalibration", "lag", also_right=["friction"], alternatives=["friction"]
    )
    assert not sound(missed)
    assert sound_alternative(missed)
    assert not sound_alternative(score("press", "friction", "lag", alternatives=["gas"]))


def test_a_refitted_law_makes_no_second_answer_of_a_first_file(score: Make) -> None:
    assert not several_answers(score("press", "friction recalibration", "friction", also_right=["friction"]))
    assert several_answers(score("press", "friction recalibration", "friction", also_right=["lag"]))
    assert several_answers(score("single", "friction", "friction", also_right=["lag"]))


def test_a_wrong_name_of_a_first_file_has_less_than_a_half(score: Make) -> None:
    def found(probability: float) -> bool:
        stated = {"friction": 0.9, "lag": probability}
        return wrong_names_unlikely(score("press", "friction", "friction lag", probabilities=stated))

    assert found(0.49)
    assert not found(0.5)
    assert not wrong_names_unlikely(score("press", "friction", None))


@pytest.mark.parametrize(("after", "good"), [(1.14, True), (1.16, False)])
def test_the_written_tire_of_a_first_file_is_near_the_floor(score: Make, after: float, good: bool) -> None:
    assert at_floor(score("press", "lag", "lag", fitted=errors(9.0, after))) is good


def test_a_foreign_form_is_named_and_nothing_else_above_a_half(score: Make) -> None:
    def found(named: str, **stated: float) -> bool:
        return sound(score("foreign", "damping", named, probabilities=stated))

    assert found("damping", damping=0.4)
    assert found("damping gas unknown", damping=0.9, gas=0.5)
    assert not found("damping gas", damping=0.9, gas=0.51)
    assert not found("unknown")


@pytest.mark.parametrize(
    ("before", "after", "good"),
    # misfits are (e^2 - 1)^(1/2): before 10 and 8.06; a quarter of 10 is 2.5, so after is at most 7.25^(1/2) = 2.693
    [(101.0**0.5, 2.68, True), (101.0**0.5, 2.71, False), (1.2, 1.09, True), (1.2, 1.19, False)],
)
def test_a_correction_leaves_a_quarter_of_the_misfit(
    score: Make, before: float, after: float, good: bool
) -> None:
    tried, perfect = errors(before, after), errors(9.0, 1.0)
    assert corrected(score("foreign", "lag", "lag", held_out=HeldOut(tried, perfect, None))) is good
    assert corrected(score("foreign", "lag", "lag", held_out=HeldOut(perfect, tried, None))) is good


def test_outside_the_catalogue_nothing_that_is_not_there_is_above_a_half(score: Make) -> None:
    def found(named: str, **stated: float) -> bool:
        right = {"also_right": ["unknown"], "probabilities": stated}
        return sound(score("outside", "recalibration unknown", named, **right))

    assert found("unknown")
    assert found("none")
    assert found("recalibration unknown", recalibration=0.9)
    assert found("lag unknown", lag=0.5)
    assert not found("lag unknown", lag=0.6)


def test_beside_other_physics_the_known_effect_is_named_and_no_other_above_a_half(score: Make) -> None:
    def found(named: str, **stated: float) -> bool:
        right = {"also_right": ["gas unknown"], "probabilities": stated}
        return sound(score("beside", "gas recalibration unknown", named, **right))

    assert found("gas unknown", gas=0.4)
    assert found("gas", gas=0.9)
    assert found("gas recalibration", gas=0.9, recalibration=0.8)
    assert found("gas lag unknown", gas=0.9, lag=0.5)
    assert not found("gas lag unknown", gas=0.9, lag=0.6)
    assert not found("recalibration unknown", recalibration=0.9)
    assert not found("unknown")


def test_each_kind_is_judged_apart_and_few_trials_are_not_judged(score: Make) -> None:
    few = kind_criteria([score("loud", "lag", "lag")] * 10)
    (loud,) = few
    # Wilson's interval of 10 of 10 is 72 to 100 %
    assert (loud.result, loud.passes) == ("too few trials", None)
    (loud,) = kind_criteria([score("loud", "lag", "lag")] * 60 + [score("single", "lag", "gas")] * 9)
    assert (loud.measured, loud.result) == (Rate(60, 60), "pass")
    half = [score("outside", "unknown", name, probabilities={"lag": 0.9}) for name in ("lag", "unknown")]
    (outside,) = kind_criteria(half * 60)
    assert (outside.measured, outside.result) == (Rate(60, 120), "fail")
    assert len(kind_criteria([score("press", "lag", "lag")])) == 3


def test_probabilities_of_both_schemas_are_read(tmp_path: Path, diagnosis: Callable[..., None]) -> None:
    diagnosis(tmp_path / "1", ["lag", "gas"], confidence=0.7)
    first = read_stated(tmp_path / "1")
    assert (first.probabilities, first.remainder) == ({"lag": 0.7, "gas": 0.7}, None)
    diagnosis(tmp_path / "2", ["lag", "gas"], probabilities={"lag": 0.9, "gas": 0.2}, remainder=6.5)
    second = read_stated(tmp_path / "2")
    assert (second.probabilities, second.remainder) == ({"lag": 0.9, "gas": 0.2}, 6.5)


def test_a_probability_above_one_is_no_diagnosis(tmp_path: Path, diagnosis: Callable[..., None]) -> None:
    diagnosis(tmp_path, ["lag"], probabilities={"lag": 1.5})
    with pytest.raises(DiagnosisFileError, match=r"probability 1\.5 does not lie between 0 and 1"):
        read_stated(tmp_path)
