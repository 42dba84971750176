"""A specimen that does not come back to its length is told from one with friction, softening or another law."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import TireModel
from tirelab import Recording, diagnose

STAYS, NOISE = 0.1, 2.0


def crushed(deepest: tuple[float, ...]) -> Recording:
    """The default tire pressed to some deflections [mm] and back; a tenth of the largest stays.

    A second formulation: an unloaded specimen that is a tenth shorter, of the same force at the largest deflection.
    """
    rng = np.random.default_rng(11)
    x = 1e-3 * np.concatenate([top * (1.0 - np.abs(np.linspace(-1.0, 1.0, 1000))) for top in deepest])
    A, B = TireModel().law.coefficients(np.inf)
    largest = np.maximum.accumulate(x)
    shorter = np.maximum(x - STAYS * largest, 0.0) / (1.0 - STAYS)
    force = A * (100.0 * shorter) ** B + rng.normal(0.0, NOISE, x.size)
    return Recording.from_arrays(
        time=0.02 * np.arange(x.size), deflection=x, force=force, surface_radius=np.full(x.size, np.inf)
    )


@pytest.mark.slow
@pytest.mark.parametrize("deepest", [(8.0, 12.0, 16.0, 16.0), (12.0,)])
def test_what_stays_is_named_with_its_share(deepest: tuple[float, ...]) -> None:
    verdict = diagnose([crushed(deepest)], TireModel())
    assert verdict.names == ("permanent_set",)
    assert verdict.confidence > 0.9
    ((effect, values),) = verdict.tire.effects
    assert effect.name == "permanent_set"
    assert values[0] == pytest.approx(STAYS, rel=0.02)
