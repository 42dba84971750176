"""How well A and B of one surface are known, by the noise of its recordings."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from presses import ARTICLE, triangle
from tirelab.article import press as rig
from tirelab.identification.identify import identify
from tirelab.identification.noise import with_covariance
from tirelab.identification.power_fit import fit_power
from tirelab.identification.surfaces import surfaces_of


@pytest.mark.parametrize("correlation_time", [0.0, 0.5])
def test_the_covariance_of_a_surface_is_that_of_many_draws(correlation_time: float) -> None:
    fits = []
    for seed in range(150):
        surfaces = surfaces_of(
            [rig.record(ARTICLE, math.inf, noise=rig.ForceNoise(10.0, correlation_time, (seed,)), cycles=3)]
        )
        fits.append(with_covariance(surfaces, [fit_power(surfaces[0])])[0])
    spread = np.std([(f.coefficient, f.exponent) for f in fits], axis=0)
    stated = np.sqrt(np.mean([np.diag(f.covariance) for f in fits], axis=0))
    # a standard deviation of 150 draws is known to 5.8 %: three times that
    np.testing.assert_allclose(stated, spread, rtol=0.17)
    independent = 450.0 * math.tanh(0.1 / correlation_time) if correlation_time else 450.0
    assert np.median([f.independent for f in fits]) == pytest.approx(independent, rel=0.2)


def test_a_surface_recorded_twice_is_one_surface() -> None:
    found = identify([triangle(noise=10.0, seed=2), triangle(noise=10.0, seed=3)])
    assert len(found.surfaces) == 1
    assert found.surfaces[0].samples == 2 * 149
    alone = identify([triangle(noise=10.0, seed=2)])
    # twice the samples: the uncertainty falls by the root of two; the noise of 149 samples is known to 6 %, three times
    ratio = alone.surfaces[0].coefficient_uncertainty / found.surfaces[0].coefficient_uncertainty
    assert ratio == pytest.approx(math.sqrt(2.0), rel=0.18)


@pytest.mark.parametrize("apart", [0.01, 0.03, 0.1])
def test_recordings_at_different_levels_are_known_no_better_than_they_agree(apart: float) -> None:
    """Of two draws of a level the mean is known to half their distance (standard error of two values); of noise alone
    it would be known to a tenth of a percent.
    """
    pieces = [triangle(noise=2.0, seed=seed) for seed in (2, 3)]
    levels = (1.0 - apart, 1.0 + apart)
    several = [
        replace(r, name=r.name + str(level), force=level * r.force)
        for r, level in zip(pieces, levels, strict=True)
    ]
    (surface,) = identify(several).surfaces
    assert surface.coefficient_uncertainty > 0.5 * apart * surface.coefficient
