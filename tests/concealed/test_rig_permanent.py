"""Trials of a part that keeps a part of its deflection: its forms, and that no other kind changed."""

from __future__ import annotations

import concealed
import numpy as np
import pytest
from concealed import Trial, draw
from concealed.bench import Bench
from concealed.motion import Motion, even_grid
from concealed.regressors import NAMES
from concealed.tires import PowerTire, Surface
from concealed.wide.permanent import PERMANENT_SET, CrushedCells, SpringBack

TIRE = PowerTire((Surface(np.inf, 500.0, 1.4),))
COUNT = 400


def pressed(effect: SpringBack, deepest: float = 0.02) -> tuple[np.ndarray, np.ndarray]:
    """Deflection and force of a press to the deepest deflection and back."""
    way = np.concatenate([np.linspace(1e-5, 1.0, COUNT // 2), np.linspace(1.0, 1e-5, COUNT // 2)])
    motion = Motion("press", even_grid(COUNT, 0.01), deepest * way, np.full(COUNT, np.inf))
    return motion.deflection, Bench(TIRE, (effect,)).force(motion)


def test_what_stays_is_a_share_of_the_largest_deflection_and_the_loading_is_the_law() -> None:
    x, force = pressed(SpringBack(0.25, 1.0))
    up, down = slice(0, COUNT // 2), slice(COUNT // 2, None)
    assert force[up] == pytest.approx(500.0 * (100.0 * x[up]) ** 1.4, rel=1e-9)
    part = np.maximum(x[down] - 0.005, 0.0) / 0.015
    # between samples of the way up, the rig's curve is a power
    assert force[down] == pytest.approx(500.0 * (2.0 * part) ** 1.4, rel=1e-6, abs=1e-3)


def test_the_unloading_may_have_another_exponent() -> None:
    x, force = pressed(SpringBack(0.5, 0.6))
    down = slice(COUNT // 2, COUNT // 2 + 60)
    part = (x[down] - 0.01) / 0.01
    assert force[down] / force.max() == pytest.approx(part ** (1.4 * 0.8), rel=1e-6)


def test_cells_collapse_one_after_the_other() -> None:
    """Far beyond their onset a part s of all that is beyond stays; far before it nothing."""
    cells = CrushedCells(0.3, 1.0, 0.008, 0.0004)
    assert cells.stays(np.array([0.02]))[0] == pytest.approx(0.3 * 0.012, rel=1e-9)
    assert cells.stays(np.array([0.004]))[0] == pytest.approx(0.0, abs=1e-7)
    assert cells.stays(np.array([0.008]))[0] == pytest.approx(0.3 * 0.0004 * np.log(2.0), rel=1e-6)


@pytest.mark.parametrize("form", [SpringBack(0.0, 0.6), CrushedCells(0.0, 1.0, 0.008, 0.001)])
def test_without_strength_nothing_stays(form: SpringBack) -> None:
    assert pressed(form)[1] == pytest.approx(500.0 * (100.0 * pressed(form)[0]) ** 1.4, rel=1e-6, abs=1e-3)


@pytest.mark.slow
def test_a_set_is_hidden_alone_and_beside_others_and_never_by_the_other_kinds() -> None:
    trials: list[Trial] = [draw(seed, kind="set") for seed in range(300, 310)]
    assert {len(t.answer.right[0]) for t in trials} == {1, 2}
    assert {type(t.bench.effects[0]) for t in trials} == {SpringBack, CrushedCells}
    for trial in trials:
        assert PERMANENT_SET in trial.answer.effects
        assert trial.answer.right == (tuple(sorted(e.name for e in trial.bench.effects)),)
        assert not trial.answer.hidden
        assert trial.answer.sizes[PERMANENT_SET].raw > 0.95 * 5.0
        assert all(len(np.unique(record.radius)) == 1 for record in trial.train)
    assert PERMANENT_SET not in NAMES
    assert "set" not in concealed.IN_TURN
