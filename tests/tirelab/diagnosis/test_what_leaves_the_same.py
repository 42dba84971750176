"""Causes that make the same force in a motion share the probability of what is said.

Beside a linear spring k x a late gauge, k (x + d v), is a damper of k d; a spring in series with it is a softer one;
and a mass moved at one frequency w is one that is softer by m w^2. No recording of these tells them apart.
"""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from radialtire.part_curve import PartCurve
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.recordings.recording import Recording

STIFFNESS = 2e4
SPRING = TireModel(PowerLaw(STIFFNESS / 100.0, 1.0), tested_range=None, two_sided=True)


FEW = ("recalibration", "series_compliance", "deflection_lag", "viscous_damping", "inertia", "force_offset")
"""Of the catalogue, where the whole of it would take long: the causes in question and two others."""


def test_a_part_that_is_a_curve_has_no_power_law_to_tell() -> None:
    curve = PartCurve((-0.006, 0.006), (-120.0, 120.0))
    part = TireModel(PowerLaw(1e-12, 1.0), tested_range=None, two_sided=True, inflated=False, curve=curve)
    verdict = diagnose([sine(1.0, (-3000.0, 0.0, 0.0), 2)], part, catalogue=["recalibration"])
    assert verdict.names == ("recalibration",)
    (effect,) = verdict.to_dict()["verdict"]["effects"]
    assert effect["law"] == []


def sine(frequency: float, added: tuple[float, float, float], seed: int, noise: float = 0.5) -> Recording:
    """The spring on a sine of 5 mm, 250 samples a second; added: to its stiffness, a damping and a mass [SI]."""
    time = np.arange(0.0, 6.0 / frequency, 0.004)
    w = 2.0 * np.pi * frequency
    x, rate = 0.005 * np.sin(w * time), 0.005 * w * np.cos(w * time)
    stiffness, damping, mass = added
    force = (STIFFNESS + stiffness - mass * w**2) * x + damping * rate
    force += noise * np.random.default_rng(seed).standard_normal(time.size)
    return Recording(f"sine {frequency:g} Hz", time, x, np.full(time.size, np.inf), force)


def stated(verdict: Verdict) -> dict[frozenset[str], float]:
    """The probability of the verdict and of each alternative that leaves the same."""
    others = {frozenset(a.names): a.probability for a in verdict.alternatives if a.same}
    return {frozenset(verdict.names): verdict.confidence, **others}


@pytest.mark.slow
def test_a_damper_and_a_late_gauge_beside_a_linear_spring() -> None:
    sines = [sine(f, (0.0, 200.0, 0.0), i) for i, f in enumerate((0.5, 1.0, 3.0))]
    verdict = diagnose(sines, SPRING, catalogue=FEW)
    found = stated(verdict)
    lag, damping = (found[frozenset({name})] for name in ("deflection_lag", "viscous_damping"))
    assert 0.85 < lag + damping <= 1.0
    assert min(lag, damping) > 0.25
    assert all(e.probability < 0.7 for e in verdict.effects)
    (alternative,) = (a for a in verdict.alternatives if a.same and len(a.names) == 1)
    assert alternative.reason == "their forces are the same in this motion: test the gauges by themselves"
    assert verdict.summary.startswith("Undecided; this is the likeliest explanation. Left out: ")
    details = verdict.to_dict()["verdict"]["alternative_details"]
    assert [d["same"] for d in details][verdict.alternatives.index(alternative)]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("added", "causes"),
    [
        ((-2000.0, 0.0, 0.0), ("series_compliance", "recalibration")),
        ((0.0, 0.0, 5.0), ("series_compliance", "recalibration", "inertia")),
    ],
)
def test_whatever_makes_a_linear_spring_softer_at_one_frequency(
    added: tuple[float, float, float], causes: tuple[str, ...]
) -> None:
    verdict = diagnose([sine(3.0, added, 4)], SPRING)
    found = stated(verdict)
    each = [found[frozenset({cause})] for cause in causes]
    assert min(each) > 0.03
    assert max(each) < 0.85
    assert sum(each) > 0.7


@pytest.mark.slow
def test_of_two_sets_that_leave_the_same_each_is_fitted_with_what_else_is_there() -> None:
    """A softer spring beside a damper: of the four sets of two effects that are one force, three at least."""
    sines = [sine(f, (-2000.0, 200.0, 0.0), i) for i, f in enumerate((0.5, 1.0, 3.0))]
    verdict = diagnose(sines, SPRING, catalogue=FEW)
    pairs = {n for n in stated(verdict) if n & {"deflection_lag", "viscous_damping"}}
    assert len([n for n in pairs if n & {"series_compliance", "recalibration"}]) >= 3
    assert verdict.confidence < 0.6


@pytest.mark.slow
def test_a_damper_is_told_from_a_late_gauge_where_the_stiffness_changes() -> None:
    """On a tire, whose tangent grows with the deflection, a lag makes a loop that grows with it, and a damper none."""
    time = np.arange(0.0, 6.0, 0.004)
    x, rate = 0.01 + 0.008 * np.sin(6.0 * time), 0.048 * np.cos(6.0 * time)
    coefficient, exponent = TireModel().law.coefficients(np.inf)
    force = coefficient * (100.0 * x) ** exponent + 300.0 * rate
    force += np.random.default_rng(1).standard_normal(time.size)
    verdict = diagnose([Recording("ride", time, x, np.full(time.size, np.inf), force)], TireModel())
    assert verdict.names == ("viscous_damping",)
    assert verdict.confidence > 0.9
    assert not any(a.same for a in verdict.alternatives)
