"""The correction judged on held-out data."""

import re
from dataclasses import replace

import numpy as np
import pytest
from drives import damped, flat_force, read, ride
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.held_out import split
from tirelab.estimation.explanation import explain_misfit
from tirelab.preprocessing.dataset import dataset_of
from tirelab.recordings.recording import Recording


def error_of(missed):
    """Return the RMSE [N] where so many N s/m are missed on ride 2, beside 5 N of noise and 5 um at 80 kN/m."""
    rate = float(np.sqrt(np.mean(ride(2)[2] ** 2)))
    return np.sqrt(5.0**2 + 0.4**2 + (missed * rate) ** 2)


def test_the_fit_does_not_use_the_held_out_recording():
    """Damping of 500 N s/m in the fitted recording, 200 in the held-out one, the last.

    Fitted to the first alone the correction is 300 too strong on the second, where the baseline misses 200. Fitted to
    both it would be 350, as far off as the baseline is.
    """
    rides = [damped(1), damped(2, damping=200.0)]
    found = explain_misfit(rides, TireModel(), ["viscous_damping"], lambda stage: None).of(
        ("viscous_damping",)
    )
    before = [r.force - flat_force(r.deflection) for r in rides]
    held_out = split(rides, dataset_of(rides, TireModel()), before, found)
    assert held_out.by == "recording ride 2"
    assert held_out.before == pytest.approx(error_of(200.0), rel=0.03)
    assert held_out.after == pytest.approx(error_of(300.0), rel=0.03)


def test_a_correction_that_is_worse_on_held_out_data_is_not_delivered(unequal_verdict):
    """The same rides: a correction that fits the first would miss 300 N s/m of the second in place of 200."""
    verdict = unequal_verdict
    assert verdict.effects == ()
    assert verdict.unexplained
    assert verdict.fit.held_out_by == "recording ride 2"
    assert verdict.fit.held_out_before == pytest.approx(error_of(200.0), rel=0.03)
    assert verdict.fit.held_out_after == verdict.fit.held_out_before
    tire, baseline = verdict.tire, TireModel()
    assert (tire.name, tire.law, tire.effects) == (baseline.name, baseline.law, baseline.effects)


def test_the_end_of_a_single_recording_is_held_out():
    verdict = diagnose([damped(3)])
    # 29.995 s of an even ride: the first 70 % of its misfit are in about as much of its time.
    first = float(re.match(r"time block ([0-9.]+)-30 s", verdict.fit.held_out_by)[1])
    assert first == pytest.approx(21.0, abs=1.0)
    assert verdict.fit.held_out_after < 0.5 * verdict.fit.held_out_before


def test_without_a_clock_the_end_is_named_by_its_samples():
    """Seconds that count samples would be told as if they had been measured."""
    drive = damped(3, samples=1000)
    without = Recording(
        "untimed", np.arange(1000.0), drive.deflection, drive.surface_radius, drive.force, timed=False
    )
    found = explain_misfit([without], TireModel(), ("force_offset",), lambda stage: None, timed=False)
    before = [without.force - flat_force(without.deflection)]
    held_out = split([without], dataset_of([without], TireModel()), before, found.of(("force_offset",)))
    first = int(np.searchsorted(np.cumsum(before[0] ** 2), 0.7 * np.sum(before[0] ** 2))) + 1
    assert held_out.by == f"samples {first}-1000"


def test_a_burst_is_on_both_sides_of_the_held_out_end():
    """By time alone all of it would be fitted, and the held-out end would show noise alone."""
    drive = damped(3)
    quick = drive.time < 0.1 * drive.time[-1]
    burst = replace(drive, force=np.where(quick, drive.force, flat_force(drive.deflection)))
    before = [burst.force - flat_force(burst.deflection)]
    missed = np.cumsum(before[0] ** 2) / np.sum(before[0] ** 2)
    verdict = diagnose([burst])
    first = float(re.match(r"time block ([0-9.]+)-", verdict.fit.held_out_by)[1])
    assert first < 0.2 * drive.time[-1]
    # A part of 0.7 of the misfit is fitted, unless that is less than a tenth of the samples.
    assert missed[np.searchsorted(drive.time, first)] >= 0.7


def test_given_recordings_are_preferred(damped_run):
    assert damped_run.verdict.fit.held_out_by == "recordings given"


def test_where_nothing_is_missing_both_errors_are_the_noise(complete_verdict):
    assert complete_verdict.names == ()
    assert complete_verdict.fit.held_out_after == complete_verdict.fit.held_out_before
    assert complete_verdict.fit.held_out_after == pytest.approx(5.0, rel=0.05)


def test_of_surfaces_in_turn_the_end_on_each_is_held_out():
    """By time alone all of the second surface would be held out, to which no law is fitted then."""
    drive = damped(3, damping=0.0)
    half = drive.time < drive.time[drive.time.size // 2]
    two = replace(
        drive,
        surface_radius=np.where(half, np.inf, 0.3),
        force=drive.force + np.where(half, 0.1, -0.06) * flat_force(drive.deflection),
    )
    tire = TireModel(PowerLaw(550.9, 1.40), tested_range=None)
    found = explain_misfit([two], tire, ["recalibration"], lambda stage: None).of(("recalibration",))
    before = [two.force - flat_force(two.deflection)]
    held_out = split([two], dataset_of([two], tire), before, found)
    assert held_out.by == "the end of each motion"
    (part,) = held_out.held_out
    for surface in (half, ~half):
        missed = np.sum(before[0][surface & part.chosen] ** 2) / np.sum(before[0][surface] ** 2)
        assert missed == pytest.approx(0.3, abs=0.01)
    # The law of each surface is that of its first part: what is left is the reading's noise of 5 N.
    assert held_out.after == pytest.approx(5.0, rel=0.05)
    assert held_out.before > 10.0 * held_out.after


def cycled(name, frequency, seed):
    """A sine on a tire whose damper grows with the root of the rate: 60 N at 0.1 m/s, twelve times the noise."""
    time = np.linspace(0.0, 8.0 / frequency, 3000)
    angle = 2.0 * np.pi * frequency * time
    deflection, rate = 0.011 - 0.01 * np.cos(angle), 0.02 * np.pi * frequency * np.sin(angle)
    force = flat_force(deflection) + 60.0 * np.sign(rate) * np.sqrt(np.abs(rate) / 0.1)
    return read(name, time, deflection, force, seed)


def test_what_is_driven_much_faster_is_not_held_out_as_a_whole():
    """A linear damper fitted at 6 mm/s is eight times too strong at 380 mm/s, sixty-four times as fast."""
    drives = [cycled("slow", 0.1, 1), cycled("fast", 6.4, 2)]
    found = explain_misfit(drives, TireModel(), ["viscous_damping"], lambda stage: None).of(
        ("viscous_damping",)
    )
    before = [d.force - flat_force(d.deflection) for d in drives]
    held_out = split(drives, dataset_of(drives, TireModel()), before, found)
    assert "ends of the others" in held_out.by
    assert held_out.after < 0.5 * held_out.before
    alike = [*drives, cycled("fast again", 6.4, 3)]
    again = explain_misfit(alike, TireModel(), ["viscous_damping"], lambda stage: None).of(
        ("viscous_damping",)
    )
    before = [d.force - flat_force(d.deflection) for d in alike]
    assert split(alike, dataset_of(alike, TireModel()), before, again).by == "recording fast again"
