"""Against the density of a multivariate normal law written out in full."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal
from tirelab.regressors.signature import Signature
from tirelab.selection.discrepancy import Discrepancy
from tirelab.selection.marginal_likelihood import evidence_of, normal_equations, parts_of

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
