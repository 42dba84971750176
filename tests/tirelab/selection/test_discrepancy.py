"""What a remainder costs."""

import numpy as np
import pytest
from radialtire import CATALOGUE
from scipy.optimize import minimize_scalar
from scipy.stats import norm
from tirelab.selection.discrepancy import Discrepancy, discrepancy_of, usual_form_error


def test_likelihood_is_that_of_as_many_normal_samples_as_are_effective() -> None:
    values = np.random.default_rng(1).normal(0.0, 3.0, 12)
    discrepancy = Discrepancy(500, 12.0, 1.0, 1e6, 1.0)
    power = float(values @ values) + 488.0  # the other samples hold noise alone
    density = norm(0.0, np.sqrt(7.0)).logpdf(values).sum() + 6.0 * np.log(2.0 * np.pi)
    assert discrepancy.likelihood(power, 7.0) == pytest.approx(density)


def test_profile_is_the_top_over_the_variance() -> None:
    discrepancy = Discrepancy(400, 20.0, 1.0, 1e6, 1.0)
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


def test_under_a_floor_only_a_remainder_like_the_noise_counts_for_a_set() -> None:
    """Forms that miss ten noises: a remainder of three or of eight is alike; one like the noise has exact forms."""
    floor = discrepancy_of(np.full(600, 100.0), 0.0).above(10.0)
    like_noise, three, eight = (600.0 * (1.0 + size**2) for size in (0.5, 3.0, 8.0))
    (exact, low), (some, high), (more, _) = (floor.profile(power) for power in (like_noise, three, eight))
    assert high == floor.lowest
    # 600 (8^2 - 3^2) / 2 V with V = 1 + 600 * 10^2 / 30
    assert some - more == pytest.approx(33000.0 / 2.0 / 2001.0)
    assert low == pytest.approx(1.0 + 600.0 / 30.0)
    # Half of 30 ln(2001 / 21), less what 0.25 * 600 + 30 and 5400 are at these V.
    gained = 15.0 * np.log(2001.0 / 21.0) - 180.0 / 42.0 + 5430.0 / 4002.0
    assert exact - some == pytest.approx(gained)
    assert low in floor.grid()
    assert high in floor.grid()


def test_what_the_reading_adds_is_added_to_exact_forms_too() -> None:
    plain = discrepancy_of(np.full(600, 100.0), 0.0)
    blurred = plain.blurred(2.0)
    assert blurred.size(blurred.lowest) == pytest.approx(2.0)
    assert blurred.size(blurred.exact) == pytest.approx(np.sqrt(5.0))


def test_the_usual_error_lies_between_the_least_and_the_largest_declared() -> None:
    declared = [effect.form_error for effect in CATALOGUE.values()]
    assert min(declared) < usual_form_error() < max(declared)
