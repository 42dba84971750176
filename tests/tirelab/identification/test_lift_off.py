"""Parts that the press lifts off, and those that it does not, made of simple laws."""

from __future__ import annotations

import numpy as np
import pytest
from tirelab.identification.law_fit import LawFit
from tirelab.identification.lift_off import lifts_off
from tirelab.identification.part_laws import fit_laws
from tirelab.identification.part_tire import best_writable, held_though_pressed, tire_of
from tirelab.recordings.recording import Recording

TIME = np.arange(0.0, 40.0, 0.02)
X = 0.01 * (1.0 - np.abs(1.0 - TIME / 10.0 % 2.0))
"""Two triangles to 10 mm."""
LARGEST = np.maximum.accumulate(X)
WAY = np.sign(np.gradient(X, TIME))
NOISE = 0.2 * np.random.default_rng(3).standard_normal(TIME.size)


def recorded(force: np.ndarray, x: np.ndarray = X) -> Recording:
    return Recording("part", TIME, x, np.full(TIME.size, np.inf), force + NOISE)


def set_by(part: float) -> np.ndarray:
    """A spring of 10 N/mm that begins where it has been pressed to by this part of the largest deflection so far."""
    return 1e4 * np.maximum(X - part * np.where(X < LARGEST, LARGEST, 0.0), 0.0)


STICKING = set_by(0.6) - 4.0 * ((X < 0.6 * LARGEST) & (X > 0.5 * LARGEST) & (WAY < 0.0))
"""What sticks pulls before it lifts off, over a tenth of the stroke."""


@pytest.mark.parametrize(
    "force",
    [set_by(0.6), set_by(0.4), STICKING, set_by(0.6) + 3.0],
    ids=["set", "less", "sticks", "not zeroed"],
)
def test_a_part_that_stays_behind_the_press_is_only_pressed(force: np.ndarray) -> None:
    part = recorded(force)
    assert lifts_off([part])
    assert lifts_off([recorded(1e4 * X), part])


@pytest.mark.parametrize(
    ("x", "force"),
    [
        (X, 1e4 * X * (1.0 + 0.1 * WAY)),
        (X, 1e4 * X + 30.0 * WAY),
        (X, 50.0 * WAY),
        (X - 0.005, 1e4 * (X - 0.005)),
        (X, 1e4 * np.maximum(X - 0.006, 0.0)),
        (X, 1e4 * X * (0.5 + 0.5 * (X >= LARGEST))),
        (X, np.minimum(1e4 * X, 40.0)),
    ],
    ids=["loop", "friction", "rubs only", "both ends", "gap", "softened", "saturated"],
)
def test_what_has_a_force_wherever_it_was_loaded_does_not_lift_off(x: np.ndarray, force: np.ndarray) -> None:
    assert not lifts_off([recorded(force, x)])


def test_the_law_that_is_proposed_of_it_cannot_pull() -> None:
    part = recorded(STICKING)
    fits: dict[str, LawFit] = {fit.name: fit for fit in fit_laws([part])}
    held = [fits[name] for name in ("power_preload", "linear", "piecewise", "power")]
    assert best_writable(held, [part]) == "power"
    assert not tire_of(fits["power"], [part], "").two_sided
    assert best_writable([fits["power_preload"]], [recorded(1e4 * X - 30.0)]) == "power_preload"


def test_a_law_that_pulls_is_written_where_it_is_asked_for_and_doubted() -> None:
    part, spring = recorded(set_by(0.6)), recorded(1e4 * X)
    fits: dict[str, LawFit] = {fit.name: fit for fit in fit_laws([part])}
    held, pressed = (tire_of(fits[name], [part], "") for name in ("power_preload", "power"))
    assert "--part power, linear_gap, power_gap cannot pull" in held_though_pressed(held, [part])
    assert held_though_pressed(pressed, [part]) == ""
    assert held_though_pressed(held, [spring]) == ""
