"""Which sets stand beside the verdict, and what the recordings are said to lack."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from drives import damped, flat_force, read, triangle
from radialtire import TireModel
from tirelab.diagnosis.alternatives import (
    CREDIBLE,
    alternatives_of,
    confidence_of,
    insufficient_excitation,
    reason_of,
)
from tirelab.estimation.findings import Evidence
from tirelab.preprocessing.dataset import Dataset, dataset_of

RIDE = dataset_of([damped(1, samples=2000)], TireModel())
LOOP, DAMPING = ("rate_independent_hysteresis",), ("viscous_damping",)


def explained(*sets: tuple[str, float, float], **more: Any) -> Any:
    """Return an explanation by hand of sets (names, log evidence, probability), the first the verdict if not said."""
    evidence = tuple(Evidence(tuple(n.split()), log, 1.0, (), p) for n, log, p in sets)
    names = tuple(more.get("verdict", sets[0][0]).split())
    return SimpleNamespace(
        evidence=evidence,
        probability=next(e.probability for e in evidence if e.names == names),
        model=SimpleNamespace(names=names),
        confounded=more.get("confounded", ()),
        hidden=more.get("hidden", ()),
        excitation=SimpleNamespace(one_speed=more.get("one_speed", False)),
    )


def listed(explanation: Any, dataset: Dataset = RIDE) -> list[tuple[str, ...]]:
    return [a.names for a in alternatives_of(explanation, dataset)]


SETS = (("inertia", 0.0, 0.6), ("force_lag", -1.4, 0.3), ("saturation", -4.0, 0.08), ("", -7.0, 0.02))


def test_verdict_and_alternatives_hold_the_promised_probability_and_no_more_sets_are_listed() -> None:
    explanation = explained(*SETS)
    found = alternatives_of(explanation, RIDE)
    assert [a.names for a in found] == [("force_lag",), ("saturation",)]
    assert explanation.probability + sum(a.probability for a in found) >= CREDIBLE


def test_a_sure_verdict_has_no_alternatives() -> None:
    assert listed(explained(("inertia", 0.0, 0.999), ("force_lag", -14.0, 0.001))) == []


def test_an_effect_that_the_motion_cannot_tell_apart_comes_first_however_unlikely_it_is() -> None:
    explanation = explained(
        ("viscous_damping", 0.0, 0.9),
        ("inertia", -4.0, 0.099),
        ("rate_independent_hysteresis", -13.0, 0.001),
        confounded=(LOOP,),
        one_speed=True,
    )
    assert listed(explanation) == [LOOP, ("inertia",)]
    # Two sets that nothing in the recordings tells apart: neither is more likely than not.
    assert confidence_of(explanation) == pytest.approx(0.45)
    assert confidence_of(explained(*SETS)) == 0.6


def test_an_effect_that_the_excitation_cannot_show_stands_beside_the_verdict_with_the_reason() -> None:
    why = "the recording has no time"
    (found,) = alternatives_of(explained(("inertia", 0.0, 1.0), hidden=(("warm_up", why),)), RIDE)
    assert set(found.names) == {"inertia", "warm_up"}
    assert found.reason == why


def test_the_log_odds_are_those_of_the_verdict_that_is_delivered() -> None:
    """The likeliest set was refused: e^3 to 1 against the verdict."""
    explanation = explained(("inertia", 0.0, 0.9), ("", -3.0, 0.05), ("force_lag", -3.5, 0.05), verdict="")
    found = {a.names: a.log_odds for a in alternatives_of(explanation, RIDE)}
    assert found[("inertia",)] == pytest.approx(-3.0)
    assert found[("force_lag",)] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("one", "other", "said"),
    [
        (("recalibration",), ("gas_compression",), "repeat at a second pressure (2 bar, say)"),
        (("warm_up",), ("pressure_leak",), "repeat the first cycle after a rest"),
        (LOOP, DAMPING, "one speed only: repeat at "),
    ],
)
def test_the_reason_is_what_to_record(one: tuple[str, ...], other: tuple[str, ...], said: str) -> None:
    assert said in reason_of(one, other, explained((" ".join(one), 0.0, 1.0), one_speed=True), RIDE)


def test_holds_surfaces_and_cycles_that_are_missing_are_named() -> None:
    time, deflection = triangle(samples=180)
    press = dataset_of([read("press", time, deflection, flat_force(deflection), 4)], TireModel())
    said = "; ".join(insufficient_excitation(explained(("inertia", 0.0, 1.0)), press))
    for words in ("press on a second surface", "hold 10 s at 15 mm", "drive each cycle twice"):
        assert words in said
