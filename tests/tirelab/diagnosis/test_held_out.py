"""What is held out: data on which the fit had no say, and which it could have known.

Each guarantee is broken on purpose.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from drives import damped, flat_force, read, ride
from radialtire import PowerLaw, TireModel
from rivals import rivals
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.held_out import split
from tirelab.estimation.explanation import explain_misfit
from tirelab.preprocessing.samples import raw_dataset_of
from tirelab.recordings.recording import Recording
from tirelab.simulation.simulate import simulate


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
    held_out = split(rides, raw_dataset_of(rides, TireModel()), before, found)
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
    verdict = diagnose([damped(3)], catalogue=["viscous_damping"])
    # 29.995 s of an even ride: the first 70 % of its misfit are in about as much of its time.
    first = float(re.match(r"time block ([0-9.]+)-30 s", verdict.fit.held_out_by)[1])
    assert first == pytest.approx(21.0, abs=1.0)
    assert verdict.fit.held_out_after < 0.5 * verdict.fit.held_out_before


def test_without_a_clock_the_end_is_named_by_its_samples():
    """Seconds that count samples would be told as if they had been measured."""
    drive = damped(3, damping=0.0, samples=1000)
    without = Recording(
        "untimed", np.arange(1000.0), drive.deflection, drive.surface_radius, drive.force + 60.0, timed=False
    )
    found = explain_misfit([without], TireModel(), ("force_offset",), lambda stage: None)
    before = [without.force - flat_force(without.deflection)]
    held_out = split([without], raw_dataset_of([without], TireModel()), before, found.of(("force_offset",)))
    first = int(np.searchsorted(np.cumsum(before[0] ** 2), 0.7 * np.sum(before[0] ** 2))) + 1
    assert held_out.by == f"samples {first}-1000"


def test_a_burst_is_on_both_sides_of_the_held_out_end():
    """By time alone all of it would be fitted, and the held-out end would show noise alone."""
    drive = damped(3)
    quick = drive.time < 0.1 * drive.time[-1]
    burst = replace(drive, force=np.where(quick, drive.force, flat_force(drive.deflection)))
    before = [burst.force - flat_force(burst.deflection)]
    missed = np.cumsum(before[0] ** 2) / np.sum(before[0] ** 2)
    verdict = diagnose([burst], catalogue=["viscous_damping"])
    first = float(re.match(r"time block ([0-9.]+)-", verdict.fit.held_out_by)[1])
    assert first < 0.2 * drive.time[-1]
    # A part of 0.7 of the misfit is fitted, unless that is less than a tenth of the samples.
    assert missed[np.searchsorted(drive.time, first)] >= 0.7


def test_given_recordings_are_preferred(damped_run):
    assert damped_run.verdict.fit.held_out_by == "recordings given"


def test_held_out_readings_that_are_fitted_are_told_to_test_nothing():
    ridden = damped(1, samples=2000)
    for name in ("ride 1", "copy"):
        found = diagnose(ridden, held_out=replace(ridden, name=name), catalogue=["viscous_damping"])
        assert found.summary.startswith(
            f"Most readings of {name} are those of ride 1, as in a copy or another export of one test: it tests "
        )
    other = diagnose(ridden, held_out=damped(2, samples=2000), catalogue=["viscous_damping"])
    assert "tests nothing" not in other.summary


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
    held_out = split([two], raw_dataset_of([two], tire), before, found)
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
    held_out = split(drives, raw_dataset_of(drives, TireModel()), before, found)
    assert "ends of the others" in held_out.by
    assert held_out.after < 0.5 * held_out.before
    alike = [*drives, cycled("fast again", 6.4, 3)]
    again = explain_misfit(alike, TireModel(), ["viscous_damping"], lambda stage: None).of(
        ("viscous_damping",)
    )
    before = [d.force - flat_force(d.deflection) for d in alike]
    assert split(alike, raw_dataset_of(alike, TireModel()), before, again).by == "recording fast again"


def held(times: int, seconds: float) -> Recording:
    """Presses to 20 mm within a second, held so many seconds: the force falls quickly, then slowly below the law."""
    one = np.arange(0.0, seconds + 4.0, 0.02)
    rest = np.clip(one - 1.0, 0.0, seconds)
    deflection = 0.02 * np.minimum(np.minimum(one, 1.0), np.maximum(seconds + 2.0 - one, 0.0))
    fall = 1.0 + 0.8 * np.exp(-rest / 4.0) + 0.2 * (np.exp(-rest / 100.0) - 0.3)
    time = np.concatenate([one + i * one[-1] + i * 0.02 for i in range(times)])
    return read(
        "held", time, np.tile(deflection, times), np.tile(flat_force(deflection) * fall, times), seed=4
    )


@pytest.mark.parametrize(
    ("times", "seconds", "by"), [(1, 300.0, "the end of each motion"), (8, 20.0, "time")]
)
def test_rests_longer_than_those_that_stay_fitted_are_not_held_out(times, seconds, by):
    """What a force does after minutes of rest cannot be known from its first minute; of equal rests the last ones are
    like the first.
    """
    recordings = [held(times, seconds)]
    found = explain_misfit(recordings, TireModel(), ["viscoelastic_relaxation"], lambda stage: None).of(
        ("viscoelastic_relaxation",)
    )
    before = [r.force - flat_force(r.deflection) for r in recordings]
    held_out = split(recordings, raw_dataset_of(recordings, TireModel()), before, found)
    assert held_out.by.startswith(by)
    assert held_out.after < 0.5 * held_out.before


def above_and_onto_a_rim(noise: float) -> list[Recording]:
    """Return a ride that ends above a rim and one that hits it, beside so much noise [N]."""
    above, onto = (read(n, *ride(s, samples=3000)[:2], 0.0, s) for n, s in (("above", 4), ("onto", 5)))
    deepest = max(float(d.deflection.max()) for d in (above, onto))
    above = replace(above, deflection=0.84 * above.deflection * deepest / above.deflection.max())
    hit = 4e5 * np.maximum(onto.deflection - 0.85 * deepest, 0.0)
    errors = noise * np.random.default_rng(6).normal(size=(2, 3000))
    return [
        replace(above, force=flat_force(above.deflection) + errors[0]),
        replace(onto, force=flat_force(onto.deflection) + hit + errors[1]),
    ]


@pytest.mark.slow
def test_what_shows_in_one_recording_alone_is_not_held_out_as_a_whole():
    """A rim that one ride hits cannot be fitted to a ride that ends above it, however alike their depths are."""
    verdict = diagnose(above_and_onto_a_rim(noise=5.0), catalogue=rivals("bottoming"))
    assert verdict.names == ("bottoming",)
    assert not verdict.fit.held_out_by.startswith("recording")


def test_nor_is_it_where_the_noise_hides_it():
    """Both rides miss nearly as much then, but only one of them for the rim; the other one can prove nothing."""
    drives = above_and_onto_a_rim(noise=60.0)
    before = [d.force - flat_force(d.deflection) for d in drives]
    assert np.std(before[1]) < 2.0 * np.std(before[0])
    found = explain_misfit(drives, TireModel(), ["bottoming"], lambda stage: None).of(("bottoming",))
    held_out = split(drives, raw_dataset_of(drives, TireModel()), before, found)
    assert not held_out.by.startswith("recording")
    assert held_out.after < held_out.before


def test_a_press_deeper_than_all_that_stays_fitted_refutes_nothing():
    """A stop at the end of one press is known from nothing before it: the end is fitted, and what lies between is held
    out.
    """
    time = np.linspace(0.0, 20.0, 4000)
    deflection = 0.0015 * time
    force = 0.8 * flat_force(deflection) + 4e5 * np.maximum(deflection - 0.027, 0.0)
    press = [read("press", time, deflection, force, seed=7)]
    found = explain_misfit(press, TireModel(), ["bottoming", "recalibration"], lambda stage: None).of(
        ("bottoming", "recalibration")
    )
    before = [p.force - flat_force(p.deflection) for p in press]
    held_out = split(press, raw_dataset_of(press, TireModel()), before, found)
    (fitted,), (other,) = held_out.fitted, held_out.held_out
    assert deflection[other.chosen].max() < 0.027 < deflection[fitted.chosen].max()
    assert held_out.after == pytest.approx(5.0, rel=0.1)
    assert held_out.before > 10.0 * held_out.after


def test_samples_at_the_end_of_the_gauges_travel_are_not_what_is_held_out():
    """Most of the misfit is where the gauge stands and the force goes on: no error can be computed there."""
    time = np.linspace(0.0, 13.5, 2700)
    pressed = 0.0275 * np.sin(np.pi * time / 20.0) ** 2
    gauge = np.minimum(pressed, 0.022)
    press = [replace(read("press", time, pressed, 0.8 * flat_force(pressed), seed=8), deflection=gauge)]
    found = explain_misfit(press, TireModel(), ["recalibration"], lambda stage: None).of(("recalibration",))
    before = [p.force - flat_force(p.deflection) for p in press]
    held_out = split(press, raw_dataset_of(press, TireModel()), before, found)
    ((other,), (seen,)) = held_out.held_out, found.compared
    assert not seen[gauge == 0.022].any()
    assert other.chosen.any()
    assert not (other.chosen & ~seen).any()
    assert held_out.after == pytest.approx(5.0, rel=0.1)


def test_a_few_samples_alone_are_not_what_is_held_out():
    """Of one deep press, without a clock, the end is deeper than all that stays fitted but for three samples of a slip:
    the whole end is held out.
    """
    time = np.linspace(0.0, 20.0, 240)
    deflection = 0.015 + 0.0004 * time
    deflection[220:223] -= 0.003
    drive = read("press", time, deflection, 0.8 * flat_force(deflection), seed=9)
    samples = (np.arange(240.0), drive.deflection, drive.surface_radius, drive.force)
    press = [Recording("untimed", *samples, timed=False)]
    found = explain_misfit(press, TireModel(), ["recalibration"], lambda stage: None).of(("recalibration",))
    before = [p.force - flat_force(p.deflection) for p in press]
    held_out = split(press, raw_dataset_of(press, TireModel()), before, found)
    (other,) = held_out.held_out
    assert other.chosen.mean() == pytest.approx(0.2, abs=0.05)
    assert held_out.after < 0.1 * held_out.before


def test_the_way_back_of_a_single_loop_is_not_held_out_as_a_whole():
    """Friction whose beginning was not recorded shows on the way in as a force that the law could be, and only on the
    way back as a loop: a tenth of a force that rises to 750 N, 400 of 800 samples.
    """
    way = np.linspace(0.0005, 0.02, 400)
    x = np.concatenate([way, way[::-1]])
    side = np.repeat([1.0, -1.0], 400)
    noise = np.random.default_rng(4).normal(0.0, 0.5, 800)
    force = 1.5e4 * x + 5e5 * x**2 + side * (30.0 + 0.1 * 1.5e4 * x) + noise
    loop = Recording("loop", np.arange(800.0), x, np.full(800, np.inf), force, timed=False)
    believed = TireModel(
        PowerLaw(170.0, 1.4), two_sided=True, inflated=False, preload=10.0, tested_range=None
    )
    name = "rate_independent_hysteresis"
    found = explain_misfit([loop], believed, [name], lambda stage: None).of((name,))
    before = [loop.force - simulate(believed, loop)]
    held_out = split([loop], raw_dataset_of([loop], believed), before, found)
    (part,), (rest,) = held_out.held_out, held_out.fitted
    for direction in (side > 0.0, side < 0.0):
        assert 0.1 < np.mean(part.chosen[direction]) < 0.9
        assert np.any(rest.chosen[direction])
