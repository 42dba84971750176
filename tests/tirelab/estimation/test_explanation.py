"""The entry of the engine on recordings of a tire that we made: 500 N s/m of damping under 5 N of noise."""

from __future__ import annotations

import itertools
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drives import damped, flat_force, read, ride, triangle
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.estimation import first_sets
from tirelab.estimation.explanation import (
    Explanation,
    _beyond_range,
    catalogue_names,
    explain_misfit,
)
from tirelab.names import REFITTED_LAW
from tirelab.preprocessing.motion import motion_of
from tirelab.preprocessing.noise import Noise
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import dataset_of
from tirelab.simulation.simulate import simulate

RIDES = (damped(1, samples=3000), damped(2, samples=3000))


@pytest.fixture(scope="module")
def found() -> Explanation:
    return explain_misfit(RIDES, TireModel(), catalogue_names(), lambda stage: None)


def test_the_effect_is_named_with_its_size_and_nothing_else(found: Explanation) -> None:
    (effect,) = found.effects
    assert effect.name == "viscous_damping"
    assert effect.parameters["damping"].value == pytest.approx(500.0, rel=0.03)
    assert effect.parameters["damping"].determined
    assert effect.share > 0.95
    assert effect.probability > 0.99
    assert not found.remainder.unexplained


def test_the_sets_are_told_with_probabilities_that_add_up_to_one(found: Explanation) -> None:
    assert found.evidence[0].names == found.model.names
    assert found.evidence[0].log_evidence == 0.0
    assert found.probability == found.evidence[0].probability
    assert sum(e.probability for e in found.evidence) == pytest.approx(1.0)
    logs = [e.log_evidence for e in found.evidence]
    assert logs == sorted(logs, reverse=True)
    for effect in found.effects:
        own = sum(e.probability for e in found.evidence if effect.name in e.names)
        assert effect.probability == pytest.approx(own)


def test_the_noise_floor_is_that_of_the_recordings(found: Explanation) -> None:
    # 5 N on the force and 5 um at 80 kN/m.
    assert len(found.floors) == len(RIDES)
    for floor in found.floors:
        assert floor.level == pytest.approx(np.hypot(5.0, 0.4), rel=0.06)


def test_what_is_left_is_left_by_the_written_tire(found: Explanation) -> None:
    nothing = found.of(())
    for drive, left, bare in zip(RIDES, found.residuals, nothing.residuals, strict=True):
        assert bare == pytest.approx(drive.force - flat_force(drive.deflection), abs=1e-6)
        assert float(np.std(left)) == pytest.approx(5.0, rel=0.06)
    assert nothing.effects == ()
    assert nothing.remainder.unexplained


def test_the_motion_that_is_kept_is_not_written_to(found: Explanation) -> None:
    for drive in RIDES:
        kept, anew = motion_of(drive.time, drive.deflection), motion_of(drive.time, drive.deflection + 0.0)
        assert anew is kept
        fresh = motion_of(drive.time.copy() + 1e-9 * drive.time[-1], drive.deflection)
        assert fresh is not kept
        np.testing.assert_allclose(kept.rate, fresh.rate, rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(kept.deflection, fresh.deflection, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("gauge", "exact"), [(0.0, True), (1e-5, False)])
def test_a_deflection_is_taken_as_exact_where_that_leaves_less(gauge: float, exact: bool) -> None:
    """A damper driven by random motion to 50 Hz, 20 times as fast as it is read well; the other one is read with noise.

    Fifth differences of either look like noise. A tire that is guarded against it misses 100 N of the first damper's
    force; of the second, 10 um at 400 Hz are 5.7 mm/s or 2.8 N in a rate that is read without a guard.
    """
    rng, step = np.random.default_rng(3), 2.5e-3 if exact else 5e-3
    time = step * np.arange(2400)
    frequencies = np.linspace(1.0, 50.0 if exact else 4.0, 120)
    waves = 2.0 * np.pi * frequencies * time[:, None] + rng.uniform(0.0, 2.0 * np.pi, 120)
    deflection = 0.012 + 2e-4 * np.sin(waves).sum(axis=1)
    rate = 2e-4 * (2.0 * np.pi * frequencies * np.cos(waves)).sum(axis=1)
    shown = deflection + gauge * rng.standard_normal(time.size)
    force = flat_force(deflection) + 500.0 * rate + 2.0 * rng.standard_normal(time.size)
    drive = Recording("random", time, shown, np.full(time.size, np.inf), force)
    found = explain_misfit([drive], TireModel(), ["viscous_damping"], lambda stage: None)
    assert [e.name for e in found.effects] == ["viscous_damping"]
    assert (found.model.tire.reading_noise == 0.0) == exact
    guards = [0.0, dataset_of([drive], TireModel()).tire.reading_noise]
    left = [
        float(np.std(force - simulate(replace(found.model.tire, reading_noise=g), drive))) for g in guards
    ]
    assert found.error == pytest.approx(min(left), rel=0.01)
    assert (left[0] < left[1]) == exact


@pytest.mark.parametrize(
    ("force", "length", "time"),
    [
        pytest.param(1e4, 1.0, 1.0, marks=pytest.mark.slow),
        pytest.param(1.0, 0.01, 1.0, marks=pytest.mark.slow),
        pytest.param(1.0, 8.0, 30.0, marks=pytest.mark.slow),
    ],
)
def test_the_scale_of_a_recording_changes_nothing(
    found: Explanation, force: float, length: float, time: float
) -> None:
    """A column of meganewtons, a fibre of micrometres, a part that is pressed for hours: its law scaled with it."""
    A, B = TireModel().law.coefficients(np.inf)
    part = TireModel(law=PowerLaw(A * force / length**B, B), tested_range=None)
    rides = [
        replace(r, time=time * r.time, deflection=length * r.deflection, force=force * r.force) for r in RIDES
    ]
    scaled = explain_misfit(rides, part, catalogue_names(), lambda stage: None)
    assert [e.name for e in scaled.effects] == [e.name for e in found.effects]
    assert scaled.effects[0].parameters["damping"].value == pytest.approx(
        found.effects[0].parameters["damping"].value * force * time / length, rel=0.01
    )
    assert scaled.effects[0].probability == pytest.approx(found.effects[0].probability, abs=0.01)


def test_a_set_that_was_not_fitted_is_refused(found: Explanation) -> None:
    with pytest.raises(ValueError, match="no fit of phlogiston was made"):
        found.of(("phlogiston",))
    assert found.alternative_model(("phlogiston",)) is None


def test_what_would_have_to_be_more_than_it_can_be_is_as_if_it_were_unknown() -> None:
    """A force that follows the deflection by 5 s, as no amplifier's filter does: the lag ends at one second."""
    time = np.arange(2000) * 0.05
    deflection = 0.012 + 0.006 * np.sin(0.2 * time) + 0.003 * np.sin(0.53 * time + 1.0)
    elastic, late = flat_force(deflection), np.zeros(time.size)
    late[0] = elastic[0]
    for i in range(1, time.size):
        late[i] = late[i - 1] + (elastic[i] - late[i - 1]) * 0.05 / 5.0
    drive = read("late", time, deflection, late, 1)
    others = ("viscous_damping", "viscoelastic_relaxation")
    said: list[list[str]] = [[], []]
    found = explain_misfit([drive], TireModel(), ("force_lag", *others), said[0].append)
    without = explain_misfit([drive], TireModel(), others, said[1].append)
    assert said[0] == 2 * said[1]  # it is searched again, beside nothing that is impossible
    assert found.evidence == without.evidence
    assert found.error == without.error


@pytest.mark.parametrize(
    ("others", "left_out"),
    [
        ([(-9.0, ("lag", "damping"), ())], ()),
        ([(-9.0, ("lag", "damping"), ("lag",)), (-20.0, ("damping",), ())], ("lag",)),
        ([(1.0, ("damping",), ())], ()),
    ],
    ids=["in its range beside another effect", "out of it everywhere", "not the likeliest"],
)
def test_an_effect_is_left_out_where_it_is_out_of_its_range_in_every_set(
    others: list[tuple[float, tuple[str, ...], tuple[str, ...]]], left_out: tuple[str, ...]
) -> None:
    sets = [(0.0, ("lag",), ("lag",)), (-30.0, (), ()), *others]
    fits = [SimpleNamespace(in_any_range=p, names=names, beyond=beyond) for p, names, beyond in sets]
    ranking: Any = SimpleNamespace(fits=fits)
    assert _beyond_range(ranking) == left_out


def test_of_the_sets_that_leave_less_the_likeliest_is_told(found: Explanation) -> None:
    assert found.likeliest_reducing(0.9) == ("viscous_damping",)
    assert found.likeliest_reducing(1e-3) == ()


def test_fitted_again_without_a_recording_it_is_fitted_to_the_others() -> None:
    """Twice the damping in the second ride, of which nothing is used."""
    rides = (RIDES[0], damped(2, damping=1000.0, samples=3000))
    both = explain_misfit(rides, TireModel(), ["viscous_damping"], lambda stage: None).of(
        ("viscous_damping",)
    )
    again = both.refitted([np.ones(3000, dtype=bool), np.zeros(3000, dtype=bool)])
    ((_, values),) = again.tire.effects
    assert values[0] == pytest.approx(500.0, rel=0.05)
    rate = float(np.sqrt(np.mean(ride(2, samples=3000)[2] ** 2)))
    missed = float(np.sqrt(np.mean(again.residuals[1] ** 2)))
    assert missed == pytest.approx(np.hypot(500.0 * rate, 5.0), rel=0.05)


def test_only_what_the_catalogue_holds_is_found() -> None:
    catalogue = ("force_offset", "recalibration")
    said: list[str] = []
    found = explain_misfit(RIDES[:1], TireModel(), catalogue, said.append)
    assert {n for e in found.evidence for n in e.names} <= set(catalogue)
    assert said == ["comparing the effects' signatures", "fitting the sets that can win"]


def test_without_a_time_nothing_that_depends_on_it_is_found() -> None:
    r = RIDES[0]
    untimed = Recording("untimed", r.time, r.deflection, r.surface_radius, r.force, timed=False)
    catalogue = ("viscous_damping", "warm_up", "force_offset")
    found = explain_misfit([untimed], TireModel(), catalogue, lambda s: None)
    assert dict(found.unshown.reasons) == dict.fromkeys(
        ("viscous_damping", "warm_up"), "the recording has no time"
    )
    assert {n for e in found.evidence for n in e.names} <= {"force_offset"}


def test_the_sets_come_in_the_order_of_their_probability_but_for_the_central_one(found: Explanation) -> None:
    order = found.in_order(4)
    likely = [e.names for e in found.evidence[:4]]
    # Damping alone is likelier than not: here the likeliest set also stands best for all.
    assert set(order[0]) == {"viscous_damping"}
    assert list(order) == likely


def test_nothing_of_a_pressure_is_looked_for_where_there_is_no_air() -> None:
    """A force that falls by a tenth within a ride: a leak of a tire, and of a spring something else."""
    ride = damped(1, samples=2000)
    fall = 1.0 - 0.1 * (ride.time - ride.time[0]) / np.ptp(ride.time)
    tire = replace(ride, force=ride.force * fall)
    catalogue = ("pressure_leak", "gas_compression", "viscous_damping")

    def compared(baseline: TireModel) -> set[str]:
        found = explain_misfit([tire], baseline, catalogue, lambda stage: None)
        return {n for e in found.evidence for n in e.names}

    assert "pressure_leak" in compared(TireModel())
    assert compared(TireModel(inflated=False)) == {"viscous_damping"}


def test_where_the_motion_shows_no_candidate_no_effect_is_named() -> None:
    """Only the inflation pressure may be named, and no recording has that channel."""
    found = explain_misfit(RIDES[:1], TireModel(), ["inflation_pressure"], lambda stage: None)
    assert found.effects == ()
    assert found.remainder.unexplained


def test_beside_a_refitted_law_of_one_slow_press_an_offset_leaves_no_trace_but_a_loop_does() -> None:
    """Two per cent more force at every deflection: with another A, what is zero at another place looks the same."""
    time, deflection = triangle(samples=200)
    press = read("press", time, deflection, 1.02 * flat_force(deflection), 3)
    loops = ("rate_independent_hysteresis", "viscous_damping")
    catalogue = ("recalibration", "deflection_offset", *loops)
    whole = explain_misfit([press], TireModel(), catalogue, lambda stage: None)
    refitted, nothing = whole.of(("recalibration",)), whole.of(())
    assert "deflection_offset" in refitted.within_law
    assert not set(loops) & set(refitted.within_law)
    assert nothing.within_law == ()


def test_a_misfit_far_above_the_noise_shows_what_a_law_cannot_follow(found: Explanation) -> None:
    assert not {"viscous_damping", "inertia"} & set(found.within_law)


@pytest.mark.parametrize(("breakaway", "alike"), [(0.5e-3, True), (2e-3, False)])
def test_friction_at_one_speed_is_told_from_damping_by_how_it_breaks_away(
    breakaway: float, alike: bool
) -> None:
    """Both jump by 120 N at a turn of the triangle; within 2 mm of it friction is far from that, and damping is not."""
    time, deflection = triangle(samples=1500)
    slip, slips = 0.0, []
    for change in np.diff(deflection, prepend=0.0):
        slip = np.sign(change) + (slip - np.sign(change)) * np.exp(-abs(change) / breakaway)
        slips.append(slip)
    press = read("press", time, deflection, flat_force(deflection) + 60.0 * np.array(slips), 3, noise=0.5)
    effects = ("viscous_damping", "rate_independent_hysteresis")
    found = explain_misfit([press], TireModel(), effects, lambda stage: None)
    assert found.model.names == ("rate_independent_hysteresis",)
    assert "viscous_damping" in found.excitation.alike("rate_independent_hysteresis")
    assert (("viscous_damping",) in found.confounded) == alike


@pytest.mark.parametrize(
    ("levels", "expected"),
    [
        # (2^2 - 1 + 10^2 - 1) / 2 more than the readings' variance in each of two recordings of one length.
        ((2.0, 10.0), (np.sqrt(52.0), np.sqrt(52.0))),
        ((0.5, 0.8), (0.5, 0.8)),
        ((0.5, 3.0), (np.sqrt(0.25 + 4.0), np.sqrt(1.0 + 4.0))),
    ],
)
def test_what_no_effect_explains_in_one_recording_weighs_alike_in_all(
    levels: tuple[float, float], expected: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Levels of what the saturated model leaves, over the noise of the readings."""
    left = itertools.cycle(levels)
    monkeypatch.setattr(first_sets, "noise_of", lambda *_: Noise(next(left), 1))
    found = explain_misfit(RIDES, TireModel(), ["viscous_damping"], lambda stage: None)
    read = [e.noise for e in dataset_of(RIDES, TireModel()).experiments]
    noises = [e.noise for e in found.model.fit.problem.dataset.experiments]
    assert np.array(noises) / read == pytest.approx(expected, rel=0.03)


def test_a_part_whose_preload_was_fitted_without_what_relaxes_has_another_preload() -> None:
    """25 N and 5 N/mm, of which 0.6 N/mm relax within 3 s; the straight line through it all begins 5 N lower.

    No reading has a wrong zero, and a part's preload cannot be told from one.
    """
    time = np.arange(0.0, 80.0, 0.02)
    x = np.interp(time, [0.0, 5.0, 30.0, 35.0, 40.0, 65.0, 80.0], [0.0, 0.02, 0.02, 0.008, 0.02, 0.02, 0.0])
    silent = Recording("part", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    effect = CATALOGUE["viscoelastic_relaxation"]
    values = {p.name: p.start for p in effect.parameters} | {"share_1": 0.12, "relaxation_time_1": 3.0}
    true = TireModel(PowerLaw(50.0, 1.0), two_sided=True, preload=25.0, tested_range=None)
    relaxing = replace(true, effects=((effect, tuple(values[p.name] for p in effect.parameters)),))
    force = simulate(relaxing, silent) + 0.1 * np.random.default_rng(2).normal(size=time.size)
    baseline = replace(true, preload=20.0)
    names = (REFITTED_LAW, "viscoelastic_relaxation", "force_offset", "deflection_offset")
    found = explain_misfit([replace(silent, force=force)], baseline, names, lambda stage: None)
    assert set(found.model.names) == {REFITTED_LAW, "viscoelastic_relaxation"}
    assert found.model.tire.preload == pytest.approx(25.0, abs=0.2)
    reasons = dict(found.unshown.reasons)
    assert "preload" in reasons["force_offset"]
    assert "preload" in reasons["deflection_offset"]


def test_a_part_whose_gap_was_fitted_without_what_relaxes_has_another_gap() -> None:
    """10 N/mm from 2 mm on, of which 2 N/mm relax within 3 s; the law through it all was taken to begin at 1.5 mm."""
    time = np.arange(0.0, 80.0, 0.02)
    x = np.interp(time, [0.0, 5.0, 30.0, 35.0, 40.0, 65.0, 80.0], [0.0, 0.02, 0.02, 0.0, 0.012, 0.012, 0.0])
    silent = Recording("stop", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    relaxation = CATALOGUE["viscoelastic_relaxation"]
    values = {p.name: p.start for p in relaxation.parameters} | {"share_1": 0.2, "relaxation_time_1": 3.0}
    effects = (relaxation, tuple(values[p.name] for p in relaxation.parameters))
    gap = CATALOGUE["deflection_offset"]
    true = TireModel(
        PowerLaw(100.0, 1.0), effects=((gap, (-0.002,)), effects), inflated=False, tested_range=None
    )
    force = simulate(true, silent) + 0.1 * np.random.default_rng(3).normal(size=time.size)
    believed = replace(true, law=PowerLaw(90.0, 1.1), effects=((gap, (-0.0015,)),))
    names = (REFITTED_LAW, "viscoelastic_relaxation", "deflection_offset")
    found = explain_misfit([replace(silent, force=force)], believed, names, lambda stage: None)
    assert set(found.model.names) == {REFITTED_LAW, "viscoelastic_relaxation"}
    (law,) = [e for e in found.effects if e.name == REFITTED_LAW]
    changed = law.parameters["gap"]
    assert changed.value == pytest.approx(0.0005, abs=3.0 * changed.std)
    assert changed.std < 1e-4
    ((_, (offset,)),) = [(e, v) for e, v in found.model.tire.effects if e is gap]
    assert offset == pytest.approx(-0.0015 - changed.value)
    assert "gap" in dict(found.unshown.reasons)["deflection_offset"]


def test_the_deflection_of_a_tire_may_have_another_zero_whatever_the_baseline_has() -> None:
    believed = TireModel(effects=((CATALOGUE["deflection_offset"], (0.001,)),))
    found = explain_misfit(
        RIDES, believed, (REFITTED_LAW, "deflection_offset", "viscous_damping"), lambda stage: None
    )
    assert "deflection_offset" not in dict(found.unshown.reasons)


def late(lag: float) -> Recording:
    """A slow ride whose force follows with a time constant [s] of our own low-pass, under 1 N of noise."""
    time = np.arange(0.0, 120.0, 0.05)
    deflection = 0.008 * (1.0 - np.cos(2.0 * np.pi * time / 20.0) * np.cos(2.0 * np.pi * time / 57.0))
    force, left = flat_force(deflection), np.exp(-0.05 / lag)
    reading = [force[0]]
    for value in force[1:]:
        reading.append(left * reading[-1] + (1.0 - left) * value)
    noisy = np.array(reading) + np.random.default_rng(4).normal(size=time.size)
    return Recording("late", time, deflection, np.full(time.size, np.inf), noisy)


def test_an_effect_that_would_have_to_be_out_of_its_valid_range_is_not_named() -> None:
    """A force channel lags by a second at most; what follows four seconds later is no force channel."""
    within, beyond = (
        explain_misfit([late(lag)], TireModel(), ["force_lag"], lambda stage: None) for lag in (0.4, 4.0)
    )
    assert [e.name for e in within.effects] == ["force_lag"]
    assert within.effects[0].parameters["lag"].value == pytest.approx(0.4, rel=0.1)
    assert beyond.effects == ()
    assert beyond.remainder.unexplained
    assert not beyond.was_fitted(("force_lag",))
    assert [e.names for e in beyond.evidence] == [()]
    assert np.isfinite(beyond.evidence[0].log_evidence)
    assert beyond.in_order(6) == ((),)
    with pytest.raises(ValueError, match="within valid ranges"):
        beyond.of(("force_lag",))
