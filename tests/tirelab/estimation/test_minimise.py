"""Penalised least squares on linear problems with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tirelab.estimation.minimise import Iterate, Objective, held_at_bounds, initial_iterate, minimise

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


def test_slopes_are_computed_once_before_the_last_step() -> None:
    """r = exp(q) - 2 from q = 0.6, V = 1e-4: within a few steps at ln 2, where the slope is 2. It costs a simulation
    for each slope and each step, and no slope after the last of them.
    """
    at: list[float] = []

    def residual(q: NDArray[np.float64]) -> NDArray[np.float64]:
        at.append(float(q[0]))
        return np.exp(q) - 2.0

    one = np.ones(1)
    curved = Objective(residual, -9.0 * one, 9.0 * one, one, 1e-4)
    found = minimise(curved, initial_iterate(curved, 0.6 * one), 30, 0.2)
    assert found.positions[0] == pytest.approx(np.log(2.0), abs=1e-3)
    assert found.jacobian[0, 0] == pytest.approx(2.0, rel=0.01)
    assert at[-1] == found.positions[0]
    assert found.evaluations == len(at)


def test_minimum_respects_a_bound_and_fits_the_rest() -> None:
    found = minimise(objective(high=0.1), initial_iterate(objective(high=0.1), np.zeros(3)), 30, 1e-12)
    assert found.positions[0] == pytest.approx(0.1)
    rest = COLUMNS[:, 1]
    left = DATA - 0.1 * COLUMNS[:, 0] - found.positions[2] * COLUMNS[:, 2]
    assert found.positions[1] == pytest.approx(rest @ left / (rest @ rest + 0.09), abs=1e-5)


def test_what_stands_at_a_bound_is_held_where_the_residual_falls_beyond_it() -> None:
    """r = (2, 0.5, -1) - x at x = (1, 0.5, 0) between 0 and 1: the first is held up, the last down, the second lies
    within; at (1, 1, 1) only the first one is.
    """
    low, high, wanted = np.zeros(3), np.ones(3), np.array([2.0, 0.5, -1.0])

    def held(*at: float) -> list[bool]:
        positions = np.array(at)
        found = Iterate(positions, wanted - positions, -np.eye(3), True, 0)
        return held_at_bounds(found, low, high).tolist()

    assert held(1.0, 0.5, 0.0) == [True, False, True]
    assert held(1.0, 1.0, 1.0) == [True, False, False]
