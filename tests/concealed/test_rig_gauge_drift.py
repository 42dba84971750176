"""Trials of a gauge whose zero drifts: its forms, and that no other kind hides one."""

from __future__ import annotations

import concealed
import numpy as np
import pytest
from concealed import Trial, draw
from concealed.bench import Bench
from concealed.motion import Motion, even_grid
from concealed.regressors import NAMES
from concealed.tires import PowerTire, Surface
from concealed.wide.gauge_drift import DEFLECTION_DRIFT, SettlingMount, WarmingGauge

TIRE = PowerTire((Surface(np.inf, 500.0, 1.4),))
COUNT = 401
HELD = Motion("hold", even_grid(COUNT, 0.25), np.full(COUNT, 0.01), np.full(COUNT, np.inf))
"""A hold of 100 s at 10 mm."""


def shift(effect: WarmingGauge | SettlingMount) -> np.ndarray:
    """Deflection [m] that the force of the held tire shows, beyond that of the gauge."""
    return 0.01 * (Bench(TIRE, (effect,)).force(HELD) / 500.0) ** (1.0 / 1.4) - 0.01


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_gauge_warms_by_two_bodies(sign: float) -> None:
    found = shift(WarmingGauge(1e-4, 20.0, 50.0, 0.25, sign))
    expected = sign * 1e-4 * ((1.0 - np.exp(-HELD.time / 20.0)) - 0.25 * (1.0 - np.exp(-HELD.time / 50.0)))
    assert found == pytest.approx(expected, abs=1e-12)


def test_a_mount_creeps_by_the_logarithm_of_the_time() -> None:
    """As much from 10 to 30 s as from 30 to 70 s after a start of 10 s: both double the time since it began."""
    found = shift(SettlingMount(1e-4, 10.0, 100.0))
    at = {seconds: found[int(4 * seconds)] for seconds in (10, 30, 70)}
    assert at[30] - at[10] == pytest.approx(at[70] - at[30], rel=1e-6)
    assert found[-1] == pytest.approx(-1e-4, rel=1e-6)


def test_a_drift_is_hidden_alone_and_beside_others_and_never_by_the_other_kinds() -> None:
    trials: list[Trial] = [draw(seed, kind="drift") for seed in range(300, 310)]
    assert {len(t.answer.right[0]) for t in trials} == {1, 2}
    assert {type(t.bench.effects[0]) for t in trials} == {WarmingGauge, SettlingMount}
    for trial in trials:
        assert trial.answer.right == (tuple(sorted(e.name for e in trial.bench.effects)),)
        assert not trial.answer.hidden
        assert trial.answer.sizes[DEFLECTION_DRIFT].raw > 0.95 * 5.0
    assert DEFLECTION_DRIFT not in NAMES
    assert "drift" not in concealed.IN_TURN
