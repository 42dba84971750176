"""Values drawn from priors: their quantiles are those of the declared law, cut off at the bounds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from radialtire import CATALOGUE, CHANNELS, Parameter
from radialtire.prior import Prior
from scipy.stats import norm, truncnorm
from tirelab.regressors.draws import at_reading, centre_and_spread, drawn, quantile
from tirelab.regressors.scales import Scales

SCALES = Scales(
    force=900.0,
    travel=0.02,
    duration=60.0,
    interval=0.01,
    rate=0.05,
    acceleration=1.5,
    gauge=1e-6,
    channels={channel.name: channel.usual for channel in CHANNELS},
)


def parameter(prior: Prior | None, low: float, high: float) -> Parameter:
    return Parameter("k", "k", "N/m", 1.0, low, high, "made", prior=prior)


def test_a_scale_is_a_product_of_the_recordings_sizes() -> None:
    assert SCALES.of("force/travel") == pytest.approx(45_000.0)
    assert SCALES.of("1") == 1.0
    assert SCALES.of("duration") == 60.0


def test_a_prior_of_the_logarithm_is_centred_on_its_multiple_of_the_scale() -> None:
    centre, spread, logarithm = centre_and_spread(
        parameter(Prior("log", 2.0, 0.7, "force/travel"), 0, 1e9), SCALES
    )
    assert (centre, spread, logarithm) == (pytest.approx(math.log(90_000.0)), 0.7, True)


@pytest.mark.parametrize("share", [0.05, 0.5, 0.9])
def test_quantiles_are_those_of_the_normal_law(share: float) -> None:
    wide = parameter(Prior("normal", 0.5, 0.1, "travel"), -1e9, 1e9)
    assert quantile(wide, share, SCALES) == pytest.approx(norm(0.01, 0.002).ppf(share))


@pytest.mark.parametrize("share", [0.05, 0.5, 0.9])
def test_quantiles_within_bounds_are_those_of_the_truncated_law(share: float) -> None:
    cut = parameter(Prior("normal", 0.5, 0.1, "travel"), 0.0105, 1.0)
    expected = truncnorm((0.0105 - 0.01) / 0.002, (1.0 - 0.01) / 0.002, 0.01, 0.002).ppf(share)
    assert quantile(cut, share, SCALES) == pytest.approx(expected, rel=1e-6)


def test_a_prior_outside_the_bounds_gives_the_nearest_bound() -> None:
    assert quantile(parameter(Prior("normal", 0.5, 0.001, "travel"), 0.5, 1.0), 0.3, SCALES) == 0.5


def test_without_a_prior_a_parameter_stays_at_its_start() -> None:
    assert at_reading(parameter(None, 0.0, 2.0), SCALES) == 1.0
    with pytest.raises(ValueError, match="declares no prior"):
        centre_and_spread(parameter(None, 0.0, 2.0), SCALES)


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_every_draw_of_every_effect_is_within_its_bounds_and_the_first_half_is_plain(name: str) -> None:
    effect = CATALOGUE[name]
    sets, shares = drawn(effect, SCALES, 32)
    assert len(sets) == 32
    assert np.all((shares > 0.0) & (shares < 1.0))
    for number, values in enumerate(sets):
        for p, value in zip(effect.parameters, values, strict=True):
            assert p.minimum <= value <= p.maximum
            if p.optional and p.role != "reading" and number < 16:
                assert value == p.start


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_draws_fill_a_prior_evenly(name: str) -> None:
    """Quasi-random numbers: in each quarter of every parameter's law lie as many draws, within a quarter of them."""
    effect = CATALOGUE[name]
    sets, _ = drawn(effect, SCALES, 256)
    for i, p in enumerate(effect.parameters):
        if p.role == "reading" or p.prior is None:
            continue
        whole = sets[128:] if p.optional else sets
        values = np.array(whole)[:, i]
        quarters = [quantile(p, q, SCALES) for q in (0.25, 0.5, 0.75)]
        if len(set(quarters)) < 3:
            continue
        counts = np.histogram(values, [-np.inf, *quarters, np.inf])[0]
        assert np.all(np.abs(counts - len(whole) / 4) <= len(whole) / 16)
