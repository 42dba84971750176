"""Values drawn from priors: their quantiles are those of the declared law, cut off at the bounds.

The bounds of all effects hold parts of any size.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, CHANNELS, Parameter, PowerLaw, TireModel
from radialtire.prior import Prior
from rivals import rivals
from scipy.stats import norm, truncnorm
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Scales
from tirelab.regressors.draws import at_reading, centre_and_spread, drawn, quantile
from tirelab.simulation.simulate import simulate

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


TIRE = Scales(900.0, 0.02, 60.0, 0.01, 0.05, 1.5, 1e-6, {c.name: c.usual for c in CHANNELS})


@pytest.mark.parametrize(
    ("force", "travel"), [(1e-8, 14e-6), (50.0, 2e-3), (900.0, 0.02), (30e3, 1.0), (1e7, 0.5)]
)
def test_the_priors_lie_within_the_bounds_for_parts_of_any_size(force: float, travel: float) -> None:
    """A gel under a microscope, a rubber mount, a tire, one that is lifted by a metre, a bearing of a bridge."""
    scales = replace(TIRE, force=force, travel=travel)
    for effect in CATALOGUE.values():
        for p in effect.parameters:
            if p.prior is not None and set(p.prior.scale.split("/")) <= {"force", "travel"}:
                centre, spread, logarithm = centre_and_spread(p, scales)
                reached = np.array([-2.0, 2.0]) * spread + centre
                low, high = np.exp(reached) if logarithm else reached
                assert p.minimum <= max(low, 0.0 if p.minimum == 0.0 else low)
                assert high <= p.maximum


@pytest.mark.slow
def test_a_recording_in_nanonewtons_is_diagnosed_as_it_is() -> None:
    """A sphere on a gel, approached at two speeds and held: relaxation of a quarter in half a second, 10 nN, 14 um."""
    time = np.arange(0.0, 24.0, 5e-3)
    x = 14e-6 * np.interp(
        time, [0.0, 0.2, 6.0, 8.0, 9.0, 13.0, 17.0, 18.0, 20.0], [0, 1, 1, 0, 0, 1, 0, 0, 1]
    )
    numbers = np.random.default_rng(4)
    gel = TireModel(PowerLaw(1e-8 / 1.4e-3**1.5, 1.5), tested_range=None)
    effect = CATALOGUE["viscoelastic_relaxation"]
    values = {p.name: p.start for p in effect.parameters} | {"share_1": 0.25, "relaxation_time_1": 0.5}
    true = replace(gel, effects=((effect, tuple(values[p.name] for p in effect.parameters)),))
    silent = Recording("gel", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    noise = 5e-12 * numbers.normal(size=time.size)
    read = x + 1e-9 * numbers.normal(size=time.size)
    recording = replace(silent, deflection=read, force=simulate(true, silent) + noise)
    found = diagnose(recording, gel, catalogue=[*rivals("viscoelastic_relaxation"), "saturation"])
    assert found.names == ("viscoelastic_relaxation",)
    assert found.fit.noise == pytest.approx(5e-12, rel=0.3)
    assert found.fit.after < 1.2 * found.fit.noise
