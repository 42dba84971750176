"""The sets that are fitted first, on a ride of 500 N s/m of damping under 5 N of noise."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drives import damped
from radialtire import TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.estimation.first_sets import FirstSets, in_quiet_units, with_signatures
from tirelab.estimation.ranking import MOST_WORK, FittedSets
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import arranged, dataset_of, samples_of
from tirelab.simulation.simulate import simulate

NAMES = ("viscous_damping", "rate_independent_hysteresis", "inertia")


def first_of(recording: Recording) -> tuple[FirstSets, FittedSets]:
    dataset, raw, quiet = with_signatures(
        dataset_of([recording], TireModel()), [recording], NAMES, ("recalibration", *NAMES)
    )
    first = FirstSets(dataset, raw, samples_of([recording], TireModel()), None, MOST_WORK)
    return first, first.begun(quiet)


def test_the_noise_is_that_beside_what_all_effects_together_explain() -> None:
    """The misfit of 500 N s/m is many times the noise, of which a block's mean has its part."""
    dataset = dataset_of([damped(1, samples=2000)], TireModel())
    (loud,), (quiet,) = dataset.experiments, in_quiet_units(dataset).experiments
    assert np.std(loud.misfit) > 2.0 * quiet.noise
    # The reading of the deflection adds its noise through stiffness and damping.
    assert quiet.noise * np.sqrt(quiet.size) == pytest.approx(5.0, rel=0.2)


def test_noise_that_is_louder_in_motion_is_that_of_moving_blocks() -> None:
    """A tenth of the samples moves, under 20 N beside 1 N: together the root of 0.9 + 0.1 x 400 N^2."""
    time = np.arange(0.0, 400.0, 0.1)
    x = np.interp(time % 100.0, [0.0, 5.0, 50.0, 55.0, 100.0], [2e-3, 0.02, 0.02, 2e-3, 2e-3])
    noise = np.where(np.gradient(x, time) ** 2 < 1e-8, 1.0, 20.0)
    silent = Recording("holds", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    force = simulate(TireModel(), silent) + noise * np.random.default_rng(5).normal(size=time.size)
    holds = replace(silent, force=force)
    dataset = in_quiet_units(dataset_of([holds], TireModel()))
    (e,) = dataset.experiments
    assert e.size == 1
    moves = np.abs(e.rate) > 1e-4
    assert np.median(e.noises[moves]) == pytest.approx(20.0, rel=0.15)
    assert np.median(e.noises[~moves]) == pytest.approx(1.0, rel=0.15)
    assert e.floor.level == pytest.approx(np.sqrt(0.9 + 0.1 * 400.0), rel=0.15)
    assert float(np.mean(dataset.misfit**2)) == pytest.approx(1.0, rel=0.2)
    (along,) = samples_of([holds], TireModel()).noises(dataset)
    assert np.median(along[noise == 20.0]) == pytest.approx(20.0, rel=0.15)


def test_noise_that_grows_with_the_load_counts_where_it_is() -> None:
    """2 N and 1 % of a force of up to 1.9 kN: a tenth of them at the top, and no misfit there."""
    time = np.arange(0.0, 40.0, 0.01)
    x = 0.02 * (1.0 - np.abs(2.0 * (time / 8.0 % 1.0) - 1.0))
    silent = Recording("slow", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    force = simulate(TireModel(), silent)
    loud = np.hypot(2.0, 0.01 * force)
    given = replace(silent, force=force + loud * np.random.default_rng(5).normal(size=time.size))
    dataset = in_quiet_units(dataset_of([given], TireModel()))
    (e,) = dataset.experiments
    (along,) = samples_of([given], TireModel()).noises(dataset)
    # At the ends the level is that of the outermost eighth of the loads.
    np.testing.assert_allclose(along, loud, rtol=0.25)
    np.testing.assert_allclose(e.noises * np.sqrt(e.size), np.hypot(2.0, 0.01 * e.baseline), rtol=0.25)
    assert e.floor.level == pytest.approx(float(np.sqrt(np.mean(loud**2))), rel=0.1)
    verdict = diagnose([given])
    assert verdict.names == ()
    assert verdict.where == ()


def test_nothing_and_what_the_signatures_find_are_fitted_first() -> None:
    _, sets = first_of(damped(1, samples=2000))
    assert frozenset() in sets.fits
    assert sets.best() == {"viscous_damping"}


@pytest.mark.slow
def test_sets_begin_anew_only_where_blocks_distort_a_response_by_more_than_noise() -> None:
    """A lag shorter than a block differs from that between the samples; nothing is left out of the law itself."""
    long = damped(1, samples=16_000)
    noise = 0.01 * np.random.default_rng(2).normal(size=long.time.size)
    exact = arranged(TireModel(), [("viscous_damping", (500.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))])
    first, sets = first_of(replace(long, force=simulate(exact, long) + noise))
    (e,) = sets.dataset.experiments
    assert e.size > 1
    assert first.less_distorted(sets, sets.fits[frozenset()]) is sets
    late = arranged(exact, [("force_lag", (0.4 * e.interval, 0.0, 0.0))])
    values = {**sets.best_fit.values, "inertia": (1.0,)}
    fit: Any = SimpleNamespace(tire=late, values=values, variance=sets.best_fit.variance)
    again = first.less_distorted(sets, fit)
    assert again is not sets
    assert np.any(again.dataset.experiments[0].left_out)
    # what was found before is not lost, whether or not the signatures find it again
    assert frozenset(values) in again.fits
