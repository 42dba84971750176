"""A held-out recording that is driven otherwise, and shows what the fitted ones do not, is named."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.missed import Missed
from tirelab.diagnosis.verdict import Verdict
from tirelab.recordings.recording import Recording
from tirelab.report import first_screen

TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)
FEW = ("recalibration", "viscous_damping")
NOISE = 4.0
RIPPLE = 150.0


def driven(
    name: str,
    period: float,
    *,
    ripple: float = 0.0,
    damping: float = 0.0,
    power: float = 1.0,
    deep: float = 1.0,
) -> Recording:
    """Three cycles of a tire F = 550 x^1.42 to 22 mm times `deep`.

    ripple [N]: of a sine of 0.37 s, which no effect is; damping [N]: at the largest rate of a cycle of 2 s, where the
    force goes with this power of the rate
    """
    time = np.linspace(0.0, 3.0 * period, 900)
    phase = 2.0 * np.pi * time / period
    x = 0.011 * deep * (1.0 - np.cos(phase))
    rate = 2.0 / period * np.sin(phase)
    force = 550.0 * (100.0 * x) ** 1.42 + ripple * np.sin(2.0 * np.pi * time / 0.37)
    force += damping * np.sign(rate) * np.abs(rate) ** power
    force += np.random.default_rng(round(100 * period)).normal(0.0, NOISE, time.size)
    return Recording(name, time, x, np.full(time.size, np.inf), force)


def judged(kept: Recording, *fitted: Recording) -> Verdict:
    return diagnose(fitted, TIRE, held_out=[kept], catalogue=FEW)


@pytest.mark.slow
def test_what_shows_at_another_speed_alone_leaves_the_verdict_open() -> None:
    slow = driven("slow", 20.0), driven("slower", 40.0)
    verdict = judged(driven("quick", 2.0, ripple=RIPPLE), *slow)
    found = verdict.contradiction
    assert isinstance(found, Missed)
    assert found.headline == "Recording quick shows what the fitted ones do not"
    assert (found.names, found.effects) == (("quick",), ())
    assert found.without == pytest.approx(NOISE, rel=0.1)
    # Where the speeds are alike (at the ends of the cycles) it does not count; elsewhere the sine and the noise show.
    assert found.own == pytest.approx(np.hypot(RIPPLE / np.sqrt(2.0), NOISE), rel=0.1)
    assert verdict.effects == ()
    assert verdict.confidence <= 0.5
    assert judged(driven("quick", 2.0), *slow).contradiction is None
    assert judged(driven("quick", 2.0), *slow).confidence > 0.8


def test_what_is_explained_in_a_form_of_its_own_is_not_missed() -> None:
    """A damper in proportion to the rate is fitted; the held-out one, ten times as fast, goes with its power 0.9."""
    kept = driven("quick", 0.5, damping=300.0, power=0.9)
    verdict = judged(kept, driven("a", 2.0, damping=300.0), driven("b", 5.0, damping=300.0))
    assert [e.name for e in verdict.effects] == ["viscous_damping"]
    assert verdict.contradiction is None


def test_what_lies_deeper_than_the_fitted_ones_is_not_missed() -> None:
    """Another law beyond 22 mm, where nothing was fitted; at the same speeds and at others."""
    kept = driven("deep", 2.0, deep=1.5)
    beyond = kept.deflection > 0.022
    force = kept.force + np.where(beyond, 200.0, 0.0)
    deep = Recording("deep", kept.time, kept.deflection, kept.surface_radius, force)
    assert judged(deep, driven("slow", 20.0)).contradiction is None


def test_its_message_says_what_the_confidence_is_of_and_what_to_do() -> None:
    one = Missed(("quick",), (), 0.1, 6.01, other="slow", inflated=False, held_out=True)
    assert one.sentences == (
        "Recording quick shows what slow does not. The baseline explains slow to 0.100 N and misses quick by 6.01 N, "
        "at deflections that were fitted but where it is driven otherwise, as in speed or direction. Fit quick too: "
        "diagnose them together. If nothing explains them, check part and zero of each."
    )
    verdict = {"contradiction": one.to_dict(), "confidence": 0.5}
    assert first_screen.sureness(verdict) == "That this is all that acts: 50 %"
    assert one.to_dict()["caution"] == "What is said here is of the fitted recordings alone."
    two = Missed(("quick",), ("viscous_damping", "inertia"), 2.0, 60.0, held_out=True)
    assert two.finding.startswith(
        "Viscous damping and inertia explain the fitted ones to 2.00 N and miss quick by 60.0 N"
    )
