"""What counts as exact, as among the alternatives, as a false alarm."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from tirelab.diagnosis.diagnosis_file import Stated, read_stated
from tirelab.validation.held_out import Errors, HeldOut
from tirelab.validation.overlap import RegionScore
from tirelab.validation.score import Discrimination, Score, discrimination

Make = Callable[..., Score]


def test_any_right_set_is_exact(score: Make) -> None:
    assert score("single", "friction", "damping", also_right=["damping"]).exact
    assert not score("single", "friction", "friction damping", also_right=["damping"]).exact


def test_an_alternative_that_is_right_counts_as_among(score: Make) -> None:
    found = score("single", "friction", "damping", alternatives=["friction"])
    assert not found.exact
    assert found.among


def test_a_failed_diagnosis_is_a_miss_but_no_alarm(score: Make) -> None:
    found = score("none", "none", None)
    assert not found.exact
    assert not found.among
    assert not found.false_alarm


def test_an_alarm_is_any_name_where_nothing_was_hidden(score: Make) -> None:
    assert score("none", "none", "friction").false_alarm
    assert not score("none", "none", "none").false_alarm
    assert not score("none", "none", "recalibration", also_right=["recalibration"]).false_alarm


def test_added_names_belong_to_no_right_set(score: Make) -> None:
    assert score("pair", "friction lag", "friction inertia").added == {"inertia"}
    assert score("single", "friction", "none").added == frozenset()


def test_an_effect_outside_of_the_catalogue_is_named_by_unknown(score: Make) -> None:
    found = score("open", "unknown", "unknown friction", sizes={"stuck_channel": 3.0})
    assert found.named("stuck_channel")
    assert found.recognised
    assert not score("open", "unknown", "friction", sizes={"stuck_channel": 3.0}).named("stuck_channel")


def test_an_effect_that_may_stay_unnamed_is_not_demanded(score: Make) -> None:
    hidden = score("pair", "compliance friction", "friction", also_right=["friction"])
    assert hidden.demands("friction")
    assert not hidden.demands("compliance")


def test_a_score_is_the_same_after_a_file(score: Make) -> None:
    found = score(
        "single",
        "friction",
        "damping",
        alternatives=["friction lag"],
        sizes={"friction": 2.5},
        regions=(RegionScore("friction", "time", 0.5),),
        held_out=HeldOut(Errors(3.0, 1.1, 1.0, 0.9, 1.0), Errors(4.0, 1.2, 1.1, 1.0, 1.1), 1e-12),
        discrimination=Discrimination(2, True, "decided rightly"),
    )
    assert Score.from_json(found.to_json()) == found


@pytest.fixture
def stated(tmp_path: Path, diagnosis: Callable[..., None]) -> Callable[..., Stated]:
    def make(names: str, *alternatives: str, test: str | None = "test.csv") -> Stated:
        recommended = None if test is None else {"file": test}
        diagnosis(
            tmp_path,
            names.split(),
            alternatives=[other.split() for other in alternatives],
            separating_test=recommended,
        )
        return read_stated(tmp_path)

    return make


@pytest.mark.parametrize(
    ("second", "outcome"),
    [
        (("friction",), "decided rightly"),
        (("friction", "lag"), "decided rightly"),
        (("damping",), "decided wrongly"),
        (("friction", "damping"), "undecided"),
    ],
)
def test_a_recommended_test_decides_where_one_set_is_left(
    stated: Callable[..., Stated], second: tuple[str, ...], outcome: str
) -> None:
    first = stated("damping", "friction")
    found = discrimination([frozenset({"friction"})], first, stated(*second))
    right = second[0] == "friction"
    assert found == Discrimination(2, True, outcome, right)  # type: ignore[arg-type]


def test_without_a_second_diagnosis_nothing_is_decided(stated: Callable[..., Stated]) -> None:
    untested = discrimination([frozenset({"lag"})], stated("damping", "lag", test=None), None)
    assert untested == Discrimination(2, True, "no test")
    assert discrimination([frozenset({"lag"})], stated("damping", "friction"), None) == Discrimination(
        2, False, "failed"
    )
