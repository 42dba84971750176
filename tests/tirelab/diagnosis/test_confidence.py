"""What a probability rests on, and that what must lower it does.

Which sets stand beside the verdict, and what the recordings are said to lack.
"""

from __future__ import annotations

import json
from dataclasses import replace
from importlib.resources import files
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tirelab.diagnosis.confidence import (
    LOWERING,
    MOST_LOG_ODDS,
    OF_EFFECT,
    OF_VERDICT,
    confidence_of,
    grounds_of_effect,
    grounds_of_verdict,
    no_surer_than_effects,
    of_confounded,
    probability,
    probability_of_effect,
    sharing_odds,
)
from tirelab.estimation.findings import Estimate, Evidence, NamedEffect

CONTENT = json.loads((files("tirelab.diagnosis") / "calibration.json").read_text(encoding="utf-8"))
ZERO = {"verdict": dict.fromkeys(OF_VERDICT, 0.0), "effect": dict.fromkeys(OF_EFFECT, 0.0)}

OF_DEFLECTION = ("gas_compression", "bottoming", "deflection_offset")


def explained(names: str, *others: tuple[str, float], **more: Any) -> Any:
    """An explanation by hand: the chosen set, other sets with their log evidence against it, one surface."""
    sets = ((names, 0.0), *others)
    one_surface = more.get("one_surface", True)
    problem = SimpleNamespace(dataset=SimpleNamespace(misfit=np.full(10, 20.0)))
    return SimpleNamespace(
        effects=tuple(NamedEffect(n, {}, 0.5, 0.9) for n in names.split()),
        evidence=tuple(Evidence(tuple(n.split()), log, 1.0, (), 0.1) for n, log in sets),
        confounded=more.get("confounded", ()),
        probability=0.1,
        remainder=LEFT,
        residuals=(np.full(10, 2.0),),
        error=2.0,
        excitation=SimpleNamespace(
            alike=lambda name: ("inertia",) if name == "viscous_damping" else (),
            of_deflection=lambda name: name in OF_DEFLECTION,
            within_law=lambda name: one_surface and name in OF_DEFLECTION,
        ),
        model=SimpleNamespace(
            radii=(np.inf,),
            fit=SimpleNamespace(problem=problem),
            tire=SimpleNamespace(is_part=more.get("part", True)),
        ),
    )


HELD_OUT: Any = SimpleNamespace(after=6.0)

# A quarter of its power depends on a coordinate.
LEFT: Any = SimpleNamespace(share=0.1, size=3.0, depends=(SimpleNamespace(share=0.25),))


def test_a_refitted_law_that_stands_alone_is_a_ground_of_its_own() -> None:
    for names, expected in (
        ("recalibration", 1.0),
        ("recalibration inertia", 0.0),
        ("inertia", 0.0),
        ("", 0.0),
    ):
        assert (
            grounds_of_verdict(explained(names), HELD_OUT, LEFT, unexplained=False)["law_alone"] == expected
        )


def test_grounds_of_a_verdict_are_those_of_its_definition() -> None:
    one = explained("viscous_damping", ("inertia", -2.0), ("force_lag", -2.0), confounded=(("inertia",),))
    found = grounds_of_verdict(one, HELD_OUT, LEFT, unexplained=True)
    assert set(found) == set(OF_VERDICT)
    # Two others of e^-2 each; 6 N held out against 2 N fitted; a misfit of twenty noises.
    assert found["odds"] == pytest.approx(2.0 - np.log(2.0))
    assert found["contested"] == pytest.approx(0.9)
    assert found["transfer"] == pytest.approx(np.log(3.0))
    assert found["loudness"] == pytest.approx(np.log(20.0))
    assert found["alike"] == pytest.approx(np.log(2.0))
    assert found["remainder_size"] == pytest.approx(np.log(4.0))
    # A quarter of the remainder's power is half of its three noises; each effect has half of the misfit.
    assert found["structure"] == pytest.approx(np.log(2.5))
    assert found["least_share"] == pytest.approx(np.log(0.5))
    assert (found["unknown"], found["nothing"]) == (1.0, 0.0)
    assert found["unknown_size"] == found["remainder_size"]


def test_the_remainder_that_counts_is_the_told_one() -> None:
    """That of the averaged samples is three noises, that of the written tire ten."""
    told: Any = SimpleNamespace(share=0.9, size=10.0, depends=())
    found = grounds_of_verdict(explained("inertia"), HELD_OUT, told, unexplained=False)
    assert (found["remainder_share"], found["remainder_size"]) == (0.9, pytest.approx(np.log(11.0)))
    assert (found["structure"], found["unknown_size"]) == (0.0, 0.0)


def test_that_nothing_is_named_is_a_ground() -> None:
    found = grounds_of_verdict(explained(""), HELD_OUT, LEFT, unexplained=False)
    assert (found["unknown"], found["nothing"]) == (0.0, 1.0)


def test_odds_of_an_effect_are_all_sets_with_it_against_all_without() -> None:
    one = explained("inertia viscous_damping", ("inertia", -1.0), ("force_lag", -3.0))
    inertia, damping = (grounds_of_effect(e, one, HELD_OUT) for e in one.effects)
    assert inertia["odds"] == pytest.approx(np.logaddexp(0.0, -1.0) + 3.0)
    assert damping["odds"] == pytest.approx(-np.logaddexp(-1.0, -3.0))
    assert damping["alike"] > inertia["alike"] == 0.0


def test_an_effect_in_every_set_has_the_largest_odds_that_count() -> None:
    one = explained("inertia", ("inertia force_lag", -4.0))
    assert grounds_of_effect(one.effects[0], one, HELD_OUT)["odds"] == MOST_LOG_ODDS


@pytest.mark.parametrize(
    ("names", "imitated"),
    [
        ("recalibration bottoming", 2.0),
        ("recalibration deflection_offset", 0.0),
        ("recalibration inertia", 0.0),
        ("saturation gas_compression", 0.0),
    ],
)
def test_a_refitted_law_imitates_what_it_could_be(names: str, imitated: float) -> None:
    """An onset and its width may follow a law; an offset has nothing but its size."""
    one = explained(names)
    assert grounds_of_verdict(one, HELD_OUT, LEFT, unexplained=False)["imitated"] == imitated
    assert sum(grounds_of_effect(e, one, HELD_OUT)["imitated"] for e in one.effects) == imitated


def test_on_several_surfaces_a_law_of_another_form_can_still_be_an_effect_of_the_deflection() -> None:
    """The verdict is not doubted for it: on several surfaces the catalogue's own law could not be all of it."""
    one = explained("recalibration gas_compression", one_surface=False)
    assert grounds_of_verdict(one, HELD_OUT, LEFT, unexplained=False)["imitated"] == 0.0
    found = [grounds_of_effect(e, one, HELD_OUT) for e in one.effects]
    assert [f["imitated"] for f in found] == [0.0, 0.0]
    assert [f["beside_law"] for f in found] == [0.0, 1.0]


def test_that_a_tires_law_has_another_shape_is_in_the_odds_and_not_counted_twice() -> None:
    one = explained("recalibration gas_compression", one_surface=False, part=False)
    assert [grounds_of_effect(e, one, HELD_OUT)["beside_law"] for e in one.effects] == [0.0, 0.0]


@pytest.mark.parametrize(
    ("name", "shared"),
    [
        ("bottoming", 0.5),
        ("gas_compression", 0.5),
        ("deflection_offset", 0.5),
        ("saturation", 1.0),
        ("inertia", 1.0),
    ],
)
def test_an_effect_of_the_deflection_shares_its_probability_with_a_law_of_another_shape(
    name: str, shared: float
) -> None:
    """Beside a refitted law only, and not what a sensor does to the force: that is no law."""
    for names, expected in ((f"{name} recalibration", shared), (name, 1.0)):
        one = explained(names)
        grounds = grounds_of_effect(one.effects[0], one, HELD_OUT)
        found = probability_of_effect(one.effects[0].name, grounds)
        assert found == pytest.approx(expected * probability("effect", grounds))


def test_a_refitted_law_in_an_effects_place_imitates_it_as_far_as_it_is_likely() -> None:
    """All sets have the tempered probability 0.1 here: the law is as likely as the air's compression."""
    one = explained("gas_compression inertia", ("recalibration inertia", 0.0))
    assert grounds_of_verdict(one, HELD_OUT, LEFT, unexplained=False)["imitated"] == 1.0
    assert [grounds_of_effect(e, one, HELD_OUT)["imitated"] for e in one.effects] == [1.0, 0.0]
    another = explained("gas_compression inertia", ("recalibration", 0.0))
    assert grounds_of_verdict(another, HELD_OUT, LEFT, unexplained=False)["imitated"] == 0.0


def test_a_verdict_is_no_surer_than_an_effect_that_it_names() -> None:
    assert no_surer_than_effects(0.9, [0.95, 0.3]) == 0.3
    assert no_surer_than_effects(0.9, [0.95]) == no_surer_than_effects(0.9, []) == 0.9


def test_a_verdict_is_no_surer_than_that_what_it_leaves_out_is_not_there() -> None:
    assert no_surer_than_effects(0.9, [0.95], [0.1, 0.25]) == 0.75
    assert no_surer_than_effects(0.9, [], [0.1]) == no_surer_than_effects(0.9, [], []) == 0.9


@pytest.mark.parametrize("odds", [-15.0, -3.0, 0.0, 2.0, 15.0])
def test_that_no_known_effect_acts_is_no_surer_than_the_evidence_against_all_of_them(odds: float) -> None:
    """Odds of e^x to 1 are a probability of e^x / (1 + e^x); less than even are those of sets that were refuted."""
    grounds = ZERO["verdict"] | {"nothing": 1.0, "significance": 1.0, "odds": odds}
    free = confidence_of(grounds | {"unknown": 0.0}, [], [])
    unknown = grounds | {"unknown": 1.0, "unknown_size": 4.0, "remainder_size": 4.0, "loudness": 4.0}
    posterior = np.exp(odds) / (1.0 + np.exp(odds)) if odds > 0.0 else 0.5
    assert confidence_of(unknown, [], []) == pytest.approx(min(probability("verdict", unknown), posterior))
    assert free == probability("verdict", grounds | {"unknown": 0.0})


def test_what_speaks_for_sets_without_an_effect_contests_it() -> None:
    one = explained("inertia viscous_damping", ("inertia", -1.0), ("force_lag", -3.0))
    inertia, damping = (grounds_of_effect(e, one, HELD_OUT)["contested"] for e in one.effects)
    assert (inertia, damping) == (pytest.approx(0.1), pytest.approx(0.2))


def test_sets_that_are_alike_share_the_odds_of_a_verdict() -> None:
    assert sharing_odds(0.8, 0) == pytest.approx(0.8)
    # Odds of four to one against one rival that is alike: four to two.
    assert sharing_odds(0.8, 1) == pytest.approx(4.0 / 6.0)
    assert of_confounded(4.0 / 6.0, 1) == pytest.approx(0.8)


def test_sets_that_leave_the_same_share_the_probability_of_a_verdict() -> None:
    """Calibrated is the probability of all of them together, so of two that are as likely each has a half of it."""
    grounds = {**ZERO["verdict"], "odds": 15.0}
    alone = confidence_of(grounds, [0.9], [])
    assert confidence_of(grounds, [0.9], [], share=0.5) == pytest.approx(0.5 * alone)


@pytest.mark.parametrize("of", ["verdict", "effect"])
def test_a_remainder_a_worse_held_out_error_and_a_poor_motion_never_raise_a_probability(of: str) -> None:
    usual = probability(of, ZERO[of])
    for ground in (g for g in LOWERING if g in ZERO[of]):
        assert probability(of, {**ZERO[of], ground: 1.0}) <= usual


@pytest.mark.parametrize("of", ["verdict", "effect"])
def test_evidence_over_the_other_sets_raises_a_probability(of: str) -> None:
    """By odds over the next set or by how probable all others are together; neither may count the other way."""
    usual = probability(of, {**ZERO[of], "contested": 0.5})
    assert probability(of, {**ZERO[of], "contested": 0.5, "odds": 5.0}) >= usual
    assert probability(of, {**ZERO[of], "contested": 0.01, "odds": 5.0}) > usual


def test_the_file_says_how_it_was_made() -> None:
    assert CONTENT["command"].startswith("python -m tirelab.validation.calibrate --seed ")
    for of in ("verdict", "effect"):
        assert CONTENT[of]["rows"] > 100
        assert 0.0 < CONTENT[of]["skill_left_out"] < 1.0


@pytest.mark.parametrize(("deviations", "probability"), [(0.0, 0.0), (1.0, 0.6827), (1.96, 0.95), (8.0, 1.0)])
def test_an_effect_is_as_significant_as_its_best_determined_parameter(
    deviations: float, probability: float
) -> None:
    """The normal distribution's own table; a lag that is not determined takes nothing from a delay that is."""
    parameters = {
        "lag": Estimate(1e-4, 1.0, "s"),
        "delay": Estimate(deviations * 2e-3, 2e-3, "s"),
        "quality": Estimate(5.0, 0.1, "1"),
    }
    one = explained("force_lag viscous_damping")
    one.effects = (replace(one.effects[0], parameters=parameters), one.effects[1])
    found = grounds_of_effect(one.effects[0], one, HELD_OUT)["significance"]
    assert found == pytest.approx(probability, abs=1e-4)
    assert grounds_of_verdict(one, HELD_OUT, LEFT, unexplained=False)["significance"] == found


def test_a_refitted_law_and_nothing_are_judged_by_their_odds() -> None:
    for names in ("recalibration", ""):
        found = grounds_of_verdict(explained(names), HELD_OUT, LEFT, unexplained=False)
        assert found["significance"] == 1.0
