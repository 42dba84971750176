"""What is believed earns its place in the catalogue's own form, within the catalogue's bounds."""

import numpy as np
import pytest
from drives import read, ride
from radialtire import CATALOGUE, TireModel
from tirelab.diagnosis import diagnose
from tirelab.explain.scene import scene_of
from tirelab.noise import Noise
from tirelab.refit import Case, gain_of, refit, smooth_of
from tirelab.simulate import simulate

BARE = TireModel()
NOISE = 5.0


def with_effect(name, **values):
    effect = CATALOGUE[name]
    return TireModel(effects=((effect, tuple(values.get(p.name, p.start) for p in effect.parameters)),))


def ridden(seed, tire, noise=NOISE):
    time, deflection, _ = ride(seed)
    bare = read("ride", time, deflection, np.zeros(time.size), seed, noise=0.0)
    return read("ride", time, deflection, simulate(tire, bare), seed, noise=noise)


def fitted(recording, tire, names):
    """The effects of `tire`, and others that are not there, fitted together."""
    scene = scene_of(
        [(recording.time, recording.deflection, recording.surface_radius, recording.force)], BARE
    )
    (record,) = scene.records
    ones = np.ones(record.rows.size)
    noise = Noise(NOISE, NOISE, np.ones(1), ones, ones)
    smooth = smooth_of(recording, record.motion)
    cases = [Case(recording, smooth, recording.force, noise, record.rows, 0.0 * ones)]
    elastic = simulate(BARE, recording)[record.rows]
    part = simulate(tire, recording)[record.rows] - elastic
    own = [e.name for e, _ in tire.effects]
    parts = {n: [part if n in own else -1e-3 * elastic] for n in names}
    found = refit(BARE, names, parts, np.zeros((1, 2)), cases, scene.radii, scene.deepest, scene.highest)
    return found, cases, scene


@pytest.mark.parametrize("seed", range(3))
def test_what_is_there_gains_and_what_is_not_costs(seed):
    tire = with_effect("viscous_damping", damping=100.0)
    recording = ridden(seed, tire)
    found, cases, scene = fitted(recording, tire, ["mullins_softening", "viscous_damping"])
    gain = {
        n: gain_of(n, found, BARE, cases, scene.radii, 1.0) for n in ("mullins_softening", "viscous_damping")
    }
    assert gain["viscous_damping"] > 0.0
    # Two parameters at half the logarithm of 6000 each; what noise gives back is chi square of two: 7 once in 1000.
    assert gain["mullins_softening"] < 7.0 - 2.0 * 0.5 * np.log(6000.0)


def test_the_gain_of_the_only_effect_is_half_of_what_it_takes_off_the_sum_of_squares():
    tire = with_effect("viscous_damping", damping=60.0)
    recording = ridden(5, tire)
    found, cases, scene = fitted(recording, tire, ["viscous_damping"])
    rows = scene.records[0].rows
    before, after = ((recording.force - simulate(t, recording))[rows] / NOISE for t in (BARE, found.tire))
    price = len(found.knobs) * 0.5 * np.log(rows.size)
    taken = 0.5 * float(before @ before - after @ after)
    # The loss counts what lies beyond three noises less, and so a normal residual by a tenth.
    assert gain_of("viscous_damping", found, BARE, cases, scene.radii, 1.0) + price == pytest.approx(
        taken, rel=0.2
    )


def test_a_mass_beyond_all_bounds_is_not_believed():
    time, deflection, _ = ride(6)
    acceleration = np.gradient(np.gradient(deflection, time), time)
    force = simulate(BARE, read("ride", time, deflection, 0.0 * time, 6, noise=0.0)) + 400.0 * acceleration
    verdict = diagnose([read("ride", time, deflection, np.maximum(force, 0.0), 6)])
    assert "inertia" not in verdict.names


def test_a_strength_at_its_bound_is_believed_where_nothing_else_comes_near():
    """Softening in a straight line down to 40 %: the share is at its bound, and every set without it is far off."""

    def softened(seed):
        time, deflection, _ = ride(seed)
        bare = simulate(BARE, read("ride", time, deflection, 0.0 * time, seed, noise=0.0))
        below = 1.0 - deflection / np.maximum.accumulate(deflection)
        return read("ride", time, deflection, bare * (1.0 - 0.6 * below), seed)

    verdict = diagnose([softened(8), softened(9)])
    assert "mullins_softening" in verdict.names
    share = next(e for e in verdict.effects if e.name == "mullins_softening").parameters["share"]
    assert share.value == pytest.approx(0.9)


def test_what_stands_for_the_form_of_a_large_lag_is_not_believed():
    """Butterworth's low-pass at 80 ms in a sweep: the columns of the search lack its form, the catalogue's has it."""
    time = np.arange(10_000) * 0.004
    turns = 0.1 * time + 0.5 * (6.0 - 0.1) / time[-1] * time**2
    deflection = 0.012 - 0.004 * np.cos(2.0 * np.pi * turns)
    bare = read("sweep", time, deflection, np.zeros(time.size), 10, noise=0.0)
    force = simulate(with_effect("force_lag", lag=0.08, quality=1.0 / np.sqrt(2.0)), bare)
    verdict = diagnose([read("sweep", time, deflection, force, 10)])
    assert verdict.names == ("force_lag",)
    assert verdict.effects[0].parameters["lag"].value == pytest.approx(0.08, rel=0.01)
