"""A recording of another tire, or with another zero, among others is named; what is only driven otherwise is not."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.contradiction import Contradiction, driven
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.recordings.recording import Recording

TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)

FEW = ("recalibration", "viscous_damping")
"""Recordings contradict each other whatever else is looked for."""

NOISE = 4.0


def pressed(
    name: str, seed: int, A: float = 550.0, *, zero: float = 0.0, damping: float = 0.0, period: float = 20.0
) -> Recording:
    """Three cycles on the flat of a tire F = A x^1.42, A in N/cm^1.42, with NOISE.

    zero [m]: of the deflection's gauge; damping [N s/m]; period [s]: of a cycle
    """
    time = np.linspace(0.0, 3.0 * period, 900)
    phase = 2.0 * np.pi * time / period
    x = 0.011 * (1.0 - np.cos(phase))
    rate = 0.011 * 2.0 * np.pi / period * np.sin(phase)
    force = A * (100.0 * np.maximum(x - zero, 0.0)) ** 1.42 + damping * rate
    force += np.random.default_rng(seed).normal(0.0, NOISE, time.size)
    return Recording(name, time, x, np.full(time.size, np.inf), force)


def verdict_on(*several: Recording) -> Verdict:
    return diagnose(several, TIRE, catalogue=FEW)


def test_the_one_of_another_tire_is_named_first() -> None:
    verdict = verdict_on(pressed("a", 1), pressed("b", 2), pressed("soft", 3, 440.0))
    assert verdict.summary.startswith(
        "Recording soft contradicts the others. The baseline explains the others to"
    )
    found = verdict.contradiction
    assert found is not None
    assert (found.names, found.effects) == (("soft",), ())
    # A fifth of 550 x^1.42 with x = 1.1 cm (1 - cos): the mean of (1 - cos)^p is 2^p gamma(p + 1/2) / sqrt(pi) p!.
    p = 2.0 * 1.42
    mean = 2.0**p * math.gamma(p + 0.5) / (math.sqrt(math.pi) * math.gamma(p + 1.0))
    assert found.own == pytest.approx(110.0 * 1.1**1.42 * math.sqrt(mean), rel=0.02)
    assert found.without == pytest.approx(NOISE, rel=0.1)
    assert found.as_if == "It is as if the force of soft were 20 % less, by another pressure or tire."


@pytest.mark.slow
def test_of_two_nobody_can_tell_which() -> None:
    verdict = verdict_on(pressed("a", 1), pressed("soft", 3, 440.0))
    assert verdict.summary.startswith("Recordings a and soft contradict each other.")


@pytest.mark.slow
def test_a_force_with_another_zero_is_told() -> None:
    r = pressed("b", 2)
    shifted = Recording("b", r.time, r.deflection, r.surface_radius, r.force + 60.0)
    found = verdict_on(pressed("a", 1), shifted, pressed("c", 3)).contradiction
    assert found is not None
    # 60 N, known to 4 N / sqrt(900)
    assert found.as_if.startswith(
        ("It is as if the zero of the force of b were 59.", "It is as if the zero of the force of b were 60.")
    )


@pytest.mark.parametrize("damping", [0.0, pytest.param(1e4, marks=pytest.mark.slow)])
def test_the_one_with_another_zero_is_named_and_what_explains_the_others(damping: float) -> None:
    """None of the sets that explain all of them need explain the others: the baseline does, or damping alone."""
    own = {"damping": damping}
    verdict = verdict_on(
        pressed("a", 1, **own), pressed("b", 2, zero=0.001, **own), pressed("c", 3, period=35.0, **own)
    )
    found = verdict.contradiction
    assert found is not None
    assert found.names == ("b",)
    assert found.effects == (("viscous_damping",) if damping else ())
    # A tire that is not in contact for the first of 22 mm is not one that is shifted by it: 1 mm within a percent.
    assert "as if the zero of the deflection of b were 1.0" in found.as_if


@pytest.mark.slow
@pytest.mark.parametrize("coefficient", [550.0, 440.0])
def test_recordings_of_one_tire_do_not_contradict_each_other(coefficient: float) -> None:
    assert verdict_on(pressed("a", 1, coefficient), pressed("b", 2, coefficient)).contradiction is None


@pytest.mark.slow
def test_what_no_effect_explains_in_all_of_them_is_no_contradiction() -> None:
    several = []
    for name, seed in (("a", 1), ("b", 2), ("c", 3)):
        r = pressed(name, seed)
        ripple = 30.0 * np.sin(2.0 * np.pi * r.deflection / 0.003)
        several.append(Recording(name, r.time, r.deflection, r.surface_radius, r.force + ripple))
    verdict = verdict_on(*several)
    assert verdict.unexplained
    assert verdict.contradiction is None


@pytest.mark.slow
def test_a_recording_that_is_driven_otherwise_contradicts_nothing() -> None:
    """Something that no effect of the catalogue explains may show at another speed alone."""
    quick = pressed("quick", 3, period=2.0)
    force = quick.force + 150.0 * np.sin(2.0 * np.pi * quick.time / 0.37)
    quick = Recording("quick", quick.time, quick.deflection, quick.surface_radius, force)
    verdict = verdict_on(pressed("a", 1), pressed("b", 2), quick)
    assert verdict.unexplained
    assert verdict.contradiction is None


def test_its_message_says_what_to_do() -> None:
    one = Contradiction(("b",), ("viscous_damping",), 2.0, 118.7)
    assert one.sentences == (
        "Recording b contradicts the others. Viscous damping explains the others to 2.00 N and misses b by 119 N where "
        "it is driven as they are. Check tire, pressure and zero of each, and what it had been through, or diagnose b "
        "apart."
    )
    several = Contradiction(("b",), ("viscous_damping", "inertia"), 2.0, 118.7)
    assert several.finding.startswith(
        "Viscous damping and inertia explain the others to 2.00 N and miss b by 119 N"
    )
    two = Contradiction(("a", "b"), (), 2.0, 118.7)
    assert two.sentences == (
        "Recordings a and b contradict each other. The baseline explains one to 2.00 N and misses the other by 119 N "
        "where they are driven alike. Check tire, pressure and zero of each, and what it had been through, or diagnose "
        "them apart."
    )
    assert two.to_dict()["recordings"] == ["a", "b"]
    assert replace(one, inflated=False).action == (
        "Check part and zero of each, and what it had been through, or diagnose b apart."
    )


def test_a_verdict_that_names_nothing_is_sure_that_nothing_explains_all_of_them() -> None:
    found = Contradiction(("b",), ("viscous_damping",), 2.0, 118.7)
    assert found.question == "That one explanation holds for all of them"
    assert not found.is_all
    unnamed = replace(found, named=False)
    assert unnamed.question == "That no known effect explains all of them"
    assert unnamed.is_all
    # What is said of the fitted recordings holds whatever a held-out one does.
    assert replace(unnamed, held_out=True).question == "That it holds for the fitted ones"
    assert not replace(unnamed, held_out=True).is_all


def test_where_several_zeros_are_all_there_is_the_summary_speaks_of_nothing_else() -> None:
    plain = pressed("a", 1), pressed("b", 2), pressed("c", 3)
    shifts = (-40.0, 0.0, 40.0)
    verdict = verdict_on(*(replace(r, force=r.force + shift) for r, shift in zip(plain, shifts, strict=True)))
    assert verdict.contradiction is not None
    assert verdict.names == ("unknown",)
    assert "That no known effect explains all of them" in verdict.summary
    assert "Something is missing" not in verdict.summary
    assert "cannot rule out" not in verdict.summary


@pytest.mark.slow
def test_of_parts_without_air_no_pressure_is_spoken_of() -> None:
    spring = TireModel(PowerLaw(550.0, 1.42), tested_range=None, inflated=False)
    found = diagnose(
        [pressed("a", 1), pressed("b", 2), pressed("soft", 3, 440.0)], spring, catalogue=FEW
    ).contradiction
    assert found is not None
    assert found.as_if == "It is as if the force of soft were 20 % less, by another part."
    assert found.action.startswith("Check part and zero of each,")


def test_a_held_out_recording_of_another_tire_is_named_where_it_refuses_the_law() -> None:
    """600 N/cm^B fitted and 500 held out, of a baseline of 550: a law for the first is twice as far off the second.

    Against the first, the second has a sixth less force.
    """
    verdict = diagnose([pressed("a", 1, 600.0)], TIRE, held_out=[pressed("other", 2, 500.0)], catalogue=FEW)
    assert verdict.effects == ()
    found = verdict.contradiction
    assert found is not None
    assert (found.names, found.effects) == (("other",), ("recalibration",))
    assert found.without == pytest.approx(NOISE, rel=0.1)
    assert found.as_if == "It is as if the force of other were 17 % less, by another pressure or tire."
    assert verdict.summary.startswith("Recording other contradicts a.")


def test_two_ranges_of_one_file_have_one_specimen_and_its_gauges() -> None:
    """A tenth of the force is lost between them: no other zero or part is to be looked for."""
    fitted = replace(pressed("a@0s-60s", 1), source=Path("a.csv"))
    later = pressed("a@60s-120s", 2, 495.0)
    kept = replace(later, time=later.time + 120.0, source=Path("a.csv"), history=fitted)
    found = diagnose([fitted], TIRE, held_out=[kept], catalogue=FEW).contradiction
    assert found is not None
    assert found.headline == "Recording a@60s-120s contradicts a@0s-60s"
    assert found.action == (
        "Look for what slipped, yielded, cracked or drifted between them, or diagnose a@60s-120s apart."
    )
    trial = replace(kept, history=None)  # trials that stand in one file may be of other specimens
    apart = diagnose([fitted], TIRE, held_out=[trial], catalogue=FEW).contradiction
    assert apart is not None
    assert apart.action.startswith("Check tire, pressure and zero of each")


def test_a_held_out_recording_that_begins_in_motion_does_not_contradict_the_one_it_was_cut_from() -> None:
    """A tire that is driven at 2 Hz over a damper; the last half, whose first rates nothing tells."""
    whole = pressed("a", 1, damping=2e4, period=0.5)
    half = slice(450, None)
    cut = [getattr(whole, name)[half] for name in ("time", "deflection", "surface_radius", "force")]
    verdict = diagnose([whole], TIRE, held_out=[Recording("cut", *cut)], catalogue=FEW)
    assert [e.name for e in verdict.effects] == ["viscous_damping"]
    assert verdict.contradiction is None


def test_a_held_out_recording_of_another_tire_is_named_where_nothing_was_refused() -> None:
    """The fitted recording is that of the baseline; another tire of 500 N/cm^B is held out, a tenth less force."""
    verdict = diagnose([pressed("a", 1, 550.0)], TIRE, held_out=[pressed("other", 2, 495.0)], catalogue=FEW)
    assert verdict.effects == ()
    assert verdict.contradiction is not None
    assert verdict.contradiction.names == ("other",)
    assert (
        verdict.contradiction.as_if
        == "It is as if the force of other were 10 % less, by another pressure or tire."
    )


def test_a_held_out_recording_that_no_zero_and_no_factor_reconciles_is_not_named() -> None:
    """A correction for 3000 N s/m refused by a recording of 1000: neither a zero nor a factor makes a damper."""
    fitted, kept = pressed("a", 1, damping=3000.0, period=2.0), pressed("b", 2, damping=1000.0, period=2.0)
    verdict = diagnose([fitted], TIRE, held_out=[kept], catalogue=FEW)
    assert verdict.contradiction is None


def test_a_held_out_recording_of_another_part_has_another_zero_and_another_stiffness() -> None:
    """4 mm nearer and 30 % softer: neither alone explains half of it, both together all but the noise."""
    verdict = diagnose(
        [pressed("a", 1), pressed("b", 2)],
        TIRE,
        held_out=[pressed("other", 3, 385.0, zero=-4e-3)],
        catalogue=FEW,
    )
    assert verdict.contradiction is not None
    assert verdict.contradiction.names == ("other",)
    assert verdict.contradiction.as_if.startswith("It is as if the zero of the deflection of other were 4.0")
    assert verdict.contradiction.as_if.endswith(" mm off and its force 30 % less.")


def test_no_factor_turns_a_force_round() -> None:
    """A part that is driven beyond the resonance of its mass: its force has the other sign, which no other part has."""
    part = TireModel(PowerLaw(550.0, 1.42), tested_range=None, two_sided=True, inflated=False)
    turned = pressed("turned", 2)
    verdict = diagnose(
        [pressed("a", 1)], part, held_out=[replace(turned, force=-0.6 * turned.force)], catalogue=FEW
    )
    assert verdict.contradiction is None or "less" not in verdict.contradiction.as_if


@pytest.mark.slow
def test_a_held_out_recording_that_refuses_one_of_two_effects_is_named() -> None:
    """The dampers of both are alike and found. The law is 5 % more than believed in one and 5 % less in the other."""
    fitted, kept = (
        pressed(name, seed, A, damping=3000.0, period=2.0)
        for name, seed, A in (("a", 1, 575.0), ("other", 2, 525.0))
    )
    verdict = diagnose([fitted], TIRE, held_out=[kept], catalogue=FEW)
    assert [e.name for e in verdict.effects] == ["viscous_damping"]
    found = verdict.contradiction
    assert found is not None
    assert (found.names, set(found.effects)) == (("other",), {"recalibration", "viscous_damping"})
    # 525 of 575 is 8.7 % less.
    assert "the force of other were 8." in found.as_if
    assert verdict.summary.startswith("Recording other contradicts a.")


@pytest.mark.slow
def test_what_lies_deeper_than_the_others_reached_contradicts_nothing() -> None:
    """One pull, 550 N/cm^1.42 as far as it is fitted, to 24 mm, and a tenth stiffer beyond: nothing else showed that.

    The fitted part ends within one of the 24 parts of the deflection's span in which samples are compared.
    """
    time = np.linspace(0.0, 200.0, 2000)
    x = 2e-4 * time
    force = 550.0 * (100.0 * x) ** 1.42 * np.where(x > 0.024, 1.1, 1.0)
    force += np.random.default_rng(5).normal(0.0, NOISE, time.size)
    begun = x <= 0.024
    first, rest = (
        Recording(name, time[own], x[own], np.full(own.sum(), np.inf), force[own])
        for name, own in (("first", begun), ("rest", ~begun))
    )
    assert diagnose([first], TIRE, held_out=[rest], catalogue=FEW).contradiction is None


def test_the_rest_of_a_way_that_the_fitted_part_began_is_not_driven_alike() -> None:
    """Drawn to 24 mm and released to 23.5 mm: from there on another state of the part comes, though in the same class
    of deflections (1 mm), which was passed on the way out.
    """
    time = np.arange(0.0, 20.0, 0.01)
    x = np.interp(time, [0.0, 10.0, 20.0], [0.0, 24e-3, 14e-3])
    flat, force = np.full(time.size, np.inf), 1e5 * x
    at = int(np.argmin(np.abs(time - 10.5)))
    fitted, rest = (
        Recording(name, time[part], x[part], flat[part], force[part])
        for name, part in (("drawn", slice(0, at)), ("rest", slice(at, None)))
    )
    (found,) = driven([fitted], [rest])
    # A few samples at the end that both share are one place by the smoothing of the motion.
    assert found.alike.sum() < 10
    assert found.otherwise.mean() > 0.9
