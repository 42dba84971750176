"""A part's load cell may have been zeroed under load: another constant on its force is no other physics."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.recordings.recording import Recording
from tirelab.simulation.simulate import simulate

TIME = np.arange(0.0, 32.0, 0.04)
STRETCH = 0.01 * (1.0 - np.cos(2.0 * np.pi * 0.25 * TIME)) * (0.6 + 0.4 * (TIME > 16.0))
FRICTION = (0.8, 0.05, 1e-3, 0.0, 0.6, 0.0, 1.0, 1.0)
NAMES = ("rate_independent_hysteresis", "mullins_softening", "warm_up")


def strip(zero: float) -> Verdict:
    """The verdict on a rubber strip with friction of 0.8 N and 5 % of its force, which the load cell reads `zero` [N]
    off.
    """
    law = TireModel(PowerLaw(12.0, 1.0), two_sided=True, inflated=False, preload=zero, tested_range=None)
    rubbing = TireModel(
        PowerLaw(12.0, 1.15),
        ((CATALOGUE["rate_independent_hysteresis"], FRICTION),),
        two_sided=True,
        inflated=False,
        preload=zero,
        tested_range=None,
    )
    silent = Recording("strip", TIME, STRETCH, np.full(TIME.size, np.inf), np.zeros(TIME.size))
    force = simulate(rubbing, silent) + 0.1 * np.random.default_rng(12).normal(size=TIME.size)
    read = Recording("strip", TIME, STRETCH, silent.surface_radius, force)
    return diagnose([read], law, catalogue=["recalibration", *NAMES])


@pytest.mark.slow
def test_another_zero_changes_neither_names_nor_errors() -> None:
    zeroed, far_off = strip(0.0), strip(-60.0)
    assert zeroed.names == far_off.names
    assert set(zeroed.names) == {"rate_independent_hysteresis", "recalibration"}
    assert far_off.fit.after == pytest.approx(zeroed.fit.after, rel=1e-3)
    assert far_off.fit.after == pytest.approx(0.1, rel=0.1)
    assert far_off.confidence == pytest.approx(zeroed.confidence, abs=0.01)
    assert far_off.tire.preload == pytest.approx(zeroed.tire.preload - 60.0, abs=0.02)
