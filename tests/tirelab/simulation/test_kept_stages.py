"""Stages that are kept give the forces of a simulation from the start, to the last bit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from drives import ride
from radialtire import CATALOGUE, Effect, PowerLaw, TireModel
from radialtire.learned_remainder import LearnedRemainder
from tirelab.simulation import kept_stages
from tirelab.simulation import simulate as stages_of
from tirelab.simulation.kept_stages import KeptStages
from tirelab.simulation.simulate import SmoothedMotion, simulate

TIME, X, RATE = ride(4, samples=800)
MOTION = SmoothedMotion(TIME, X, np.full(TIME.size, np.inf), RATE, np.gradient(RATE, TIME))


def moved(tire: TireModel, rng: np.random.Generator) -> TireModel:
    """Return a tire that differs in one effect, in its law, or in whether it is held at both ends."""
    which = rng.integers(4)
    if which == 0 and tire.effects:
        return replace(tire, effects=tire.effects[1:])
    if which == 1:
        return replace(tire, law=PowerLaw(rng.uniform(300.0, 900.0), rng.uniform(1.1, 1.8)))
    if which == 2:
        return replace(tire, two_sided=not tire.two_sided)
    effect = CATALOGUE[str(rng.choice(list(CATALOGUE)))]
    drawn = [(p, float(p.nominal_value * rng.uniform(0.3, 3.0))) for p in effect.parameters]
    values = tuple(min(max(p.minimum, value), p.maximum) for p, value in drawn)
    own = {e.name: (e, v) for e, v in tire.effects} | {effect.name: (effect, values)}
    return replace(tire, effects=tuple(own[name] for name in CATALOGUE if name in own))


@pytest.mark.parametrize("most", [64, 2])
def test_they_give_the_force_of_the_simulation(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_stages, "KEPT", most)
    stages = KeptStages(MOTION)
    rng = np.random.default_rng(5)
    walk = [TireModel()]
    for _ in range(60):
        walk.append(moved(walk[-1], rng))
    for tire in [*walk, *reversed(walk)]:
        np.testing.assert_array_equal(stages.simulate(tire), simulate(tire, MOTION, MOTION))


def effects_run(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the list to which the name of every effect is added that is run from now on."""
    run: list[str] = []
    respond = stages_of.respond_series

    def counted(effect: Effect, *rest: Any) -> Any:
        run.append(effect.name)
        return respond(effect, *rest)

    monkeypatch.setattr(stages_of, "respond_series", counted)
    return run


def test_factors_and_what_is_added_do_not_depend_on_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two factors and a damper only the one that changes is run, and friction with it, which needs their force."""
    stages, run = KeptStages(MOTION), effects_run(monkeypatch)
    names = ("mullins_softening", "warm_up", "rate_independent_hysteresis", "viscous_damping")
    first = [(CATALOGUE[n], CATALOGUE[n].nominal) for n in names]
    stages.simulate(TireModel(effects=tuple(first)))
    assert run == list(names)
    for changed, expected in ((1, [names[1], names[2]]), (3, [names[3]])):
        run.clear()
        effect, values = first[changed]
        own = [*first[:changed], (effect, (1.1 * values[0], *values[1:])), *first[changed + 1 :]]
        stages.simulate(TireModel(effects=tuple(own)))
        assert run == expected


def test_beside_another_law_only_what_needs_its_force_is_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    stages, run = KeptStages(MOTION), effects_run(monkeypatch)
    names = ("rate_independent_hysteresis", "viscous_damping", "force_drift")
    effects = tuple((CATALOGUE[n], CATALOGUE[n].nominal) for n in names)
    first = TireModel(effects=effects)
    stages.simulate(first)
    run.clear()
    stages.simulate(replace(first, law=PowerLaw(500.0, 1.5)))
    assert run[0] == names[0]
    assert names[1] not in run


def test_what_lies_upstream_is_not_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    stages, run = KeptStages(MOTION), effects_run(monkeypatch)
    friction, inertia = CATALOGUE["rate_independent_hysteresis"], CATALOGUE["inertia"]

    def tire(slip: float, mass: float) -> TireModel:
        own = (slip, *(p.start for p in friction.parameters[1:]))
        return TireModel(
            effects=((friction, own), (inertia, (mass, *(p.start for p in inertia.parameters[1:]))))
        )

    for values in ((20.0, 0.5), (20.0, 0.6), (21.0, 0.6), (20.0, 0.5)):
        stages.simulate(tire(*values))
    assert run == [friction.name, inertia.name, inertia.name, friction.name, inertia.name]


def test_a_learned_remainder_is_added_as_the_simulation_adds_it() -> None:
    learned = LearnedRemainder("deflection", (0.0, 0.01, 0.02), (0.0, 30.0, -10.0))
    tire = TireModel(remainder=learned)
    np.testing.assert_array_equal(KeptStages(MOTION).simulate(tire), simulate(tire, MOTION, MOTION))
