"""Penalised least squares and the evidence of their result, on linear problems with known answers."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal
from tirelab.estimation.laplace import FORM_SCALES, Linearised, laplace_evidence
from tirelab.estimation.least_squares import Objective, begun, minimised
from tirelab.selection.discrepancy import Discrepancy

ROWS = 40
RNG = np.random.default_rng(3)
COLUMNS = RNG.normal(size=(ROWS, 3))
DATA = COLUMNS @ np.array([0.4, -0.8, 0.2]) + 0.3 * RNG.normal(size=ROWS)


def objective(high: float = 9.0) -> Objective:
    """Of a linear model with the variance 0.09."""
    ones = np.ones(3)
    return Objective(lambda q: DATA - COLUMNS @ q, -9.0 * ones, high * ones, ones, 0.09)


def test_minimum_of_a_linear_model_is_ridge_regression() -> None:
    found = minimised(objective(), begun(objective(), np.zeros(3)), 30, 1e-12)
    ridge = np.linalg.solve(COLUMNS.T @ COLUMNS + 0.09 * np.eye(3), COLUMNS.T @ DATA)
    assert found.positions == pytest.approx(ridge, abs=1e-6)
    assert found.settled


def test_minimum_respects_a_bound_and_fits_the_rest() -> None:
    found = minimised(objective(high=0.1), begun(objective(high=0.1), np.zeros(3)), 30, 1e-12)
    assert found.positions[0] == pytest.approx(0.1)
    rest = COLUMNS[:, 1]
    left = DATA - 0.1 * COLUMNS[:, 0] - found.positions[2] * COLUMNS[:, 2]
    assert found.positions[1] == pytest.approx(rest @ left / (rest @ rest + 0.09), abs=1e-5)


def linearised(forms: np.ndarray) -> Linearised:
    """The linear model at its optimum, beside the columns of form errors."""
    found = minimised(objective(), begun(objective(), np.zeros(3)), 30, 1e-14)
    return Linearised(found.residual, found.jacobian, found.positions, forms, np.zeros(3, dtype=int))


FIXED = Discrepancy(ROWS, float(ROWS), 0.09, 0.0900001)
"""White noise of the variance 0.09 and nothing else."""


def density(covariance: np.ndarray) -> float:
    """Log density of the data, without the constant that the evidence leaves out."""
    return float(
        multivariate_normal(np.zeros(ROWS), covariance).logpdf(DATA) + 0.5 * ROWS * np.log(2.0 * np.pi)
    )


def test_laplace_evidence_of_a_linear_model_is_exact() -> None:
    evidence = laplace_evidence(linearised(np.zeros((ROWS, 0))), FIXED)
    expected = density(0.09 * np.eye(ROWS) + COLUMNS @ COLUMNS.T)
    assert evidence.log_likelihood == pytest.approx(expected, abs=1e-4)


def test_form_errors_are_one_more_covariance_under_a_half_cauchy_scale() -> None:
    forms = 0.2 * np.random.default_rng(4).normal(size=(ROWS, 2))
    evidence = laplace_evidence(linearised(forms), FIXED)
    linear = 0.09 * np.eye(ROWS) + COLUMNS @ COLUMNS.T
    expected = [density(linear + s**2 * forms @ forms.T) + np.log(2.0 / (1.0 + s**2)) for s in FORM_SCALES]
    assert evidence.log_likelihood == pytest.approx(max(expected), abs=1e-4)
    assert evidence.scale == FORM_SCALES[int(np.argmax(expected))]


def test_what_only_mends_a_form_explains_nothing_that_the_form_errors_do_not() -> None:
    shape = np.linspace(-1.0, 1.0, ROWS)
    forms = np.column_stack([shape, np.ones(ROWS)])
    near = linearised(forms)
    wrong = Linearised(near.residual + 2.0 * shape, near.slopes, near.positions, forms, near.groups)
    unformed = laplace_evidence(wrong, FIXED).unformed
    assert unformed @ unformed < 1.2 * (near.residual @ near.residual)
    assert wrong.residual @ wrong.residual > 5.0 * (near.residual @ near.residual)
