"""A gauge at the end of its travel is said, and no physics is made of it."""

from __future__ import annotations

import numpy as np
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording

TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)


def test_no_bottoming_is_made_of_a_clipped_reading() -> None:
    """Three cycles to 22 mm of exactly that tire, with 4 N of noise, through a gauge that ends at 19 mm."""
    rng = np.random.default_rng(1)
    time = np.linspace(0.0, 60.0, 1800)
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * time / 20.0))
    force = 550.0 * (100.0 * x) ** 1.42 + rng.normal(0.0, 4.0, time.size)
    reading = np.minimum(x, 0.019) + rng.normal(0.0, 5e-6, time.size)
    verdict = diagnose(Recording("clipped", time, reading, np.full(time.size, np.inf), force), TIRE)
    assert verdict.names == ()
    assert "In clipped the deflection's reading stands still at 19 mm" in verdict.summary
    assert "record with more travel" in verdict.summary
