"""The sets that are fitted first, on a ride of 500 N s/m of damping under 5 N of noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import damped
from radialtire import TireModel
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


def test_nothing_and_what_the_signatures_find_are_fitted_first() -> None:
    _, sets = first_of(damped(1, samples=2000))
    assert frozenset() in sets.fits
    assert sets.best() == {"viscous_damping"}


def test_sets_begin_anew_only_where_blocks_distort_a_response_by_more_than_noise() -> None:
    """A lag shorter than a block differs from that between the samples; nothing is left out of the law itself."""
    long = damped(1, samples=16_000)
    noise = 0.01 * np.random.default_rng(2).normal(size=long.time.size)
    exact = arranged(TireModel(), [("viscous_damping", (500.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))])
    first, sets = first_of(replace(long, force=simulate(exact, long) + noise))
    (e,) = sets.dataset.experiments
    assert e.size > 1
    assert first.less_distorted(sets, TireModel()) is sets
    again = first.less_distorted(sets, arranged(exact, [("force_lag", (0.4 * e.interval, 0.0, 0.0))]))
    assert again is not sets
    assert np.any(again.dataset.experiments[0].left_out)
