"""The names of effects, sets and coordinates in a sentence."""

from __future__ import annotations

import pytest
from radialtire import CATALOGUE
from tirelab.names import REFITTED_LAW, UNKNOWN
from tirelab.report import titles, words

REMAINS = ("deflection", "rate", "acceleration", "time", "force")
"""The coordinates of diagnosis.json on which a remainder may depend."""


@pytest.mark.parametrize(
    ("name", "title"),
    [
        ("rate_independent_hysteresis", "rate-independent hysteresis"),
        ("mullins_softening", "Mullins softening"),
        ("recalibration", "refitted law"),
        ("unknown", "something unknown"),
        ("relaxation_time_1", "relaxation time 1"),
    ],
)
def test_effects_and_parameters_have_titles(name: str, title: str) -> None:
    assert titles.effect_title(name) == title


def test_a_short_name_is_told_with_the_effect_s_own_once() -> None:
    assert titles.full_title("rate_independent_hysteresis") == "friction loop (rate-independent hysteresis)"
    assert titles.full_title("inertia") == "inertia"
    assert titles.set_title(["series_compliance", "inertia"]) == "series spring and inertia"
    assert titles.headline(["viscoelastic_relaxation"], False, False) == (
        "Left out: relaxation (viscoelastic relaxation)."
    )


def test_no_title_of_the_catalogue_is_code() -> None:
    for name in (*CATALOGUE, REFITTED_LAW, UNKNOWN, *REMAINS):
        assert "_" not in titles.set_title([name])


def test_every_coordinate_of_something_unknown_has_a_name_for_a_reader() -> None:
    for by in REMAINS:
        assert titles.dependence(by).startswith("the ") or by in ("time", "force"), by
    assert titles.dependence("humidity") == "humidity"


@pytest.mark.parametrize(
    ("words", "text"), [([], ""), (["a"], "a"), (["a", "b"], "a or b"), (["a", "b", "c"], "a, b or c")]
)
def test_lists(words: list[str], text: str) -> None:
    assert titles.listed(words, "or") == text


def test_forces_and_confidence() -> None:
    assert [titles.newtons(f) for f in (6.0, 0.01234, 999.4, 999.6, -1500.0)] == [
        "6.00 N",
        "0.0123 N",
        "999 N",
        "1000 N",
        "-1500 N",
    ]
    assert titles.newtons(9.6e-5) == f"{words.number(9.6e-5)} N" == "9.60·10⁻⁵ N"
    assert titles.sure(0.946) == "Confidence 95 %."


@pytest.mark.parametrize(
    ("names", "unexplained", "alternatives", "told"),
    [
        ([], False, [], "Nothing is missing."),
        (["recalibration"], False, [], "No other physics shows: the elastic law has other coefficients."),
        (
            ["recalibration"],
            True,
            [],
            "Left out: something that no known effect explains, and the elastic law has other coefficients.",
        ),
        (["inertia", "force_lag"], False, [], "Left out: inertia and force lag."),
        ([], True, [], "Something is missing that no known effect explains."),
        (
            [],
            False,
            [["force_offset"]],
            "Nothing is missing – but these recordings cannot rule out alternatives.",
        ),
    ],
)
def test_first_sentences(
    names: list[str], unexplained: bool, alternatives: list[list[str]], told: str
) -> None:
    assert titles.headline(names, unexplained, bool(alternatives)) == told


def test_an_effect_that_the_baseline_has_is_not_left_out() -> None:
    assert titles.headline(["inertia"], False, False, changed=["inertia"]) == (
        "Inertia has other values than simulated."
    )
    several = titles.headline(
        ["inertia", "force_lag", "saturation"], True, False, changed=["inertia", "saturation"]
    )
    assert several == (
        "Left out: force lag and something that no known effect explains; inertia and saturation have other values "
        "than simulated."
    )


def test_a_refitted_law_that_leaves_more_than_the_noise_does_not_say_that_nothing_is_missing() -> None:
    assert titles.headline(["recalibration"], False, False, left=True) == (
        "The elastic law has other coefficients, and more than the noise is left."
    )
    assert titles.headline([], False, False, left=True) == "Nothing is missing."


@pytest.mark.parametrize(
    ("names", "other", "told"),
    [
        (["inertia"], ["inertia", "series_compliance"], "+ series spring"),
        (["recalibration", "inertia"], ["inertia"], "− refitted law"),
        (["rate_independent_hysteresis"], ["viscous_damping"], "viscous damping instead of friction loop"),
        (["inertia"], ["viscous_damping", "force_lag"], "+ viscous damping + force lag − inertia"),
        ([], ["force_offset"], "+ force offset"),
        (["force_offset"], [], "− force offset"),
        (["inertia", "force_lag"], ["force_lag", "inertia"], "the same"),
    ],
)
def test_alternatives_are_told_as_differences(names: list[str], other: list[str], told: str) -> None:
    assert titles.difference(names, other) == told


@pytest.mark.parametrize(
    ("first", "second", "told"),
    [
        (["inertia"], ["inertia", "series_compliance"], "whether the series spring acts too"),
        (["inertia", "force_lag"], [], "whether the inertia and the force lag act too"),
        (["inertia"], ["force_lag", "unknown"], "between inertia and force lag + something unknown"),
        (["inertia", "unknown"], ["inertia"], "whether something unknown acts too"),
        (["recalibration", "inertia"], ["inertia"], "whether the law has other coefficients"),
        (["inertia"], ["inertia"], ""),
    ],
)
def test_what_decides_between_two_sets(first: list[str], second: list[str], told: str) -> None:
    assert titles.question(first, second, " too") == told
