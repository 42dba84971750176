"""Alternatives hold the promised probability, and their reasons say what to record."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drives import damped, flat_force, read, triangle
from radialtire import TireModel
from tirelab.diagnosis.alternatives import (
    CREDIBLE,
    Alternative,
    alternatives_of,
    insufficient_excitation,
    no_surer_than_alternatives,
    reason_of,
)
from tirelab.diagnosis.outcome import split_reason
from tirelab.estimation.findings import Evidence, NamedEffect
from tirelab.planning.waveforms import Limits
from tirelab.preprocessing.samples import RawDataset, raw_dataset_of
from tirelab.regressors.excitation import NO_EVIDENCE

RIDE = raw_dataset_of([damped(1, samples=2000)], TireModel())
LOOP, DAMPING = ("rate_independent_hysteresis",), ("viscous_damping",)


def explained_by_sets(*sets: tuple[str, float, float], **more: Any) -> Any:
    """Return an explanation by hand of sets (names, log evidence, probability), the first the verdict if not said."""
    evidence = tuple(Evidence(tuple(n.split()), log, 1.0, (), p) for n, log, p in sets)
    names = tuple(more.get("verdict", sets[0][0]).split())
    return SimpleNamespace(
        evidence=evidence,
        probability=next(e.probability for e in evidence if e.names == names),
        model=SimpleNamespace(names=names, baseline=more.get("baseline", TireModel())),
        confounded=more.get("confounded", ()),
        same=more.get("same", ()),
        share=more.get("share", 1.0),
        unshown=SimpleNamespace(reasons=more.get("hidden", ())),
        read_instead=more.get("read_instead", ()),
        within_law=more.get("within_law", ()),
        excitation=SimpleNamespace(
            timed=True,
            channels=more.get("channels", NO_EVIDENCE),
            one_speed=more.get("one_speed", False),
            of_deflection=lambda name: name in more.get("single_valued", ()),
        ),
    )


def listed(explanation: Any, confidence: float, dataset: RawDataset = RIDE) -> list[tuple[str, ...]]:
    return [a.names for a in alternatives_of(explanation, dataset, confidence)]


SETS = (("inertia", 0.0, 0.6), ("force_lag", -1.4, 0.3), ("saturation", -4.0, 0.08), ("", -7.0, 0.02))


def test_verdict_and_alternatives_hold_the_promised_probability_and_no_more_sets_are_listed() -> None:
    explanation = explained_by_sets(*SETS)
    found = alternatives_of(explanation, RIDE, 0.6)
    assert [a.names for a in found] == [
        ("force_lag",),
        ("saturation",),
    ]  # of 0.4, what the evidence gives them
    assert 0.6 + sum(a.probability for a in found) >= CREDIBLE


def test_what_the_confidence_leaves_is_shared_by_the_others_as_their_evidence_is() -> None:
    """The ranking gives the others 0.3, 0.08 and 0.02; a confidence of 0.8 leaves them half as much."""
    found = alternatives_of(explained_by_sets(*SETS), RIDE, 0.8)
    assert [a.probability for a in found] == pytest.approx([0.15, 0.04])


def test_no_set_is_told_as_likelier_beside_the_verdict_than_its_evidence_is() -> None:
    """The next set has half of the verdict's evidence; what is left of a doubted verdict belongs to none of them."""
    found = alternatives_of(explained_by_sets(*SETS), RIDE, 0.2)
    assert [a.probability for a in found] == pytest.approx([0.1, 0.2 * 0.08 / 0.6, 0.2 * 0.02 / 0.6])


def test_a_set_that_leaves_the_same_is_as_likely_beside_the_verdict_as_its_evidence_says() -> None:
    """Of 0.9 for both, two thirds and one third; the others share what is left of one."""
    sets = (
        ("deflection_lag", 0.0, 0.6),
        ("inertia", -0.5, 0.06),
        ("viscous_damping", -1.4, 0.3),
        ("", -9.0, 0.04),
    )
    explanation = explained_by_sets(*sets, same=(("viscous_damping",),), share=2.0 / 3.0)
    first, second = alternatives_of(explanation, RIDE, 0.6)[:2]
    assert (first.names, first.same, first.probability) == (("viscous_damping",), True, pytest.approx(0.3))
    assert first.reason == "their forces are the same in this motion: test the gauges by themselves"
    assert (second.names, second.same, second.probability) == (("inertia",), False, pytest.approx(0.06))


@pytest.mark.parametrize(
    ("one_speed", "said"), [(True, "one speed at each deflection only: "), (False, "their forces")]
)
def test_what_leaves_the_same_at_one_speed_is_told_apart_by_another(one_speed: bool, said: str) -> None:
    sets = (("viscous_damping", 0.0, 0.6), (*LOOP, -0.5, 0.4))
    explanation = explained_by_sets(*sets, same=(LOOP,), share=0.6, one_speed=one_speed)
    assert alternatives_of(explanation, RIDE, 0.5)[0].reason.startswith(said)


def test_what_leaves_the_same_as_a_verdict_that_is_far_behind_has_no_more_than_both() -> None:
    """Where the verdict's own evidence is nothing beside another set's, its confidence is all there is to share."""
    sets = (("deflection_lag", 0.0, 0.0), ("viscous_damping", 3.0, 0.2), ("inertia", 9.0, 0.8))
    explanation = explained_by_sets(*sets, same=(("viscous_damping",),))
    damping = alternatives_of(explanation, RIDE, 0.3)[0]
    assert (damping.names, damping.probability) == (("viscous_damping",), pytest.approx(0.3))


def test_an_effect_is_no_surer_than_the_alternatives_without_it_leave() -> None:
    """Two of three alternatives lack the lag, with 0.12 and 0.05 together; a fourth one's probability is not known."""
    lag, law = (NamedEffect(n, {}, 0.5, 0.96) for n in ("deflection_lag", "recalibration"))
    sets = (("recalibration", "viscous_damping"), ("recalibration",), ("deflection_lag",), ("inertia",))
    several = [
        Alternative(names, 1.0, "", p) for names, p in zip(sets, (0.12, 0.05, 0.02, math.nan), strict=True)
    ]
    found = no_surer_than_alternatives((lag, law), several)
    assert [e.probability for e in found] == pytest.approx([0.83, 0.96])
    assert found[1] == law


def test_a_sure_verdict_has_no_alternatives() -> None:
    assert listed(explained_by_sets(("inertia", 0.0, 0.999), ("force_lag", -14.0, 0.001)), 0.98) == []


def test_an_effect_that_the_motion_cannot_tell_apart_comes_first_however_unlikely_it_is() -> None:
    explanation = explained_by_sets(
        ("viscous_damping", 0.0, 0.9),
        ("inertia", -4.0, 0.099),
        ("rate_independent_hysteresis", -13.0, 0.001),
        confounded=(LOOP,),
        one_speed=True,
    )
    assert listed(explanation, 0.9) == [LOOP, ("inertia",)]


def test_an_effect_that_the_excitation_cannot_show_stands_beside_the_verdict_with_the_reason() -> None:
    why = "the recording has no time"
    (found,) = alternatives_of(
        explained_by_sets(("inertia", 0.0, 1.0), hidden=(("warm_up", why),)), RIDE, 0.98
    )
    assert set(found.names) == {"inertia", "warm_up"}
    assert found.reason == why


def test_the_log_odds_are_those_of_the_verdict_that_is_delivered() -> None:
    """The likeliest set was refused: e^3 to 1 against the verdict."""
    explanation = explained_by_sets(
        ("inertia", 0.0, 0.9), ("", -3.0, 0.05), ("force_lag", -3.5, 0.05), verdict=""
    )
    found = {a.names: a.log_odds for a in alternatives_of(explanation, RIDE, 0.05)}
    assert found[("inertia",)] == pytest.approx(-3.0)
    assert found[("force_lag",)] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("one", "other", "said"),
    [
        (("recalibration",), ("gas_compression",), "surface only: repeat at a second pressure"),
        (("warm_up",), ("pressure_leak",), "repeat the first cycle after a rest"),
        (LOOP, DAMPING, "one speed at each deflection only: repeat at "),
    ],
)
def test_the_reason_is_what_to_record(one: tuple[str, ...], other: tuple[str, ...], said: str) -> None:
    assert said in reason_of(one, other, explained_by_sets((" ".join(one), 0.0, 1.0), one_speed=True), RIDE)


def test_holds_surfaces_and_cycles_that_are_missing_are_named() -> None:
    time, deflection = triangle(samples=180)
    press = raw_dataset_of([read("press", time, deflection, flat_force(deflection), 4)], TireModel())
    said = "; ".join(insufficient_excitation(explained_by_sets(("inertia", 0.0, 1.0)), press))
    for words in ("press on a second surface", "hold 10 s at 15 mm", "drive each cycle twice"):
        assert words in said


@pytest.mark.parametrize(("held", "said"), [(120.0, False), (0.3, True)])
def test_a_load_that_is_held_is_a_hold_though_the_part_creeps_and_the_gauge_trembles(
    held: float, said: bool
) -> None:
    """A ramp of 5 s to 20 mm, and creep by 1 mm for each factor e of the time, read with 5 um of noise."""
    time = np.arange(0.0, 5.0 + held, 0.02)
    deflection = np.where(time < 5.0, 4e-3 * time, 0.02 + 1e-3 * np.log(np.maximum(time / 5.0, 1.0)))
    creep = raw_dataset_of([read("creep", time, deflection, flat_force(deflection), 4)], TireModel())
    lacks = insufficient_excitation(explained_by_sets(("inertia", 0.0, 1.0)), creep)
    assert any(lack.startswith("no hold") for lack in lacks) == said


@pytest.mark.parametrize(("period", "said"), [(20.0, True), (2000.0, False)])
def test_the_turn_of_a_sine_is_no_hold_unless_it_lasts(period: float, said: bool) -> None:
    """It is slower than a fiftieth of the mean speed for 1 s where the period is 250 s."""
    time = np.arange(0.0, 2.0 * period, period / 1000.0)
    deflection = 0.01 * (1.0 - np.cos(2.0 * np.pi * time / period))
    sine = raw_dataset_of([read("sine", time, deflection, flat_force(deflection), 4)], TireModel())
    lacks = insufficient_excitation(explained_by_sets(("inertia", 0.0, 1.0)), sine)
    assert any(lack.startswith("no hold") for lack in lacks) == said


def test_a_part_that_is_never_above_zero_is_held_within_its_own_deflections() -> None:
    """From -527 to -500 mm, 0.65 of the way up: -509 mm."""
    time, deflection = triangle(samples=180)
    part = TireModel(two_sided=True, inflated=False)
    below = deflection * 0.027 / float(deflection.max()) - 0.527
    joint = raw_dataset_of([read("joint", time, below, 1e3 * below, 4)], part)
    said = "; ".join(insufficient_excitation(explained_by_sets(("inertia", 0.0, 1.0)), joint))
    assert "hold 10 s at \N{MINUS SIGN}509 mm" in said


@pytest.mark.parametrize(("fastest", "faster"), [(10.0, True), (0.02, False)])
def test_the_other_speed_is_one_that_the_rig_reaches(fastest: float, faster: bool) -> None:
    """The press goes 23 mm in 2 s, 11.5 mm/s: ten times that where the rig reaches it, else a tenth."""
    time, deflection = triangle(samples=180)
    press = raw_dataset_of([read("press", time, deflection, flat_force(deflection), 4)], TireModel())
    asked = explained_by_sets((" ".join(LOOP), 0.0, 1.0), one_speed=True)
    said = reason_of(LOOP, DAMPING, asked, press, Limits(fastest=fastest))
    speed = float(said.split("repeat at ")[1].split()[0])
    assert speed == pytest.approx(115.0 if faster else 1.15, rel=0.1)


def test_a_second_surface_is_asked_for_only_where_one_can_be_mounted() -> None:
    asked = explained_by_sets(("inertia", 0.0, 1.0))
    assert "press on a second surface" not in "; ".join(
        insufficient_excitation(asked, RIDE, Limits(surfaces=(math.inf,)))
    )
    assert "press on a second surface" in "; ".join(
        insufficient_excitation(asked, RIDE, Limits(surfaces=(math.inf, 0.254)))
    )


def test_no_second_pressure_is_asked_for_where_there_is_no_air() -> None:
    part = explained_by_sets(("", 0.0, 1.0), baseline=TireModel(inflated=False))
    said = reason_of(("recalibration",), ("gas_compression",), part, RIDE)
    assert said == "they depend on the deflection only, and no motion of this part tells them apart"
    assert split_reason(said) == (said, "")  # not an action


@pytest.mark.parametrize(
    ("one", "other", "told"),
    [
        (LOOP, DAMPING, True),  # friction stays, the damper's force is gone
        (LOOP, ("viscoelastic_relaxation",), True),
        ((), ("viscoelastic_relaxation",), True),
        (DAMPING, ("force_lag",), False),  # neither has a force at rest
        ((), ("inertia",), False),
        (LOOP, ("mullins_softening",), False),  # both keep theirs
    ],
)
def test_a_hold_is_asked_for_where_it_tells_sets_apart(
    one: tuple[str, ...], other: tuple[str, ...], told: bool
) -> None:
    time, deflection = triangle(samples=180)
    press = raw_dataset_of([read("press", time, deflection, flat_force(deflection), 4)], TireModel())
    said = reason_of(one, other, explained_by_sets((" ".join(one), 0.0, 1.0)), press)
    assert ("hold 10 s" in said) == told


@pytest.mark.parametrize(
    ("pressures", "said"),
    [
        ((), "second pressure"),
        ((2e5,), "second pressure"),
        ((2e5, 3e5, 3.447e5), "pressure (2, 3 or 3.45 bar)"),
    ],
)
def test_the_second_pressure_is_one_that_the_rig_holds(pressures: tuple[float, ...], said: str) -> None:
    asked = explained_by_sets(("recalibration", 0.0, 1.0))
    limits = Limits(pressures=pressures)
    assert reason_of(("recalibration",), ("gas_compression",), asked, RIDE, limits).endswith(said)


def test_no_second_pressure_is_asked_for_where_several_were_recorded() -> None:
    varied = replace(NO_EVIDENCE, varied=frozenset({"pressure"}))
    asked = explained_by_sets(("recalibration", 0.0, 1.0), channels=varied)
    said = reason_of(("recalibration",), ("gas_compression",), asked, RIDE, Limits(pressures=(2e5, 3e5)))
    assert split_reason(said)[1] == "repeat at a pressure further from those recorded"


def test_what_leaves_no_trace_beside_the_refitted_law_is_told_once_with_the_reason() -> None:
    explanation = explained_by_sets(
        ("recalibration", 0.0, 0.9),
        ("recalibration series_compliance", -4.0, 0.1),
        verdict="recalibration",
        within_law=("series_compliance", "deflection_offset"),
    )
    found = alternatives_of(explanation, RIDE, 0.8)
    assert [set(a.names) for a in found] == [
        {"recalibration", "series_compliance"},
        {"recalibration", "deflection_offset"},
    ]
    assert not math.isnan(found[0].probability)
    assert math.isnan(found[1].probability)
    assert found[1].reason == "they depend on deflection and surface only: repeat at a second pressure"


def test_what_is_of_the_deflection_in_this_motion_alone_is_told_by_another_motion() -> None:
    """A mass at one frequency is like a softer law; where it is no function of the deflection, it lacks no motion."""
    sets = (("recalibration", 0.0, 0.9), ("inertia", -1.0, 0.1))
    alike = explained_by_sets(*sets, single_valued=("inertia",))
    reason = reason_of(("recalibration",), ("inertia",), alike, RIDE)
    assert reason.startswith(
        "they depend on the deflection only in this motion: load and unload to two depths"
    )
    assert "in this motion" not in reason_of(("recalibration",), ("inertia",), explained_by_sets(*sets), RIDE)


def test_effects_that_the_reading_hides_in_place_of_one_share_what_the_verdict_has() -> None:
    pairs = (("force_lag", "viscous_damping"), ("force_lag", "inertia"))
    explanation = explained_by_sets(("bottoming force_lag", 0.0, 1.0), read_instead=pairs)
    first, second = alternatives_of(explanation, RIDE, 0.4)
    assert (first.names, second.names) == (("bottoming", "viscous_damping"), ("bottoming", "inertia"))
    assert first.probability == second.probability == pytest.approx(0.2)
    assert "use a finer gauge" in first.reason


def test_an_effect_that_the_reading_hides_is_listed_once() -> None:
    """The damper stands in place of the force's lag; the mass, which nothing names in place of one, beside it."""
    hidden = (("viscous_damping", "use a finer gauge"), ("inertia", "use a finer gauge"))
    pairs = (("force_lag", "viscous_damping"),)
    explanation = explained_by_sets(("force_lag", 0.0, 1.0), read_instead=pairs, hidden=hidden)
    assert listed(explanation, 0.4) == [("viscous_damping",), ("force_lag", "inertia")]
