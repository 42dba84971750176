"""What a remainder costs."""

import numpy as np
import pytest
from radialtire import CATALOGUE
from scipy.optimize import minimize_scalar
from scipy.stats import norm
from tirelab.selection.discrepancy import Discrepancy, discrepancy_of, usual_form_error


def test_likelihood_is_that_of_as_many_normal_samples_as_are_effective() -> None:
    values = np.random.default_rng(1).normal(0.0, 3.0, 12)
    discrepancy = Discrepancy(500, 12.0, 1.0, 1e6)
    power = float(values @ values) + 488.0  # the other samples hold noise alone
    density = norm(0.0, np.sqrt(7.0)).logpdf(values).sum() + 6.0 * np.log(2.0 * np.pi)
    assert discrepancy.likelihood(power, 7.0) == pytest.approx(density)


def test_profile_is_the_top_over_the_variance() -> None:
    discrepancy = Discrepancy(400, 20.0, 1.0, 1e6)
    top, variance = discrepancy.profile(2000.0)
    found = minimize_scalar(lambda v: -discrepancy.likelihood(2000.0, v), bounds=(1.0, 1e4), method="bounded")
    assert variance == pytest.approx(found.x, rel=1e-3)
    assert top == pytest.approx(-found.fun)


def test_form_error_lifts_the_lowest_variance() -> None:
    misfit = np.full(600, 10.0)
    plain = discrepancy_of(misfit, 0.0)
    lifted = plain.above(0.5)
    assert plain.lowest == 1.0
    assert lifted.size(lifted.lowest) == pytest.approx(0.5)


def test_the_usual_error_lies_between_the_least_and_the_largest_declared() -> None:
    declared = [effect.form_error for effect in CATALOGUE.values()]
    assert min(declared) < usual_form_error() < max(declared)
