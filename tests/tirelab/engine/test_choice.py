"""What is believed earns its place in the catalogue's own form, within the catalogue's bounds."""

from dataclasses import replace

import numpy as np
import pytest
from drives import read, ride
from fits import BARE, fitted, ridden, with_effect
from settled_sets import settled
from tirelab.diagnosis.diagnose import diagnose
from tirelab.engine import choice
from tirelab.simulation.simulate import simulate


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


def test_a_set_that_leaves_more_than_the_believed_tire_did_is_not_believed(monkeypatch):
    recording = ridden(3, with_effect("force_offset", offset=20.0))
    fit, cases, scene = fitted(recording, with_effect("force_offset", offset=20.0), ["force_offset"])
    tires = {"series_compliance": with_effect("series_compliance", compliance=1e-6), "force_offset": fit.tire}
    monkeypatch.setattr(choice, "fitted_set", lambda s, *_: replace(fit, tire=tires[s.names[0]]))
    monkeypatch.setattr(choice, "_gains", lambda s, fitted, *_: ({}, fitted))
    sets = [settled(100.0, {"series_compliance": 1.0}), settled(98.0, {"force_offset": 1.0})]
    order, chosen = choice.choose(sets, BARE, cases, scene, 1.0)
    assert chosen.tire == fit.tire
    assert [s.names for s in order] == [("force_offset",), ("series_compliance",)]
