"""What changes at once is told with its moment and its size, and no slow effect is sure in its place."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pytest
from radialtire import TireModel
from tirelab import Recording, diagnose
from tirelab.diagnosis.sudden_change import SuddenChange
from tirelab.diagnosis.verdict import Verdict

NOISE = 3.0
TIME = np.arange(0.0, 80.0, 0.02)
DEFLECTION = 1e-3 * np.interp(TIME % 8.0, [0.0, 4.0, 8.0], [1.0, 17.0, 1.0])
BEHIND = TIME >= 41.0
"""The sixth of ten triangles is on its way in where it changes."""


def law(deflection: np.ndarray) -> np.ndarray:
    A, B = TireModel().law.coefficients(np.inf)
    return np.asarray(A * (100.0 * np.maximum(deflection, 0.0)) ** B)


@dataclass(frozen=True)
class Case:
    """A force [N] that changes at 41 s, the words for it and its size, and the slow effect that would stand for it."""

    force: np.ndarray
    change: str
    size: float
    slow: str


CASES = {
    "tear": Case(
        law(DEFLECTION) * (1.0 - 0.06 * BEHIND), r"the force were (\S+) % less", 6.0, "pressure_leak"
    ),
    "slip": Case(
        law(DEFLECTION - 5e-4 * BEHIND),
        r"the zero of the deflection had moved by (\S+) mm",
        0.5,
        "deflection_drift",
    ),
    "switch": Case(
        law(DEFLECTION) + 30.0 * BEHIND, r"the zero of the force had moved by (\S+) N", 30.0, "force_drift"
    ),
}


def verdict_on(
    force: np.ndarray, catalogue: tuple[str, ...], seed: int = 5, deflection: np.ndarray = DEFLECTION
) -> Verdict:
    noise = np.random.default_rng(seed).normal(0.0, NOISE, TIME.size)
    recording = Recording.from_arrays(TIME, deflection, force + noise, "flat")
    return diagnose([recording], TireModel(), catalogue=catalogue)


@pytest.mark.parametrize("name", CASES)
def test_a_step_is_told_with_its_moment_and_size(name: str) -> None:
    case = CASES[name]
    verdict = verdict_on(case.force, (case.slow, "viscous_damping"))
    found = verdict.contradiction
    assert isinstance(found, SuddenChange)
    told = re.search(case.change, found.finding)
    assert told is not None
    # Two digits are told; the law is fitted again beside it, by a few parts in a hundred of the step.
    assert float(told[1]) == pytest.approx(case.size, rel=0.05)
    # Some of ten samples about it show less than the noise: where the tire is hardly pressed a factor is nothing.
    (moment,) = (float(text.removesuffix(" s")) for text in found.moments)
    assert moment == pytest.approx(41.0, abs=0.2)
    assert verdict.summary.startswith(f"Something changes at once at {found.moments[0]}. It is as if ")
    assert found.without == pytest.approx(NOISE, rel=0.05)
    before, after = (f"FILE@{bounds}" for bounds in (f":{moment:g}s", f"{moment:g}s:"))
    assert found.action.endswith(f"apart, {before} and {after}.")


@pytest.mark.parametrize("name", CASES)
def test_no_slow_effect_is_surer_than_either_beside_a_step(name: str) -> None:
    case = CASES[name]
    verdict = verdict_on(case.force, (case.slow, "viscous_damping"))
    assert all(e.probability <= 0.5 for e in verdict.effects)
    found = verdict.to_dict()["verdict"]["contradiction"]
    assert isinstance(verdict.contradiction, SuddenChange)
    assert found["slow"] == list(verdict.contradiction.slow)
    assert set(found["slow"]) <= {case.slow}


SLOW = {
    "pressure_leak": law(DEFLECTION) * np.exp(-0.1 * TIME / TIME[-1]),
    "deflection_drift": law(DEFLECTION - 6e-4 * TIME / TIME[-1]),
    "a curve of its own": law(DEFLECTION) * (1.0 - 0.1 * (TIME / TIME[-1]) ** 2),
    "swings": law(DEFLECTION) + 30.0 * np.sin(2.0 * np.pi * TIME / 31.0),
    "a first loading": law(DEFLECTION) * (1.0 - 0.08 * (TIME > 4.0)),
}
"""What changes slowly, in forms that the catalogue has and lacks; the first loading of a part is no step either."""


@pytest.mark.parametrize("name", SLOW)
def test_what_changes_slowly_does_not_change_at_once(name: str) -> None:
    verdict = verdict_on(SLOW[name], ("pressure_leak", "deflection_drift", "viscous_damping"))
    assert verdict.contradiction is None


def test_two_steps_are_two_moments() -> None:
    force = law(DEFLECTION) * (1.0 - 0.06 * (TIME > 21.0) - 0.06 * (TIME > 57.0))
    found = verdict_on(force, ("pressure_leak", "viscous_damping")).contradiction
    assert isinstance(found, SuddenChange)
    moments = sorted(float(m.removesuffix(" s")) for m in found.moments)
    assert moments == pytest.approx([21.0, 57.0], abs=0.3)
    assert f"and again at {found.moments[1]}" in found.finding


def test_beside_an_effect_that_is_there_both_are_told() -> None:
    """A damper of 800 N s/m at 40 mm/s is 32 N; no step replaces it, and the largest one is at its moment."""
    time = TIME / 10.0
    rate = np.gradient(DEFLECTION, time)
    noise = np.random.default_rng(6).normal(0.0, NOISE, TIME.size)
    force = law(DEFLECTION) * (1.0 - 0.06 * BEHIND) + 800.0 * rate + noise
    recording = Recording.from_arrays(time, DEFLECTION, force, "flat")
    verdict = diagnose([recording], TireModel(), catalogue=("pressure_leak", "viscous_damping"))
    found = verdict.contradiction
    assert isinstance(found, SuddenChange)
    assert found.moments[0].startswith("4.")
    sure = {e.name: e.probability for e in verdict.effects}
    assert sure["viscous_damping"] > 0.9


def test_the_first_loading_to_a_deflection_is_no_step() -> None:
    """From 40 s on the triangles go twice as far; what is loaded for the first time bears a tenth more."""
    deflection = DEFLECTION * np.where(TIME < 40.0, 0.5, 1.0)
    first = (TIME < 4.0) | ((TIME >= 40.0) & (TIME < 44.0))
    force = law(deflection) * np.where(first, 1.1, 1.0)
    found = verdict_on(force, ("pressure_leak", "viscous_damping"), deflection=deflection).contradiction
    assert not isinstance(found, SuddenChange)
