"""The standard deviation of noise from its bulk."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm
from tirelab.preprocessing.spread import MEDIAN_TO_SIGMA, robust_sigma, trimmed_sigma


def test_the_factor_is_that_of_the_normal_law() -> None:
    assert pytest.approx(1.0 / norm.ppf(0.75), abs=1e-4) == MEDIAN_TO_SIGMA


def test_outliers_do_not_move_it() -> None:
    values = 3.0 * np.random.default_rng(1).standard_normal(20_000)
    values[::100] = 1e6
    # Its standard error is 1.17 sigma / sqrt(n) = 0.8 %; a hundredth of outliers adds 1.6 %.
    assert robust_sigma(values) == pytest.approx(3.0, rel=0.04)


def test_what_is_trimmed_of_a_normal_law_is_made_up_for() -> None:
    # Its standard error is 0.76 sigma / sqrt(n) = 0.2 %.
    assert trimmed_sigma(3.0 * np.random.default_rng(1).standard_normal(100_000)) == pytest.approx(
        3.0, rel=0.01
    )


def test_far_values_are_trimmed() -> None:
    values = 3.0 * np.random.default_rng(1).standard_normal(20_000)
    values[::50] = 1e6
    assert trimmed_sigma(values) == pytest.approx(3.0, rel=0.03)


def test_values_of_which_most_are_zero_have_no_median_but_a_scale() -> None:
    values = np.zeros(10_000)
    values[::4] = 1.0
    assert robust_sigma(values) == 0.0
    assert trimmed_sigma(values) == pytest.approx(0.5, rel=0.02)


def test_nothing_but_outliers_is_no_noise() -> None:
    values = np.zeros(100)
    values[::10] = 1.0
    assert trimmed_sigma(values) == 0.0
