"""The evidence of a fitted set against the dense Gaussian law of what it leaves: exact for linear responses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tirelab.estimation.laplace import FORM_SCALES, Linearised, laplace_evidence
from tirelab.selection.discrepancy import Discrepancy

N, EFFECTIVE = 60, 10.0


def at_the_optimum(slopes: np.ndarray, forms: np.ndarray, misfit: np.ndarray, variance: float) -> Linearised:
    """The fit r = misfit - slopes q that minimises |r|^2 / V + |q|^2."""
    k = slopes.shape[1]
    q = np.linalg.solve(slopes.T @ slopes / variance + np.eye(k), slopes.T @ misfit / variance)
    return Linearised(misfit - slopes @ q, -slopes, q, forms, np.zeros(k, dtype=int))


def dense(misfit: np.ndarray, columns: np.ndarray, variance: float) -> float:
    """-1/2 y' S^-1 y - 1/2 ln |S / V| with S = V I + columns columns', the law of y = columns z + noise."""
    covariance = variance * np.eye(N) + columns @ columns.T
    _, determinant = np.linalg.slogdet(covariance / variance)
    return float(-0.5 * misfit @ np.linalg.solve(covariance, misfit) - 0.5 * determinant)


def fixed(variance: float) -> Discrepancy:
    return Discrepancy(N, EFFECTIVE, variance, variance)


def beside(variance: float) -> float:
    """What stands beside the sum of squares in the module's equation of the discrepancy."""
    return 0.5 * (N - EFFECTIVE) / variance - 0.5 * EFFECTIVE * math.log(variance)


@pytest.fixture
def drawn() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    numbers = np.random.default_rng(7)
    slopes, forms = numbers.normal(size=(N, 3)), 0.3 * numbers.normal(size=(N, 5))
    misfit = 3.0 * slopes @ numbers.normal(size=3) + forms @ numbers.normal(size=5) + numbers.normal(size=N)
    return slopes, forms, misfit


@pytest.mark.parametrize("variance", [1.0, 4.0])
def test_without_forms_it_is_the_gaussian_law(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray], variance: float
) -> None:
    slopes, _, misfit = drawn
    found = laplace_evidence(at_the_optimum(slopes, np.zeros((N, 0)), misfit, variance), fixed(variance))
    assert found.log_likelihood == pytest.approx(dense(misfit, slopes, variance) + beside(variance), rel=1e-9)
    assert found.variance == pytest.approx(variance)


@pytest.mark.parametrize("variance", [1.0, 4.0])
def test_with_forms_it_is_the_gaussian_law_at_the_likeliest_scale(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray], variance: float
) -> None:
    slopes, forms, misfit = drawn
    found = laplace_evidence(at_the_optimum(slopes, forms, misfit, variance), fixed(variance))
    # Half-Cauchy over the scale: its density at s, over that at 1.
    each = {
        s: dense(misfit, np.hstack([slopes, s * forms]), variance) - math.log((1.0 + s**2) / 2.0)
        for s in FORM_SCALES
    }
    assert found.log_likelihood == pytest.approx(max(each.values()) + beside(variance), rel=1e-9)
    assert found.scale == max(each, key=lambda s: each[s])


def test_what_forms_cannot_explain_is_left(drawn: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    slopes, forms, _ = drawn
    everything = np.hstack([slopes, forms])
    outside = np.linalg.svd(everything)[0][:, -1]
    found = laplace_evidence(at_the_optimum(slopes, forms, 5.0 * outside, 1.0), fixed(1.0))
    np.testing.assert_allclose(found.unformed, 5.0 * outside, atol=1e-9)


def test_a_scale_of_the_laws_prior_is_found() -> None:
    """One column of the law far beyond its prior: the largest scale is taken, and the evidence is that of its prior."""
    numbers = np.random.default_rng(3)
    column = numbers.normal(size=(N, 1))
    misfit = 40.0 * column[:, 0] + numbers.normal(size=N)
    fit = at_the_optimum(column, np.zeros((N, 0)), misfit, 1.0)
    grouped = Linearised(fit.residual, fit.slopes, fit.positions, fit.forms, np.array([1]))
    gained = (
        laplace_evidence(grouped, fixed(1.0)).log_likelihood
        - laplace_evidence(fit, fixed(1.0)).log_likelihood
    )
    curvature, q = float(column[:, 0] @ column[:, 0]), float(fit.positions[0])
    # The prior costs q^2 / 2 at its own width and a hundredth of that at ten times; the width costs by Occam's factor.
    expected = 0.5 * q**2 * 0.99 - 0.5 * math.log((1.0 + 100.0 * curvature) / (1.0 + curvature))
    assert gained == pytest.approx(expected, rel=1e-9)
