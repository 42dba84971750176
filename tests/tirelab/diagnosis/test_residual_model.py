"""The regression of an unexplained residual over one coordinate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import flat_force, read, ride
from radialtire import TireModel
from tirelab.diagnosis.held_out import HeldOut, Part
from tirelab.diagnosis.localization import Span
from tirelab.diagnosis.residual_model import residual_models, unexplained_by
from tirelab.estimation.findings import Remainder
from tirelab.preprocessing.samples import raw_dataset_of

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


def over_a_ramp(times: int):
    """Regress a ripple over the deflection of a ramp that is driven so many times."""
    time = np.arange(6000) * 0.005
    deflection = 0.02 * (times * time / 30.0 % 1.0)
    own = 25.0 * np.sin(2.0 * np.pi * deflection / 0.007) + np.random.default_rng(1).normal(0.0, LEVEL, 6000)
    dataset = raw_dataset_of([read("ramp", time, deflection, flat_force(deflection), 3)], TireModel())
    parts = [(Part(e, own, own, own, np.ones(6000, dtype=bool)),) for e in dataset.experiments * 2]
    (found,) = residual_models(("deflection",), dataset, [own], HeldOut("the end of each motion", *parts))
    return found


def test_of_a_ramp_that_is_driven_once_nothing_is_known_to_repeat():
    assert np.isnan(over_a_ramp(1).r2)
    # As above, where the same waves are there again.
    assert 0.90 < over_a_ramp(2).r2 < 0.93


def test_what_depends_on_the_time_is_not_known_to_repeat():
    assert np.isnan(regressed("time", lambda t, x: np.where(t > 12.0, 20.0, 0.0)).r2)


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
