"""What the recordings ask of an effect that it cannot be: a strength at its limit, a ceiling that readings pass."""

from __future__ import annotations

import numpy as np
import pytest
from drives import damped
from radialtire import TireModel
from tirelab.estimation.problem import problem_of
from tirelab.estimation.valid_ranges import beyond_range
from tirelab.regressors.dataset import Dataset, dataset_of

DATASET: Dataset = dataset_of([damped(4, samples=2000)], TireModel())
(RIDE,) = DATASET.experiments
READ = np.sort((RIDE.baseline + RIDE.misfit)[RIDE.counts])
"""Forces [N] of the counted blocks, in rising order."""


def asked_of(ceiling: float) -> tuple[str, ...]:
    problem = problem_of(DATASET, {"saturation": (ceiling, 0.0)}, plain=True)
    positions = problem.positions(problem.held)
    return beyond_range(problem, np.zeros(positions.size, dtype=bool), positions)


def test_no_reading_passes_a_ceiling() -> None:
    """Of its eleventh highest reading ten are above it; by how much in noises is a matter of where it is put."""
    most = RIDE.noises.max() * 6.0
    assert asked_of(float(READ[-1])) == ()
    assert asked_of(float(READ[-10]) - most) == ("saturation",)


def test_a_few_readings_or_noise_above_a_ceiling_refute_nothing() -> None:
    assert asked_of(float(READ[-9])) == ()
    assert asked_of(float(READ[-1]) - 2.0 * RIDE.noises.min()) == ()


@pytest.mark.parametrize(("held", "beyond"), [(True, ("force_lag",)), (False, ())])
def test_a_strength_that_is_held_at_its_largest_is_beyond_its_range(
    held: bool, beyond: tuple[str, ...]
) -> None:
    problem = problem_of(DATASET, {"force_lag": (1.0, 0.0, 0.0)}, plain=True)
    positions = problem.positions(problem.held)
    assert beyond_range(problem, np.full(positions.size, held), positions) == beyond


def test_an_effect_that_vanishes_at_its_limit_is_in_its_range() -> None:
    problem = problem_of(DATASET, {"viscous_damping": (0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)}, plain=True)
    positions = problem.low.copy()
    assert beyond_range(problem, np.ones(positions.size, dtype=bool), positions) == ()
