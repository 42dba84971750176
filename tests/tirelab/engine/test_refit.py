"""The fit of the chosen effects: what is freed, what stays plain, and how sure it is."""

import numpy as np
import pytest
from drives import Drive, flat_force, read, ride, triangle
from radialtire import CATALOGUE, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.simulation.simulate import simulate


def ridden(seed, tire, noise=5.0):
    time, deflection, _ = ride(seed)
    bare = read(f"ride {seed}", time, deflection, np.zeros(time.size), seed, noise=0.0)
    return read(f"ride {seed}", time, deflection, simulate(tire, bare), seed, noise=noise)


def test_extra_freedoms_that_nothing_asks_for_stay_plain():
    verdict = diagnose(
        [ridden(1, TireModel(effects=((CATALOGUE["viscous_damping"], (600.0, 1.0, 0.0, 0.0)),)))]
    )
    assert verdict.names == ("viscous_damping",)
    assert set(verdict.effects[0].parameters) == {"damping"}
    values = next(v for e, v in verdict.tire.effects if e.name == "viscous_damping")
    assert values[1:] == (1.0, 0.0, 0.0)


def test_an_extra_freedom_that_is_needed_is_found():
    verdict = diagnose(
        [ridden(2, TireModel(effects=((CATALOGUE["viscous_damping"], (900.0, 0.5, 0.0, 0.0)),)))]
    )
    assert verdict.names == ("viscous_damping",)
    exponent = verdict.effects[0].parameters["rate_exponent"]
    # A root of the rate is steep at its zeros, where the rate is tracked late: a tenth.
    assert exponent.value == pytest.approx(0.5, abs=0.1)


def test_at_one_rate_the_growth_with_the_rate_is_not_fitted():
    time, deflection = triangle()
    loop = 30.0 * np.sign(np.sin(2.0 * np.pi * time / 4.0))
    verdict = diagnose(
        [read("triangle", time, deflection, np.maximum(flat_force(deflection) + loop, 0.0), 9)]
    )
    assert all("rate_exponent" not in e.parameters for e in verdict.effects)


def test_deviations_are_those_of_a_linear_fit():
    verdict = diagnose([ridden(3, TireModel(effects=((CATALOGUE["force_offset"], (25.0,)),)))])
    offset = verdict.effects[0].parameters["offset"]
    # The mean of 6000 samples with 5 N of noise: 5 / sqrt(6000); the deflection's noise adds a tenth.
    assert offset.std == pytest.approx(5.0 / np.sqrt(6000.0), rel=0.25)
    assert offset.value == pytest.approx(25.0, abs=5.0 * offset.std)


@pytest.mark.parametrize("part", [0.6, 0.993])
def test_a_ceiling_is_found_wherever_it_is(part):
    limit = part * float(ridden(4, TireModel(), noise=0.0).force.max())
    verdict = diagnose([ridden(4, TireModel(effects=((CATALOGUE["saturation"], (limit, 0.0)),)), noise=2.0)])
    assert verdict.names == ("saturation",)
    # The mean of the samples at the ceiling, ten or more: 2 / sqrt(10), and half as much again.
    assert verdict.effects[0].parameters["limit"].value == pytest.approx(limit, abs=1.0)


def test_the_rounding_of_a_ceiling_is_found():
    limit = 0.7 * float(ridden(5, TireModel(), noise=0.0).force.max())
    verdict = diagnose([ridden(5, TireModel(effects=((CATALOGUE["saturation"], (limit, 40.0)),)))])
    assert verdict.names == ("saturation",)
    # 5 N of noise, bent by 40 ln 2 = 28 N over a few hundred samples of a ride.
    assert verdict.effects[0].parameters["knee"].value == pytest.approx(40.0, rel=0.1)


@pytest.mark.parametrize("seed", [21, 22, 23])
def test_what_acts_in_a_few_samples_is_found_if_they_show_it(seed):
    # 5 N of noise; the 25 largest of 6000 readings are cut by so much that their squares sum up to 80 noises squared.
    force = ridden(seed, TireModel(), noise=0.0).force
    largest = np.sort(force)[-25:]
    limits = np.linspace(largest[0], largest[-1], 500)
    cut = np.sum(np.maximum(largest[:, None] - limits, 0.0) ** 2, axis=0) / 25.0
    limit = float(limits[np.argmin(np.abs(cut - 80.0))])
    verdict = diagnose([ridden(seed, TireModel(effects=((CATALOGUE["saturation"], (limit, 0.0)),)))])
    assert verdict.names == ("saturation",)


def test_a_late_reading_of_a_tire_that_relaxes_is_told_apart():
    """Either undoes some of the other: shares below nothing would stand for the lag, and no one effect fits."""
    relaxing, late = CATALOGUE["viscoelastic_relaxation"], CATALOGUE["force_lag"]
    shares = {"share_1": 0.1, "relaxation_time_1": 0.3}
    tire = TireModel(
        effects=(
            (relaxing, tuple(shares.get(p.name, p.start) for p in relaxing.parameters)),
            (late, (0.003, 0.0, 0.0)),
        )
    )
    verdict = diagnose([ridden(31, tire)])
    assert set(verdict.names) == {"viscoelastic_relaxation", "force_lag"}
    found = {k: p.value for e in verdict.effects for k, p in e.parameters.items()}
    # 5 N of noise on 6000 samples; a delay may stand for a part of the lag.
    assert found["share_1"] == pytest.approx(0.1, rel=0.02)
    assert found["lag"] + found["delay"] == pytest.approx(0.003, rel=0.1)


def test_friction_is_not_forgotten_in_holds_that_are_read_with_noise():
    # half a triangle, a hold of ten seconds half way down, and again: noise counts as travel, so Dahl's element would
    # forget all of its 40 N in the hold (see `rate_independent_hysteresis`): a tenth is allowed here
    legs = np.array([0.0, 2.0, 3.0, 13.0, 14.0, 16.0])
    step = 0.01
    time = np.arange(0.0, 4.0 * legs[-1], step)
    turns = np.concatenate([legs + i * legs[-1] for i in range(4)])
    deflection = np.interp(time, turns, 0.022 * np.tile([0.0, 1.0, 0.5, 0.5, 0.0, 0.0], 4))
    tire = TireModel(
        effects=((CATALOGUE["rate_independent_hysteresis"], (40.0, 0.0, 1e-3, 0.0, 0.6, 0.0, 1.0)),)
    )
    bare = Drive("holds", time, deflection, np.full(time.size, np.inf), np.zeros(time.size))
    verdict = diagnose([read("holds", time, deflection, simulate(tire, bare), 11)])
    assert verdict.names == ("rate_independent_hysteresis",)
    held = np.abs(np.gradient(deflection, step)) < 1e-9
    late = held & (time % legs[-1] > 8.0) & (time % legs[-1] < 13.0)
    read_back = read("holds", time, deflection, simulate(tire, bare), 12)
    left = (read_back.force - simulate(verdict.tire, read_back))[late]
    assert abs(float(np.mean(left))) < 0.1 * 40.0
    assert np.std(left) == pytest.approx(5.0, rel=0.1)


def test_freedoms_of_two_effects_do_not_lead_each_other_astray():
    # Softening measured nearly by energy, partly over a fixed one, beside a damper: woken together with the damper's
    # thinning the fit ended 1.6 noises away.
    time, deflection, _ = ride(7)
    deflection = deflection * (0.4 + 0.6 * time / time[-1])
    softening = (CATALOGUE["mullins_softening"], (0.05, 0.23, 0.0125, 1.2, 0.0, 0.0, 0.86))
    damper = (CATALOGUE["viscous_damping"], (300.0, 1.15, 0.0, 0.0))
    bare = Drive("growing", time, deflection, np.full(time.size, np.inf), np.zeros(time.size))
    force = simulate(TireModel(effects=(softening, damper)), bare)
    verdict = diagnose([read("growing", time, deflection, force, 13, noise=2.0)])
    assert set(verdict.names) == {"mullins_softening", "viscous_damping"}
    # 2 N, and 5e-6 m of the deflection's noise at up to 1.3e5 N/m: 2.1 N; and 3 % more for the fit
    assert verdict.fit.after < 1.08 * 2.0
