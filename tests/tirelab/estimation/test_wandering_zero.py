"""What is quicker than a zero that wanders is found beside it."""

from __future__ import annotations

import numpy as np
import pytest
from drives import flat_force
from radialtire import TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.estimation.explanation import catalogue_names, explain_misfit
from tirelab.recordings.recording import Recording


def late(name: str, frequency: float, seed: int) -> Recording:
    """Cycles of 22 mm whose force follows 20 ms late by our own low-pass, beside a zero that wanders by 100 N.

    The lag is 28 or 70 times the noise of 2 N, and the zero swings two times in a recording, as no drift that settles.
    """
    time = np.arange(0.0, 40.0, 0.01)
    deflection = 0.011 * (1.0 - np.cos(2.0 * np.pi * frequency * time))
    force, left = flat_force(deflection), np.exp(-0.01 / 0.02)
    reading = [force[0]]
    for value in force[1:]:
        reading.append(left * reading[-1] + (1.0 - left) * value)
    noise = 2.0 * np.random.default_rng(seed).normal(size=time.size)
    zero = 100.0 * np.sin(2.0 * np.pi * 2.3 * time / 40.0 + seed)
    return Recording(name, time, deflection, np.full(time.size, np.inf), np.array(reading) + zero + noise)


@pytest.mark.slow
def test_a_lag_beside_a_wandering_zero_is_named_and_the_zero_stays_a_remainder() -> None:
    recordings = [late("slow", 0.2, 1), late("fast", 0.5, 2)]
    found = explain_misfit(recordings, TireModel(), catalogue_names(), lambda stage: None)
    # The fit follows the whole misfit, so that the lag's value is not known beside so large a drift; that it acts is.
    assert [effect.name for effect in found.effects] == ["force_lag"]
    assert found.remainder.unexplained


@pytest.mark.slow
def test_a_verdict_names_the_lag_though_neither_its_filter_nor_its_delay_is_known_alone() -> None:
    verdict = diagnose([late("slow", 0.2, 1), late("fast", 0.5, 2)], TireModel())
    assert [effect.name for effect in verdict.effects] == ["force_lag"]
    assert verdict.effects[0].probability > 0.5
    assert verdict.fit.after < verdict.fit.before
