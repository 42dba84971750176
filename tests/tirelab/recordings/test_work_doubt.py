"""A part that gives out energy is doubted; one that stores it, or loses it, is not."""

from pathlib import Path

import numpy as np
import pytest
from house_form import write_rows
from tirelab.recordings.reading import Reading
from tirelab.recordings.sign_convention import loading_share

TIME = np.arange(800) / 100.0
WAY = np.interp(TIME, [0.0, 4.0, 8.0], [0.0, 1.0, 0.0])
SIGNED = {"deflection": "+height [mm]", "force": "+force [N]"}

INDENTED = 5.0 * np.clip(WAY - 0.8, 0.0, None) / 0.2 - 0.7
"""A tip that meets its sample after four fifths of the way, with a load cell that reads -0.7 N in the air."""


def doubts(path: Path, height: np.ndarray, force: np.ndarray) -> tuple[str, ...]:
    write_rows(path, "time [s],height [mm],force [N]", TIME, height, force)
    return Reading(part=True, columns=SIGNED)(path).doubts


def test_a_height_that_is_least_under_load_is_doubted(tmp_path: Path) -> None:
    (doubt,) = doubts(tmp_path / "a.csv", 60.0 - WAY, INDENTED)
    assert "the force falls as the deflection grows, up to the largest one" in doubt
    assert doubt.endswith("Then --columns 'deflection=-height [mm],force=+force [N]' turns the deflection")
    (doubt,) = doubts(tmp_path / "b.csv", WAY, -INDENTED)
    assert doubt.endswith("Then --columns 'deflection=+height [mm],force=-force [N]' turns the force")


def test_what_stores_or_loses_energy_is_not() -> None:
    """A preloaded spring in and out, friction that begins at its largest, a damper, and a switch that snaps through."""
    assert loading_share(WAY, 1.0 + 2.0 * WAY) == pytest.approx(1.0)
    assert loading_share(-WAY, 1.0 - 5.0 * WAY) == pytest.approx(1.0)
    rough = 20.0 + np.random.default_rng(3).normal(0.0, 0.1, TIME.size)
    assert np.isnan(loading_share(WAY, rough))
    assert loading_share(WAY, 40.0 * np.gradient(WAY, TIME) * np.clip(TIME, 0.0, 1.0)) == pytest.approx(1.0)
    # up to the bottom of the valley it gives out half of the work that the barrier before it takes in
    snapping = 8.0 * np.sin(2.0 * np.pi * WAY) - 0.01 * WAY
    assert loading_share(WAY, snapping) == pytest.approx(1.0 / 3.0, abs=0.01)


def test_what_a_part_did_while_nothing_was_recorded_is_not_known(tmp_path: Path) -> None:
    """Five loading legs of a spring that meets its stop, with the ways back left out: from its peak to 0 the straight
    line would give out more than the leg took in.
    """
    way = np.arange(0.0, 1.0, 0.004)
    leg = 2.0 * way + 60.0 * np.clip(way - 0.6, 0.0, None) + 0.3
    time = np.concatenate([0.02 * np.arange(way.size) + 7.0 * cycle for cycle in range(5)])
    write_rows(tmp_path / "a.csv", "time [s],height [mm],force [N]", time, np.tile(way, 5), np.tile(leg, 5))
    found = Reading(part=True, columns=SIGNED)(tmp_path / "a.csv")
    assert not any("backwards" in doubt for doubt in found.doubts)


def test_a_sample_that_comes_late_breaks_no_loop(tmp_path: Path) -> None:
    """Loops that run backwards, with one sample in fifty lost: what the part did meanwhile is a straight line."""
    way = 0.5 * (1.0 - np.cos(np.pi * TIME / 2.0))
    force = 5.0 * way - 2.0 * np.sin(np.pi * TIME / 2.0)
    kept = np.arange(TIME.size) % 50 != 25
    columns = "time [s],height [mm],force [N]"
    write_rows(tmp_path / "a.csv", columns, TIME[kept], way[kept], force[kept])
    found = Reading(part=True, columns=SIGNED)(tmp_path / "a.csv")
    assert any("run backwards" in doubt for doubt in found.doubts)
