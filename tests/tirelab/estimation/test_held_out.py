"""Held-out recordings judge a set as far as they move within what is fitted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import flat_force
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.estimation.held_out import held_out_of
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import samples_of

PART = TireModel(two_sided=True, inflated=False, tested_range=None)


def pressed(name: str, shallow: float, deep: float, radius: float = np.inf, seed: int = 1) -> Recording:
    """Return a slow press between two deflections [m]."""
    time = np.linspace(0.0, 20.0, 2000)
    x = np.linspace(shallow, deep, time.size)
    force = flat_force(x) + np.random.default_rng(seed).normal(size=time.size)
    return Recording(name, time, x, np.full(time.size, radius), force)


def counted(held_out: Recording, *fitted: Recording) -> float:
    """Return the deepest deflection [m] of a held-out recording that counts beside fitted ones; 0 where none does."""
    found = held_out_of([held_out], TireModel(), samples_of(fitted, TireModel()))
    return (
        0.0 if found is None else max(float(e.deflection[e.counts].max()) for e in found.dataset.experiments)
    )


def test_what_is_deeper_than_all_that_is_fitted_does_not_count() -> None:
    shallow = pressed("shallow", 0.0, 0.010)
    assert 0.0099 < counted(pressed("deep", 0.0, 0.020, seed=2), shallow) <= 0.0101
    assert counted(pressed("alike", 0.001, 0.009, seed=3), shallow) > 0.0089
    assert counted(pressed("beyond", 0.012, 0.020, seed=4), shallow) == 0.0


def test_a_surface_has_its_own_deflections_if_it_is_fitted() -> None:
    flat, drum = pressed("flat", 0.0, 0.010), pressed("drum", 0.0, 0.020, radius=0.3)
    assert counted(pressed("deep", 0.0, 0.020, seed=2), flat, drum) <= 0.0101
    assert counted(pressed("other", 0.0, 0.020, radius=-0.3, seed=2), flat, drum) > 0.0198


@pytest.mark.slow
def test_a_law_that_goes_on_as_it_was_is_no_relaxation() -> None:
    """A part whose spring softens, pulled once at one speed, and held out farther: its force is that of the deflection.

    A relaxation that happened to bend as it does beyond what was fitted was sure (99 %).
    """
    time = np.linspace(0.0, 200.0, 2000)
    x = 1e-4 * time
    force = 30.0 * (1.0 - np.exp(-x / 0.015)) + 0.03 * np.random.default_rng(11).normal(size=time.size)
    ends = slice(0, 1600), slice(1600, 2000)
    fitted, deeper = (
        Recording(f"{s.start}", time[s], x[s], np.full(x[s].size, np.inf), force[s]) for s in ends
    )
    linear = PowerLaw(19.0, 1.0)
    verdict = diagnose([fitted], replace(PART, law=linear), held_out=[deeper])
    assert verdict.names == ("recalibration",)
