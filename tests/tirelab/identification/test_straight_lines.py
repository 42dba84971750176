"""Straight lines have their corners where the curve has them, and lie amid a loop that is seen."""

import numpy as np
import pytest
from part_readings import recording
from tirelab.identification.both_ways import loop_state
from tirelab.identification.part_laws import fit_laws
from tirelab.identification.table import law_table


def test_the_corners_of_a_curve_do_not_lie_in_holds() -> None:
    """Ninety-five of a hundred samples are read in three holds, whose gauge has a noise of 0.01 mm."""
    way = np.linspace(0.0, 0.02, 300)
    holds = np.repeat([0.005, 0.01, 0.015], 1900) + np.random.default_rng(1).normal(0.0, 1e-5, 5700)
    x = np.concatenate([way, holds])
    found = {fit.name: fit for fit in fit_laws([recording(x, 1e4 * x + 3e5 * x**2)])}["piecewise"]
    between = np.diff(found.at)
    assert len(found.at) > 5
    assert between.max() < 3.0 * between.min()


def test_a_curve_has_its_corners_where_the_force_changes() -> None:
    """A rod that yields after a hundredth of its way: 15 kN there, 19 kN at the end, and 1 N of noise."""
    x = np.linspace(0.0, 0.01, 5000)
    force = np.minimum(1.5e8 * x, 1.5e4 + 4e5 * (x - 1e-4)) + np.random.default_rng(3).normal(
        0.0, 1.0, x.size
    )
    found = {fit.name: fit for fit in fit_laws([recording(x, force)])}["piecewise"]
    # Corners every tenth of the way miss the yield by 2.4 kN over a part of it: more than 300 N of all.
    assert found.rmse < 60.0
    assert found.at[1] == pytest.approx(1e-4, rel=0.05)


def test_a_curve_is_the_middle_of_a_loop_at_its_turns_too() -> None:
    """Dry friction of 20 N and a fifth of the force, which turns within 0.2 mm: 120 N to either side at the top.

    Lines through all samples are off by half of that there, and 2 N of noise move ten lines by less than 1 N.
    """
    way = np.linspace(0.0, 0.02, 1500)
    x = np.concatenate([way, way[::-1], way, way[::-1]])
    elastic = 1.5e4 * x + 5e5 * x**2
    force = elastic + loop_state(x, 1e-4) * (20.0 + 0.2 * elastic)
    fits = fit_laws([recording(x, force)])
    found = {fit.name: fit for fit in fits}["piecewise"]
    assert "piecewise goes amid the loop of both ways" in str(law_table(fits).caption)
    assert "loop" not in str(law_table(fit_laws([recording(way, elastic[:1500])])).caption)
    middle = np.interp(way, found.at, [value for _, value, _, _ in found.constants])
    assert middle == pytest.approx(1.5e4 * way + 5e5 * way**2, abs=2.0)
    # What is stated to be left is what the curve alone leaves: the loop.
    assert found.rmse == pytest.approx(
        float(np.sqrt(np.mean((force - np.interp(x, way, middle)) ** 2))), rel=0.01
    )


@pytest.mark.slow
def test_the_middle_of_a_loop_is_not_told_of_a_hold() -> None:
    """A ball on a gel that sticks to it: nothing up to 14 mm, 80 N at 15 mm, which decay in a long hold, and a pull of
    30 N on the way back. One straight line leaves what the hold decays by, and lines no more than it.
    """
    way = np.linspace(0.0, 0.015, 1000)
    hold = np.full(20000, 0.015)
    touch = np.maximum(way - 0.014, 0.0) / 1e-3
    back = np.where(way > 0.0138, 85.0 * (way - 0.0144) / 6e-4, 0.0)
    force = np.concatenate(
        [80.0 * touch, 80.0 - 25.0 * (1.0 - np.exp(-np.linspace(0.0, 5.0, 20000))), back[::-1]]
    )
    x = np.concatenate([way, hold, way[::-1]])
    found = {fit.name: fit for fit in fit_laws([recording(x, force)])}
    assert found["piecewise"].rmse < found["polynomial"].rmse
