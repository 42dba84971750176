"""Trials at several pressures: what is written, that the force follows the pressure, and that no other kind changed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import concealed
import numpy as np
import pytest
from concealed import Trial, answer_json, derived_right, draw, write
from concealed.bench import Bench
from concealed.motion import Motion, even_grid
from concealed.tires import INFLATION, PowerTire, Surface
from concealed.wide.pressure import PressedAir

SEEDS = range(4)


@pytest.fixture(scope="module")
def trials() -> Mapping[int, Trial]:
    return {seed: draw(seed, kind="pressure") for seed in SEEDS}


def test_the_same_seed_gives_the_same_trial(trials: Mapping[int, Trial]) -> None:
    assert answer_json(draw(1, kind="pressure")) == answer_json(trials[1])
    assert len({answer_json(trial) for trial in trials.values()}) == len(trials)


def test_every_trial_has_two_pressures_or_more_and_they_are_written(
    trials: Mapping[int, Trial], tmp_path: Path
) -> None:
    for seed, trial in trials.items():
        means = []
        for record in trial.train:
            assert record.pressure is not None
            assert np.all((record.pressure > 0.3 * INFLATION) & (record.pressure < 1.8 * INFLATION))
            means.append(float(record.pressure[0]))
        assert max(means) / min(means) > 1.25
        write(trial, tmp_path / str(seed))
        lines = (tmp_path / str(seed) / "train_0.csv").read_text(encoding="ascii").splitlines()
        assert lines[0].endswith(",pressure [kPa]")
        assert float(lines[1].split(",")[-1]) == pytest.approx(1e-3 * means[0], abs=0.06)


def test_the_truth_comes_first_and_holds_the_pressure(trials: Mapping[int, Trial]) -> None:
    for trial in trials.values():
        assert trial.answer.right[0] == tuple(sorted(trial.answer.effects))
        assert all("inflation_pressure" in names for names in trial.answer.right)
        assert derived_right(trial) == trial.answer.right


def test_the_air_carries_its_share() -> None:
    """70 % of the force at half the pressure with 60 % air: 1 - 0.6 x 0.5, at 1 cm; at 2 cm with q more of it."""
    tire = PowerTire((Surface(np.inf, 500.0, 1.4),))
    time = even_grid(200, 0.01)
    motion = Motion("still", time, np.linspace(0.01, 0.02, 200), np.full(200, np.inf))
    bare = Bench(tire).force(motion)
    pressed = Bench(tire, (PressedAir(0.6, 0.05, 0.5),)).force(motion)
    assert pressed[0] / bare[0] == pytest.approx(0.7, rel=1e-9)
    assert pressed[-1] / bare[-1] == pytest.approx(1.0 - 0.6 * 2.0**0.05 * 0.5, rel=1e-9)


def test_no_other_kind_is_drawn_otherwise_for_it() -> None:
    """The kinds that are drawn in turn stay in their order, and their recordings what they were."""
    assert concealed.IN_TURN[:4] == ("loud", "press", "foreign", "outside")
    for kind, (mean, spread) in BEFORE.items():
        record = draw(7, kind=kind).train[0]
        assert record.pressure is None
        assert float(record.force.mean()) == pytest.approx(mean, rel=1e-9)
        assert float(record.force.std()) == pytest.approx(spread, rel=1e-9)


BEFORE = {
    "single": (795.9158936877077, 579.6790737467034),
    "press": (356.90558263322816, 264.7019452541901),
    "loud": (459.6634608872334, 423.3483512186447),
}
"""Mean and standard deviation [N] of the first recording of seed 7, as drawn since amplifiers filter their noise."""
