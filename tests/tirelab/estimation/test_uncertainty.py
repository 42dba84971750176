"""Uncertainties of fitted parameters."""

from __future__ import annotations

import numpy as np
from tirelab.estimation.uncertainty import _covariance


def test_the_covariance_is_that_of_the_posterior() -> None:
    """(S^T S + 1)^-1, by the textbook's formula where that is well conditioned, for more and for fewer samples."""
    for samples in (40, 3):
        slopes = np.random.default_rng(1).normal(size=(samples, 5))
        np.testing.assert_allclose(
            _covariance(slopes), np.linalg.inv(slopes.T @ slopes + np.eye(5)), rtol=1e-9, atol=1e-12
        )


def test_no_variance_is_negative_where_the_data_know_a_sum_far_better_than_its_parts() -> None:
    """Two equal columns of 1e9: the sum is known, of the difference the prior is all: variance 1/2 for each."""
    alike = 1e9 * np.ones((50, 2)) / np.sqrt(50.0)
    found = _covariance(np.column_stack([alike, np.linspace(0.0, 1e-3, 50)]))
    assert np.all(np.diag(found) > 0.0)
    np.testing.assert_allclose(np.diag(found)[:2], 0.5, rtol=1e-6)
