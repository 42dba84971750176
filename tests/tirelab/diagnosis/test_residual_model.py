"""The regression of an unexplained residual over one coordinate.

A recording of another tire among others is named.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import flat_force, read, ride
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.acceptance import HeldOut, Part
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.localization import Span
from tirelab.diagnosis.residual_model import residual_models, unexplained_by
from tirelab.estimation.findings import Remainder
from tirelab.preprocessing.samples import raw_dataset_of
from tirelab.recordings.recording import Recording

LEVEL = 5.0


def regressed(by: str, force, seed: int = 3):
    """Regress `force`(time, deflection) under noise over a coordinate; the last third is held out."""
    time, deflection, _ = ride(seed)
    own = force(time, deflection) + LEVEL * np.random.default_rng(1).standard_normal(time.size)
    dataset = raw_dataset_of([read("ride", time, deflection, flat_force(deflection), seed)], TireModel())
    kept = time < 20.0
    (experiment,) = dataset.experiments
    parts = [(Part(experiment, own, own, own, chosen),) for chosen in (kept, ~kept)]
    (found,) = residual_models((by,), dataset, [own], HeldOut("time block 20-30 s", *parts))
    return found


def test_a_force_over_the_deflection_is_found_and_repeats():
    found = regressed("deflection", lambda t, x: 25.0 * np.sin(2.0 * np.pi * x / 0.007))
    # 25 / sqrt(2) = 17.7 N under 5 N of noise: R^2 is 1 - 25 / (25 + 312) = 0.926 at best.
    assert 0.90 < found.r2 < 0.93
    assert found.unit == "m"
    middle = (found.at > 0.006) & (found.at < 0.017)
    true = 25.0 * np.sin(2.0 * np.pi * found.at[middle] / 0.007)
    assert np.abs(found.force[middle] - true).max() < 4.0
    # The noise is left on fitted and on held-out data.
    assert found.after == pytest.approx(LEVEL, rel=0.03)
    assert found.held_out_after == pytest.approx(LEVEL, rel=0.06)


def test_noise_does_not_repeat():
    found = regressed("deflection", lambda t, x: 0.0 * t)
    assert found.r2 < 0.01
    assert found.held_out_after > found.after


def test_a_coordinate_without_a_name_is_time():
    found = regressed("jump", lambda t, x: np.where(t > 12.0, 20.0, 0.0))
    assert found.unit == "s"
    assert found.force[found.at < 10.0] == pytest.approx(0.0, abs=3.0)
    assert found.force[found.at > 14.0] == pytest.approx(20.0, abs=3.0)


def place(by: str = "time", share: float = 0.8, size: float = 3.0) -> Span:
    return Span(by, 1.0, 2.0, "s", "", None, share, 0.01, 9.0, size, 1e-9, 0.5)


def test_what_is_short_is_unexplained_where_it_is_more_than_the_noise() -> None:
    small = Remainder(1.0, 0.4, 2.0, ())
    assert not small.unexplained
    assert unexplained_by(small, [place(), place("history"), place("force", share=0.3)]) == ("time", "force")
    assert unexplained_by(small, []) == ()
    assert unexplained_by(small, [place(size=0.9), place(share=0.09)]) == ()
    # Of a misfit that effects explain but for a tenth, no place holds a tenth.
    assert unexplained_by(replace(small, share=0.1), [place()]) == ()


def test_the_entry_of_diagnosis_json_keeps_its_keys():
    entry = regressed("rate", lambda t, x: 0.0 * t).to_dict()
    assert list(entry) == ["by", "unit", "repeats", "after", "held_out_after", "at", "force"]
    assert entry["unit"] == "m/s"


@pytest.mark.parametrize(
    ("by", "unit"),
    [("deflection", "m"), ("rate", "m/s"), ("acceleration", "m/s^2"), ("time", "s"), ("force", "N")],
)
def test_every_coordinate_of_a_remainder_is_regressed_over_itself(by: str, unit: str) -> None:
    assert regressed(by, lambda t, x: 0.0 * t).unit == unit


TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)


FEW = ("recalibration", "viscous_damping")
"""Recordings contradict each other whatever else is looked for."""


def pressed(name: str, coefficient: float, seed: int) -> Recording:
    """Three cycles on the flat of a tire F = A x^1.42, with 4 N of noise."""
    time = np.linspace(0.0, 60.0, 900)
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * time / 20.0))
    noise = np.random.default_rng(seed).normal(0.0, 4.0, time.size)
    return Recording(name, time, x, np.full(time.size, np.inf), coefficient * (100.0 * x) ** 1.42 + noise)


def test_the_one_of_another_tire_is_named() -> None:
    several = [pressed("a", 550.0, 1), pressed("b", 550.0, 2), pressed("soft", 440.0, 3)]
    summary = diagnose(several, TIRE, catalogue=FEW).summary
    assert "Recording soft contradicts the others" in summary
    # A fifth of 550 x^1.42 at up to 2.2 cm: a root mean square of about 160 N.
    assert "it is 1" in summary


def test_of_two_nobody_can_tell_which() -> None:
    several = [pressed("a", 550.0, 1), pressed("soft", 440.0, 3)]
    summary = diagnose(several, TIRE, catalogue=FEW).summary
    assert "Recordings a and soft contradict each other" in summary


@pytest.mark.parametrize("coefficient", [550.0, 440.0])
def test_recordings_of_one_tire_do_not_contradict_each_other(coefficient: float) -> None:
    several = [pressed("a", coefficient, 1), pressed("b", coefficient, 2)]
    assert "contradict" not in diagnose(several, TIRE, catalogue=FEW).summary
