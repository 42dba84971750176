"""A force that is below zero for longer than noise is pulls."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.recordings.pulling import pull_of


@pytest.mark.parametrize(
    ("least", "sigma", "pulls"),
    [(-60.0, 4.0, True), (-15.0, 4.0, False), (0.0, 40.0, False), (-60.0, 100.0, False)],
)
def test_less_than_a_hundredth_or_than_the_noise_is_no_pull(least: float, sigma: float, pulls: bool) -> None:
    """A quarter of the recording stands at `least`, the rest goes up to 2000 N."""
    force = np.concatenate([np.full(500, least), np.linspace(least, 2000.0, 1500)])
    found = pull_of(force + sigma * np.random.default_rng(1).standard_normal(force.size))
    assert found == (pytest.approx(least, abs=3.0 * sigma / np.sqrt(10.0) + 1.0) if pulls else 0.0)


def test_a_few_samples_are_no_pull() -> None:
    assert pull_of(np.array([-5.0, 3.0])) == 0.0
