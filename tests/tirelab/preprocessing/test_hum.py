"""The hum of the mains in a reading."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.preprocessing.hum import mains_hum

CHANCE = 0.05
WHITE = np.random.default_rng(11).normal(0.0, 1.0, 40_000)


@pytest.mark.parametrize("sampling", [100.0, 170.0, 200.0, 480.0])
@pytest.mark.parametrize("mains", [49.93, 50.02, 59.96, 60.01])
def test_hum_is_found_wherever_the_sampling_folds_it(sampling: float, mains: float) -> None:
    time = np.arange(3000) / sampling
    hum = 2.0 * np.sin(2.0 * np.pi * mains * time + 0.4)
    found = mains_hum(WHITE[:3000] + hum, 1.0 / sampling, 16.0, CHANCE)
    # Four coefficients of a line take as many parts in 3000 of the noise: 0.04. A line at half the sampling rate, or
    # two that fold to one frequency, leave more.
    assert float(np.std(found - hum)) < 0.15


@pytest.mark.parametrize("count", [200, 3000])
def test_white_noise_hums_by_the_chance_at_most(count: int) -> None:
    starts = np.random.default_rng(12).integers(0, WHITE.size - count, 200)
    seen = [np.any(mains_hum(WHITE[i : i + count], 0.01, 16.0, CHANCE)) for i in starts]
    assert np.mean(seen) <= CHANCE


def test_another_line_is_no_hum() -> None:
    line = 5.0 * np.sin(2.0 * np.pi * 37.0 * np.arange(3000) / 200.0)
    assert not np.any(mains_hum(WHITE[:3000] + line, 1.0 / 200.0, 16.0, CHANCE))


def test_a_line_as_slow_as_the_motion_is_no_hum() -> None:
    """At 51 samples a second, 50 Hz fold to 1 Hz: 51 samples a period, as slow as a motion."""
    line = 5.0 * np.sin(2.0 * np.pi * 50.0 * np.arange(3000) / 51.0)
    assert not np.any(mains_hum(WHITE[:3000] + line, 1.0 / 51.0, 16.0, CHANCE))
    assert np.any(mains_hum(WHITE[:3000] + line, 1.0 / 51.0, 128.0, CHANCE))


def test_slow_sampling_folds_any_line_to_the_mains() -> None:
    """At 10 samples a second a band of 0.4 Hz about each of the two is more than a twentieth of 5 Hz."""
    line = 5.0 * np.sin(2.0 * np.pi * 60.1 * np.arange(3000) / 10.0)
    assert not np.any(mains_hum(WHITE[:3000] + line, 0.1, 128.0, CHANCE))


@pytest.mark.filterwarnings("error")
def test_a_misfit_of_nothing_does_not_hum() -> None:
    assert not np.any(mains_hum(np.zeros(3000), 0.01, 16.0, CHANCE))
