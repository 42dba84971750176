"""What a remainder costs, and the search over sets.

Against the density of a multivariate normal law written out in full.
"""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from scipy.optimize import minimize_scalar
from scipy.signal import lfilter
from scipy.stats import multivariate_normal, norm
from tirelab.regressors.signature import Signature
from tirelab.selection.search import (
    Discrepancy,
    Selection,
    discrepancy_of,
    evidence_of,
    normal_equations,
    parts_of,
    search,
    slow_variance,
    usual_form_error,
)


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


def test_form_error_lifts_the_usual_variance() -> None:
    misfit = np.full(600, 10.0)
    plain = discrepancy_of(misfit, 0.0)
    lifted = plain.above(0.5)
    assert plain.usual == 1.0
    assert lifted.size(lifted.usual) == pytest.approx(0.5)


def test_forms_that_miss_less_than_usual_are_as_rare_as_they_are_good() -> None:
    """Forms usually miss ten noises. Beside the likelihood of the remainder stands the chance of a smaller miss."""
    usual = discrepancy_of(np.full(600, 100.0), 0.0).above(10.0)
    for size in (1.5, 3.0, 6.0):
        variance = 1.0 + 20.0 * size**2
        free = Discrepancy(600, 30.0, 1.0, 1e6, 1.0).likelihood(600.0 * (1.0 + size**2), variance)
        priced = usual.likelihood(600.0 * (1.0 + size**2), variance)
        assert priced - free == pytest.approx(np.log(size / 10.0))
    # Above the usual there is no price.
    assert usual.likelihood(1e6, 4e4) == Discrepancy(600, 30.0, 1.0, 1e6, 1.0).likelihood(1e6, 4e4)


@pytest.mark.parametrize("size", [0.3, 1.2, 3.0, 8.0, 25.0])
def test_profile_is_the_top_on_both_sides_of_the_usual_variance(size: float) -> None:
    usual = discrepancy_of(np.full(600, 100.0), 0.0).above(10.0)
    power = 600.0 * (1.0 + size**2)
    top, variance = usual.profile(power)
    assert usual.lowest <= variance <= usual.highest
    # A fine net over all variances, from that of a remainder like the noise on.
    net = np.geomspace(1.0 + 600.0 / 30.0, usual.highest, 20001)
    assert top == pytest.approx(max(usual.likelihood(power, v) for v in net), abs=1e-5)


def test_a_set_that_leaves_far_less_than_usual_gains_as_if_its_forms_were_good() -> None:
    """Of 600 blocks, 30 of them effective, a remainder of three noises in place of eight: about 30 ln(8 / 3) = 29."""
    usual = discrepancy_of(np.full(600, 100.0), 0.0).above(10.0)
    (some, _), (more, _) = (usual.profile(600.0 * (1.0 + size**2)) for size in (3.0, 8.0))
    assert some - more == pytest.approx(29.4, abs=2.0)


def test_what_the_reading_adds_is_added_to_exact_forms_too() -> None:
    plain = discrepancy_of(np.full(600, 100.0), 0.0)
    blurred = plain.blurred(2.0)
    assert blurred.size(blurred.usual) == pytest.approx(2.0)
    assert blurred.size(blurred.exact) == pytest.approx(np.sqrt(5.0))


def test_what_is_slow_in_white_noise_is_white() -> None:
    numbers = np.random.default_rng(11)
    parts = [numbers.normal(size=2000), numbers.normal(size=1000)]
    # the mean of 1000 squares is known to 0.045
    assert slow_variance(parts, 1000.0, 0.0) == pytest.approx(1.0, abs=0.14)


def test_what_is_slow_in_correlated_noise_is_its_density_at_low_frequencies() -> None:
    """First-order noise e_i = k e_(i - 1) + w_i has at the frequency 0 the density of w over (1 - k)^2."""
    white = np.random.default_rng(12).normal(size=300_000)
    found = slow_variance([lfilter([1.0], [1.0, -0.8], white)], 600.0, 0.0)
    assert found == pytest.approx(25.0, rel=0.18)  # three standard errors of the mean of 600 squares


def test_what_a_model_takes_from_slow_noise_is_given_back() -> None:
    """Ten of thirty sums fitted away: the others tell the variance."""
    noise = np.random.default_rng(13).normal(size=(200, 30, 40))
    noise -= noise.mean(axis=2, keepdims=True) * (np.arange(30) < 10)[None, :, None]
    found = np.mean([slow_variance([one.ravel()], 30.0, 10.0) for one in noise])
    assert found == pytest.approx(1.0, abs=0.07)  # 4000 squares


def test_beside_slow_noise_no_smaller_variance_is_tried() -> None:
    quiet = discrepancy_of(np.full(600, 1.01), 0.01)
    assert quiet.grid[0] < 1.1
    slow = quiet.beside_slow(9.0)
    assert slow.grid[0] == pytest.approx(9.0)
    assert slow.profile(600.0)[1] == pytest.approx(9.0)
    assert slow.of_forms == slow.beside_slow(20.0).of_forms == quiet.of_forms == quiet.usual
    loud = discrepancy_of(np.full(600, 100.0), 0.3)
    assert loud.beside_slow(9.0) == loud


def test_the_usual_error_lies_between_the_least_and_the_largest_declared() -> None:
    declared = [effect.form_error for effect in CATALOGUE.values()]
    assert min(declared) < usual_form_error(TireModel()) < max(declared)


ROWS = 30


def signature(name: str, rng: np.random.Generator) -> Signature:
    """A candidate with a mean and two columns."""
    none = np.zeros((0, ROWS))
    return Signature(
        name, rng.normal(size=ROWS), 0.3 * rng.normal(size=(ROWS, 2)), True, none, (), np.zeros(0)
    )


def test_evidence_of_a_set_is_the_density_of_a_normal_law() -> None:
    rng = np.random.default_rng(5)
    both = (signature("a", rng), signature("b", rng))
    misfit = 3.0 * both[0].mean - 2.0 * both[1].mean + rng.normal(size=ROWS)
    discrepancy = Discrepancy(ROWS, float(ROWS), 1.0, 50.0)
    found = evidence_of(("a", "b"), normal_equations(both, misfit), discrepancy)
    mean = sum(s * c.mean for s, c in zip(found.sizes, both, strict=True))
    covariance = found.variance * np.eye(ROWS)
    covariance += sum(s**2 * c.basis @ c.basis.T for s, c in zip(found.sizes, both, strict=True))
    density = multivariate_normal(mean, covariance).logpdf(misfit) + 0.5 * ROWS * np.log(2.0 * np.pi)
    assert found.log_likelihood == pytest.approx(density, abs=1e-8)
    assert found.sizes[0] > 0.0 > found.sizes[1]


def test_parts_add_up_to_the_projection_where_there_is_no_basis() -> None:
    rng = np.random.default_rng(6)
    mean = rng.normal(size=ROWS)
    only = Signature("a", mean, np.zeros((ROWS, 0)), True, np.zeros((0, ROWS)), (), np.zeros(0))
    misfit = 4.0 * mean + 0.1 * rng.normal(size=ROWS)
    discrepancy = Discrepancy(ROWS, float(ROWS), 1e-3, 50.0)
    equations = normal_equations((only,), misfit)
    part = parts_of(evidence_of(("a",), equations, discrepancy), equations, discrepancy)["a"]
    assert part == pytest.approx(mean * (mean @ misfit) / (mean @ mean), rel=1e-3)


def drawn(seed: int, names: str, amounts: dict[str, float]) -> Selection:
    """A search over candidates of one column each, in a misfit of some of them and white noise."""
    rng = np.random.default_rng(seed)
    rows, none = 400, np.zeros((0, 400))
    columns = {name: rng.normal(size=rows) for name in names}
    many = [
        Signature(name, column, np.zeros((rows, 0)), True, none, (), np.zeros(0))
        for name, column in columns.items()
    ]
    misfit = rng.normal(size=rows) + sum(a * columns[name] for name, a in amounts.items())
    return search(normal_equations(many, misfit), discrepancy_of(misfit, 0.0))


def test_the_set_that_is_there_is_the_likeliest() -> None:
    found = drawn(1, "abcdefg", {"b": 0.8, "e": -1.5})
    assert set(found.ranked[0].names) == {"b", "e"}
    # Amounts of a column are known to 1 / sqrt(400).
    sizes = dict(zip(found.ranked[0].names, found.ranked[0].sizes, strict=True))
    assert sizes == {"b": pytest.approx(0.8, abs=0.15), "e": pytest.approx(-1.5, abs=0.15)}


def test_in_noise_alone_nothing_is_the_likeliest_of_all_but_a_few() -> None:
    found = [drawn(seed, "abcdefg", {}).ranked[0].names for seed in range(2, 12)]
    assert found.count(()) >= 9


def test_a_fit_begins_with_the_best_sets_and_the_best_of_each_size() -> None:
    found = drawn(1, "abcdefg", {"b": 0.8, "e": -1.5})
    starts = found.starts(2)
    assert starts[:2] == found.ranked[:2]
    assert {len(e.names) for e in starts} == {len(e.names) for e in found.ranked}
    for evidence in starts[2:]:
        same = [e.log_posterior for e in found.ranked if len(e.names) == len(evidence.names)]
        assert evidence.log_posterior == max(same)
