"""Penalised least squares on linear problems with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.estimation.minimise import Objective, initial_iterate, minimise

ROWS = 40
RNG = np.random.default_rng(3)
COLUMNS = RNG.normal(size=(ROWS, 3))
DATA = COLUMNS @ np.array([0.4, -0.8, 0.2]) + 0.3 * RNG.normal(size=ROWS)


def objective(high: float = 9.0) -> Objective:
    """Of a linear model with the variance 0.09."""
    ones = np.ones(3)
    return Objective(lambda q: DATA - COLUMNS @ q, -9.0 * ones, high * ones, ones, 0.09)


def test_minimum_of_a_linear_model_is_ridge_regression() -> None:
    found = minimise(objective(), initial_iterate(objective(), np.zeros(3)), 30, 1e-12)
    ridge = np.linalg.solve(COLUMNS.T @ COLUMNS + 0.09 * np.eye(3), COLUMNS.T @ DATA)
    assert found.positions == pytest.approx(ridge, abs=1e-6)
    assert found.converged


def test_minimum_respects_a_bound_and_fits_the_rest() -> None:
    found = minimise(objective(high=0.1), initial_iterate(objective(high=0.1), np.zeros(3)), 30, 1e-12)
    assert found.positions[0] == pytest.approx(0.1)
    rest = COLUMNS[:, 1]
    left = DATA - 0.1 * COLUMNS[:, 0] - found.positions[2] * COLUMNS[:, 2]
    assert found.positions[1] == pytest.approx(rest @ left / (rest @ rest + 0.09), abs=1e-5)
