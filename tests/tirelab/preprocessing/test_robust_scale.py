"""The standard deviation of noise from medians."""

import numpy as np
import pytest
from scipy.stats import norm
from tirelab.preprocessing.robust_scale import MEDIAN_TO_SIGMA, SPIKE_LIMIT, robust_sigma


def test_the_factor_is_that_of_the_normal_law() -> None:
    assert pytest.approx(1.0 / norm.ppf(0.75), abs=1e-4) == MEDIAN_TO_SIGMA


def test_outliers_do_not_move_it() -> None:
    values = 3.0 * np.random.default_rng(1).standard_normal(20_000)
    values[::100] = 1e6
    # Its standard error is 1.17 sigma / sqrt(n) = 0.8 %; a hundredth of outliers adds 1.6 %.
    assert robust_sigma(values) == pytest.approx(3.0, rel=0.04)


def test_a_spike_is_one_in_150_000() -> None:
    assert 1.0 / (2.0 * norm.sf(SPIKE_LIMIT)) == pytest.approx(150_000, rel=0.03)
