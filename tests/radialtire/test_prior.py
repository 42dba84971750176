"""What may stand as the prior of a parameter."""

from __future__ import annotations

import pytest
from radialtire import CATALOGUE, Prior


@pytest.mark.parametrize(
    ("shape", "centre", "spread", "scale", "words"),
    [
        ("uniform", 1.0, 1.0, "1", "shape = 'uniform'"),
        ("log", 0.0, 1.0, "1", "centre = 0"),
        ("normal", 0.0, 0.0, "1", "spread = 0"),
        ("normal", 0.0, 1.0, "force/weather", "scale = 'force/weather'"),
    ],
)
def test_what_is_no_distribution_is_refused(
    shape: str, centre: float, spread: float, scale: str, words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        Prior(shape, centre, spread, scale)


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_fitted_parameter_has_a_prior_whose_source_is_stated(name: str) -> None:
    priors = [p.prior for p in CATALOGUE[name].parameters if p.prior is not None]
    assert priors
    assert all(prior.source for prior in priors)


@pytest.mark.parametrize("name", CATALOGUE)
def test_an_effect_has_a_strength_or_a_limit_with_which_it_vanishes(name: str) -> None:
    effect = CATALOGUE[name]
    assert any(p.role in ("strength", "limit") for p in effect.parameters)
    strengths = [p for p in effect.parameters if p.role == "strength"]
    assert effect.signed == (bool(strengths) and strengths[0].minimum < 0.0)
