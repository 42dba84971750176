"""The evidence of a fitted set against the dense Gaussian law of what it leaves: exact for linear responses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import multivariate_normal
from tirelab.estimation.evidence import DRIFT_SCALES, FORM_SCALES, Linearised, laplace_evidence
from tirelab.estimation.minimise import Objective, initial_iterate, minimise
from tirelab.selection.search import Discrepancy

ROWS = 40
RNG = np.random.default_rng(3)
COLUMNS = RNG.normal(size=(ROWS, 3))
DATA = COLUMNS @ np.array([0.4, -0.8, 0.2]) + 0.3 * RNG.normal(size=ROWS)


def objective() -> Objective:
    """Of a linear model with the variance 0.09."""
    ones = np.ones(3)
    return Objective(lambda q: DATA - COLUMNS @ q, -9.0 * ones, 9.0 * ones, ones, 0.09)


ERROR = 1e-4
"""A form error so small that no scale is cut short."""


def linearised(*forms: np.ndarray) -> Linearised:
    """The linear model at its optimum, beside the columns of each effect's form errors."""
    found = minimise(objective(), initial_iterate(objective(), np.zeros(3)), 30, 1e-14)
    errors = (ERROR,) * len(forms)
    return Linearised(
        *(found.residual, found.jacobian, found.positions, forms, errors),
        *(np.zeros((ROWS, 0)), np.zeros(3, dtype=int), np.ones(3)),
    )


FIXED = Discrepancy(ROWS, float(ROWS), 0.09, 0.0900001)
"""White noise of the variance 0.09 and nothing else."""


def cost(scale: float) -> float:
    """Half-Cauchy above 1, its density there over that at the scale; below 1 the chance of a form as good as that."""
    return -math.log(scale) if scale < 1.0 else math.log((1.0 + scale**2) / 2.0)


def density(covariance: np.ndarray) -> float:
    """Log density of the data, without the constant that the evidence leaves out."""
    return float(
        multivariate_normal(np.zeros(ROWS), covariance).logpdf(DATA) + 0.5 * ROWS * np.log(2.0 * np.pi)
    )


def test_laplace_evidence_of_a_linear_model_is_exact() -> None:
    evidence = laplace_evidence(linearised(), FIXED)
    expected = density(0.09 * np.eye(ROWS) + COLUMNS @ COLUMNS.T)
    assert evidence.log_likelihood == pytest.approx(expected, abs=1e-4)


def test_form_errors_are_one_more_covariance_under_a_half_cauchy_scale() -> None:
    forms = 0.2 * np.random.default_rng(4).normal(size=(ROWS, 2))
    evidence = laplace_evidence(linearised(forms), FIXED)
    linear = 0.09 * np.eye(ROWS) + COLUMNS @ COLUMNS.T
    expected = [density(linear + s**2 * forms @ forms.T) - cost(s) for s in FORM_SCALES]
    assert evidence.log_likelihood == pytest.approx(max(expected), abs=1e-4)
    assert evidence.scales == pytest.approx([FORM_SCALES[int(np.argmax(expected))]])


def test_what_only_mends_a_form_explains_nothing_that_the_form_errors_do_not() -> None:
    shape = np.linspace(-1.0, 1.0, ROWS)
    forms = np.column_stack([shape, np.ones(ROWS)])
    near = linearised(forms)
    wrong = replace(near, residual=near.residual + 2.0 * shape)
    beyond_forms = laplace_evidence(wrong, FIXED).beyond_forms
    assert beyond_forms @ beyond_forms < 1.2 * (near.residual @ near.residual)
    assert wrong.residual @ wrong.residual > 5.0 * (near.residual @ near.residual)


N, EFFECTIVE = 60, 10.0


def at_the_optimum(
    slopes: np.ndarray, forms: tuple[np.ndarray, ...], misfit: np.ndarray, variance: float
) -> Linearised:
    """The fit r = misfit - slopes q that minimises |r|^2 / V + |q|^2."""
    k = slopes.shape[1]
    q = np.linalg.solve(slopes.T @ slopes / variance + np.eye(k), slopes.T @ misfit / variance)
    errors = (ERROR,) * len(forms)
    no_drift = np.zeros((N, 0))
    return Linearised(
        misfit - slopes @ q, -slopes, q, forms, errors, no_drift, np.zeros(k, dtype=int), np.ones(k)
    )


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


def test_a_prior_of_another_width_is_that_gaussian_law_less_the_cost_of_the_width(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    """Half-Cauchy, 2 / (pi (1 + s^2)), beside that of 1: ln((1 + s^2) / 2) for each."""
    slopes, _, misfit = drawn
    widths = np.array([1.0, 5.0, 12.0])
    scaled = at_the_optimum(slopes * widths, (), misfit, 2.0)
    near = replace(scaled, slopes=scaled.slopes / widths, positions=scaled.positions * widths, widths=widths)
    found = laplace_evidence(near, fixed(2.0))
    expected = (
        dense(misfit, slopes * widths, 2.0) + beside(2.0) - math.log(26.0 / 2.0) - math.log(145.0 / 2.0)
    )
    assert found.log_likelihood == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("variance", [1.0, 4.0])
def test_without_forms_it_is_the_gaussian_law(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray], variance: float
) -> None:
    slopes, _, misfit = drawn
    found = laplace_evidence(at_the_optimum(slopes, (), misfit, variance), fixed(variance))
    assert found.log_likelihood == pytest.approx(dense(misfit, slopes, variance) + beside(variance), rel=1e-9)
    assert found.variance == pytest.approx(variance)


@pytest.mark.parametrize("variance", [1.0, 4.0])
def test_with_forms_it_is_the_gaussian_law_at_the_likeliest_scale(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray], variance: float
) -> None:
    slopes, forms, misfit = drawn
    found = laplace_evidence(at_the_optimum(slopes, (forms,), misfit, variance), fixed(variance))
    each = {s: dense(misfit, np.hstack([slopes, s * forms]), variance) - cost(s) for s in FORM_SCALES}
    assert found.log_likelihood == pytest.approx(max(each.values()) + beside(variance), rel=1e-9)
    assert found.scales == pytest.approx([max(each, key=lambda s: each[s])])


def test_a_form_that_misses_nothing_pays_for_that_chance_and_for_no_coefficients() -> None:
    """Of coefficients of any size, 10 000 times the noise, none is seen: at the scale 1 they cost their determinant."""
    forms = 1e4 * np.linalg.qr(np.random.default_rng(5).normal(size=(ROWS, 5)))[0]
    exact = replace(linearised(forms), residual=0.01 * linearised(forms).residual)
    found = laplace_evidence(exact, FIXED)
    assert found.scales == pytest.approx([min(FORM_SCALES)])


def test_each_form_finds_its_own_scale(drawn: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    """What one effect's form misses widely is no reason to believe less of another's."""
    slopes, forms, _ = drawn
    far, near = forms[:, :2], forms[:, 2:]
    misfit = 30.0 * far @ np.array([1.0, -1.0]) + np.random.default_rng(9).normal(size=N)
    found = laplace_evidence(at_the_optimum(slopes, (far, near), misfit, 1.0), fixed(1.0))
    assert found.scales == pytest.approx([30.0, 1.0])
    scaled = np.hstack([slopes, 30.0 * far, near])
    expected = dense(misfit, scaled, 1.0) - math.log((1.0 + 30.0**2) / 2.0) + beside(1.0)
    assert found.log_likelihood == pytest.approx(expected, rel=1e-9)


def test_no_form_misses_more_than_its_effect(drawn: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    slopes, forms, _ = drawn
    misfit = 300.0 * forms @ np.ones(5)
    fit = replace(at_the_optimum(slopes, (forms,), misfit, 1.0), errors=(0.05,))
    assert laplace_evidence(fit, fixed(1.0)).scales == pytest.approx([20.0])


def test_what_forms_cannot_explain_is_left(drawn: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    slopes, forms, _ = drawn
    everything = np.hstack([slopes, forms])
    outside = np.linalg.svd(everything)[0][:, -1]
    found = laplace_evidence(at_the_optimum(slopes, (forms,), 5.0 * outside, 1.0), fixed(1.0))
    np.testing.assert_allclose(found.beyond_forms, 5.0 * outside, atol=1e-9)


def test_a_drift_is_one_more_covariance_beside_any_set_and_explains_nothing(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    """What drifts as far as a tenth of the misfit allows: its scale has the probability of so small a one."""
    slopes, forms, _ = drawn
    drift = 30.0 * np.random.default_rng(6).normal(size=(N, 4))
    misfit = 0.1 * drift @ np.array([1.0, -1.0, 0.5, 1.0]) + np.random.default_rng(9).normal(size=N)
    found = laplace_evidence(replace(at_the_optimum(slopes, (forms,), misfit, 1.0), drift=drift), fixed(1.0))
    each = {
        (s, d): dense(misfit, np.hstack([slopes, s * forms, d * drift]), 1.0) - cost(s) - cost(d)
        for s in FORM_SCALES
        for d in DRIFT_SCALES
    }
    scale, size = max(each, key=lambda pair: each[pair])
    assert found.log_likelihood == pytest.approx(each[scale, size] + beside(1.0), rel=1e-9)
    assert (found.scales[0], found.drift) == (scale, size)
    assert size == pytest.approx(0.1)
    # what drifts stays a remainder, and is no noise
    assert found.beyond_drift @ found.beyond_drift < 2.0 * N
    assert found.beyond_forms @ found.beyond_forms > 0.5 * (misfit @ misfit)


def test_no_drift_costs_the_smallest_scale_and_no_coefficients(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    slopes, _, _ = drawn
    misfit = np.random.default_rng(9).normal(size=N)
    drift = 1e4 * np.random.default_rng(6).normal(size=(N, 4))
    found = laplace_evidence(replace(at_the_optimum(slopes, (), misfit, 1.0), drift=drift), fixed(1.0))
    assert found.drift == 0.0
    expected = dense(misfit, slopes, 1.0) - cost(min(DRIFT_SCALES)) + beside(1.0)
    assert found.log_likelihood == pytest.approx(expected, rel=1e-9)


def test_freedom_counts_what_the_data_determine(drawn: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    """Of columns of very unequal size those far above the noise count whole and those far below not at all."""
    slopes, _, misfit = drawn
    base = np.linalg.qr(slopes)[0]
    unequal = base * np.array([1e3, 1e-3, *(1.0,) * (base.shape[1] - 2)])
    found = laplace_evidence(at_the_optimum(unequal, (), misfit, 1.0), fixed(1.0))
    assert found.freedom == pytest.approx(1.0 + 0.5 * (base.shape[1] - 2), abs=1e-4)


def test_a_scale_of_the_laws_prior_is_found() -> None:
    """One column of the law far beyond its prior: the largest scale is taken, and the evidence is that of its prior."""
    numbers = np.random.default_rng(3)
    column = numbers.normal(size=(N, 1))
    misfit = 40.0 * column[:, 0] + numbers.normal(size=N)
    fit = at_the_optimum(column, (), misfit, 1.0)
    grouped = replace(fit, groups=np.array([1]))
    gained = (
        laplace_evidence(grouped, fixed(1.0)).log_likelihood
        - laplace_evidence(fit, fixed(1.0)).log_likelihood
    )
    curvature, q = float(column[:, 0] @ column[:, 0]), float(fit.positions[0])
    # The prior costs q^2 / 2 at its own width, 1 / 900 of that at thirty times; the width costs by Occam's factor.
    expected = 0.5 * q**2 * (1.0 - 1.0 / 900.0) - 0.5 * math.log(
        (1.0 + 900.0 * curvature) / (1.0 + curvature)
    )
    assert gained == pytest.approx(expected, rel=1e-9)
    assert laplace_evidence(grouped, fixed(1.0)).law_scales == {1: 30.0}
    assert laplace_evidence(fit, fixed(1.0)).law_scales == {}


def test_a_group_of_parameters_that_nothing_changes_costs_nothing(
    drawn: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    """However well it is determined: with the prior as declared it would cost the log of how much narrower it gets."""
    slopes, _, misfit = drawn
    beside = slopes / np.linalg.norm(slopes, axis=0)
    other = np.random.default_rng(8).normal(size=(N, 2))
    other -= beside @ np.linalg.lstsq(beside, other, rcond=None)[0]
    other -= misfit[:, None] * (misfit @ other) / (misfit @ misfit)
    whole = at_the_optimum(np.hstack([slopes, 1e3 * other]), (), misfit, 1.0)
    without = laplace_evidence(at_the_optimum(slopes, (), misfit, 1.0), fixed(1.0)).log_likelihood
    grouped = replace(whole, groups=np.array([0, 0, 0, 1, 1]))
    assert laplace_evidence(grouped, fixed(1.0)).log_likelihood == pytest.approx(without, abs=1.0)
    assert laplace_evidence(whole, fixed(1.0)).log_likelihood < without - 2.0 * math.log(1e3)
