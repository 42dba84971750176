"""Rate and direction of a motion, as the pictures show them."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.report.course import loading, rate_of

TIME = np.arange(4000) * 0.005


def test_the_rate_of_a_clean_sine_is_its_derivative() -> None:
    deflection = 0.01 * np.sin(2.0 * np.pi * 0.5 * TIME)
    rate = 0.01 * np.pi * np.cos(2.0 * np.pi * 0.5 * TIME)
    # Central differences over one step h are off by (w h)^2 / 6 = 4e-5; the ends are one-sided, off by w h / 2.
    assert rate_of(TIME, deflection)[1:-1] == pytest.approx(rate[1:-1], abs=1e-4 * np.abs(rate).max())


def test_a_noisy_reading_is_differentiated_over_more_samples() -> None:
    """White noise of 20 um over one sample each side is 2.8 mm/s, as fast as the motion itself."""
    deflection = 0.002 * np.sin(2.0 * np.pi * 0.2 * TIME)
    read = deflection + 2e-5 * np.random.default_rng(1).standard_normal(TIME.size)
    true = 0.002 * 0.4 * np.pi * np.cos(2.0 * np.pi * 0.2 * TIME)
    error = rate_of(TIME, read) - true
    assert np.std(error) < 0.1 * np.std(true)
    assert np.std(np.gradient(read, TIME) - true) > 1.0 * np.std(true)


@pytest.mark.parametrize("samples", [2, 3, 7, 9])
def test_a_few_samples_have_a_rate(samples: int) -> None:
    assert rate_of(TIME[:samples], 0.3 * TIME[:samples]) == pytest.approx(0.3)


def test_a_hold_belongs_to_the_branch_before_it() -> None:
    rate = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.01, -1.0, 0.0, 1.0])
    # What stands still before the first motion belongs to that one.
    assert loading(rate).tolist() == [True] * 6 + [False] * 2 + [True]


def test_what_never_moves_counts_as_loading() -> None:
    assert loading(np.zeros(4)).all()
