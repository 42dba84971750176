"""What a probability rests on, and that what must lower it does."""

from __future__ import annotations

import json
from importlib.resources import files
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tirelab.diagnosis.confidence import (
    FURTHEST,
    LOWERING,
    OF_EFFECT,
    OF_VERDICT,
    grounds_of_effect,
    grounds_of_verdict,
    probability,
    shared,
    unshared,
)
from tirelab.estimation.findings import Evidence, NamedEffect

CONTENT = json.loads((files("tirelab.diagnosis") / "calibration.json").read_text(encoding="utf-8"))
ZERO = {"verdict": dict.fromkeys(OF_VERDICT, 0.0), "effect": dict.fromkeys(OF_EFFECT, 0.0)}


def explained(names: str, *others: tuple[str, float], **more: Any) -> Any:
    """An explanation by hand: the chosen set, other sets with their log evidence against it, one surface."""
    sets = ((names, 0.0), *others)
    one_surface = more.get("one_surface", True)
    problem = SimpleNamespace(dataset=SimpleNamespace(misfit=np.full(10, 20.0)))
    return SimpleNamespace(
        effects=tuple(NamedEffect(n, {}, 0.5, 0.9) for n in names.split()),
        evidence=tuple(Evidence(tuple(n.split()), log, 1.0, (), 0.1) for n, log in sets),
        confounded=more.get("confounded", ()),
        remainder=SimpleNamespace(share=0.1, size=3.0, depends=(SimpleNamespace(share=0.25),)),
        residuals=(np.full(10, 2.0),),
        excitation=SimpleNamespace(
            alike=lambda name: ("inertia",) if name == "viscous_damping" else (),
            within_law=lambda name: one_surface and name == "gas_compression",
        ),
        model=SimpleNamespace(radii=(np.inf,), fit=SimpleNamespace(problem=problem)),
    )


HELD_OUT: Any = SimpleNamespace(after=6.0)


def test_a_refitted_law_that_stands_alone_is_a_ground_of_its_own() -> None:
    for names, expected in (
        ("recalibration", 1.0),
        ("recalibration inertia", 0.0),
        ("inertia", 0.0),
        ("", 0.0),
    ):
        assert grounds_of_verdict(explained(names), HELD_OUT, unexplained=False)["law_alone"] == expected


def test_grounds_of_a_verdict_are_those_of_its_definition() -> None:
    one = explained("viscous_damping", ("inertia", -2.0), ("force_lag", -2.0), confounded=(("inertia",),))
    found = grounds_of_verdict(one, HELD_OUT, unexplained=True)
    assert set(found) == set(OF_VERDICT)
    # Two others of e^-2 each; 6 N held out against 2 N fitted; a misfit of twenty noises.
    assert found["odds"] == pytest.approx(2.0 - np.log(2.0))
    assert found["transfer"] == pytest.approx(np.log(3.0))
    assert found["loudness"] == pytest.approx(np.log(20.0))
    assert found["alike"] == pytest.approx(np.log(2.0))
    assert found["remainder_size"] == pytest.approx(np.log(4.0))
    # A quarter of the remainder's power is half of its three noises; each effect has half of the misfit.
    assert found["structure"] == pytest.approx(np.log(2.5))
    assert found["least_share"] == pytest.approx(np.log(0.5))
    assert (found["unknown"], found["nothing"]) == (1.0, 0.0)


def test_that_nothing_is_named_is_a_ground() -> None:
    found = grounds_of_verdict(explained(""), HELD_OUT, unexplained=False)
    assert (found["unknown"], found["nothing"]) == (0.0, 1.0)


def test_odds_of_an_effect_are_all_sets_with_it_against_all_without() -> None:
    one = explained("inertia viscous_damping", ("inertia", -1.0), ("force_lag", -3.0))
    inertia, damping = (grounds_of_effect(e, one, HELD_OUT) for e in one.effects)
    assert inertia["odds"] == pytest.approx(np.logaddexp(0.0, -1.0) + 3.0)
    assert damping["odds"] == pytest.approx(-np.logaddexp(-1.0, -3.0))
    assert damping["alike"] > inertia["alike"] == 0.0


def test_an_effect_in_every_set_has_the_largest_odds_that_count() -> None:
    one = explained("inertia", ("inertia force_lag", -4.0))
    assert grounds_of_effect(one.effects[0], one, HELD_OUT)["odds"] == FURTHEST


@pytest.mark.parametrize(
    ("names", "imitated"),
    [
        ("recalibration gas_compression", 1.0),
        ("recalibration inertia", 0.0),
        ("bottoming gas_compression", 0.0),
    ],
)
def test_a_refitted_law_imitates_what_it_could_be(names: str, imitated: float) -> None:
    one = explained(names)
    assert grounds_of_verdict(one, HELD_OUT, unexplained=False)["imitated"] == imitated
    assert sum(grounds_of_effect(e, one, HELD_OUT)["imitated"] for e in one.effects) == imitated


def test_on_several_surfaces_a_law_of_another_form_can_still_be_an_effect_of_the_deflection() -> None:
    """The verdict is not doubted for it: on several surfaces the catalogue's own law could not be all of it."""
    one = explained("recalibration gas_compression", one_surface=False)
    assert grounds_of_verdict(one, HELD_OUT, unexplained=False)["imitated"] == 0.0
    assert [grounds_of_effect(e, one, HELD_OUT)["imitated"] for e in one.effects] == [0.0, 1.0]


def test_sets_that_are_alike_share_the_odds_of_a_verdict() -> None:
    assert shared(0.8, 0) == pytest.approx(0.8)
    # Odds of four to one against one rival that is alike: four to two.
    assert shared(0.8, 1) == pytest.approx(4.0 / 6.0)
    assert unshared(4.0 / 6.0, 1) == pytest.approx(0.8)


@pytest.mark.parametrize("of", ["verdict", "effect"])
def test_a_remainder_a_worse_held_out_error_and_a_poor_motion_never_raise_a_probability(of: str) -> None:
    usual = probability(of, ZERO[of])
    for ground in (g for g in LOWERING if g in ZERO[of]):
        assert probability(of, {**ZERO[of], ground: 1.0}) <= usual


@pytest.mark.parametrize("of", ["verdict", "effect"])
def test_better_odds_raise_a_probability(of: str) -> None:
    assert probability(of, {**ZERO[of], "odds": 5.0}) > probability(of, ZERO[of])


def test_the_file_says_how_it_was_made() -> None:
    assert CONTENT["command"].startswith("python -m tirelab.validation.calibrate --seed ")
    for of in ("verdict", "effect"):
        assert CONTENT[of]["rows"] > 100
        assert 0.0 < CONTENT[of]["skill_left_out"] < 1.0
