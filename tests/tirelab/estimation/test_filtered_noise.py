"""Noise of an amplifier with a filter is told from physics in what the likeliest set leaves of a ride."""

from __future__ import annotations

import numpy as np
import pytest
from drives import flat_force
from radialtire import TireModel
from scipy.signal import butter, lfilter
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording

LEVEL = 4.0


def ride(name: str, seed: int, ripple: float = 0.0) -> Recording:
    """A ride of 20 s on a tire with a damper of 300 N s/m, beside 4 N of noise behind a filter of 40 Hz.

    ripple [N]: of a tread, once every 3 mm
    """
    random, time = np.random.default_rng(seed), np.arange(8000) / 400.0
    frequencies = random.uniform(0.5, 20.0, 40)
    turns = 2.0 * np.pi * frequencies * time[:, None] + random.uniform(0.0, 2.0 * np.pi, 40)
    sizes = 6e-3 / np.sqrt(40.0) / np.sqrt(frequencies)
    deflection = 0.015 + np.sin(turns) @ sizes
    rate = np.cos(turns) @ (2.0 * np.pi * frequencies * sizes)
    noise = lfilter(*butter(2, 0.2), random.normal(size=8500))[500:]
    force = flat_force(deflection) + 300.0 * rate + LEVEL * noise / np.std(noise)
    force += ripple * np.sin(2.0 * np.pi * deflection / 3e-3)
    read = deflection + 1e-6 * random.normal(size=8000)
    return Recording(name, time, read, np.full(8000, np.inf), force)


@pytest.mark.slow
def test_the_noise_behind_a_filter_is_no_physics() -> None:
    verdict = diagnose([ride("one", 1), ride("other", 2)], TireModel())
    assert verdict.names == ("viscous_damping",)
    assert verdict.fit.noise == pytest.approx(LEVEL, rel=0.1)


@pytest.mark.slow
def test_a_ripple_as_large_beside_it_stays_something_unknown() -> None:
    verdict = diagnose(
        [ride("one", 1, ripple=2.0 * LEVEL), ride("other", 2, ripple=2.0 * LEVEL)], TireModel()
    )
    assert "viscous_damping" in verdict.names
    assert verdict.unexplained_by
