"""The quarter bicycle stepped beside a tire that is asked once per step, as a co-simulation master would.

Once per step the bicycle tells deflection and surface radius, the tire answers with its force, and the bicycle, which
is linear while that force is held, moves on by the step H exactly. Two ways to choose the moment that is told:

- held: the start of the step. The force then lags by H / 2 on average, which to a tire of stiffness k is a damping of
  -k H / 2 that works against the fork's: the error falls with the first power of H;
- midway: the middle of the step, to where the hub's present velocity carries it. Still one question per step, but the
  error falls with the second power of H.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from model import GRAVITY, Floats, QuarterBicycle, meet
from scipy.linalg import expm
from tirelab.errors import TirelabError
from tirelab.terrain import Ground

SteppedTire = Callable[[float, float, float], float]
"""(time [s], deflection [m], negative in the air, surface radius [m]) -> radial force [N]."""


@dataclass(frozen=True, eq=False)
class SteppedMotion:
    """A stepped ride; arrays of shape (n,), `states` (n, 4) as in `Motion`.

    time [s] of the states; asked [s]: when the tire was told deflection and radius, and answered with its force.
    """

    time: Floats
    asked: Floats
    states: Floats
    deflection: Floats
    surface_radius: Floats
    radial_force: Floats


def step_matrices(bicycle: QuarterBicycle, step: float) -> tuple[Floats, Floats, Floats]:
    """Return M, b, c of state(t + step) = M state(t) + b upward_force + c, exact while the force [N] is held."""
    system = np.zeros((6, 6))
    system[0, 1] = system[2, 3] = 1.0
    spring = np.array(
        [-bicycle.fork_stiffness, -bicycle.fork_damping, bicycle.fork_stiffness, bicycle.fork_damping]
    )
    system[1, :4] = spring / bicycle.sprung_mass
    system[3, :4] = -spring / bicycle.unsprung_mass
    system[3, 4] = 1.0 / bicycle.unsprung_mass
    system[1, 5] = system[3, 5] = -GRAVITY
    moved = expm(system * step)
    return moved[:4, :4], moved[:4, 4], moved[:4, 5]


def run(
    bicycle: QuarterBicycle,
    ground: Ground,
    tire: SteppedTire,
    *,
    speed: float,
    start: float,
    duration: float,
    step: float,
    state: Floats,
    midway: bool = True,
) -> SteppedMotion:
    """Return the ride from `start` [m] in `state` for `duration` [s] at `speed` [m/s], asking once a `step` [s]."""
    if not 0.0 < step <= duration:
        raise TirelabError(
            f"step {step:g} s of a ride of {duration:g} s; give a step above 0 s and within the ride"
        )
    moved, pushed, fallen = step_matrices(bicycle, step)
    count = round(duration / step) + 1
    states, told = np.empty((count, 4)), np.empty((count, 3))
    state, ahead = np.array(state, dtype=np.float64), 0.5 * step if midway else 0.0
    for i in range(count):
        time = i * step + ahead
        hub = float(state[2] + ahead * state[3])
        meeting = meet(ground, start + speed * time, hub, bicycle.wheel_radius)
        force = tire(time, meeting.deflection, meeting.surface_radius)
        states[i], told[i] = state, (meeting.deflection, meeting.surface_radius, force)
        state = moved @ state + pushed * (force * math.cos(meeting.inclination)) + fallen
    moments: Floats = step * np.arange(count, dtype=np.float64)
    return SteppedMotion(moments, moments + ahead, states, *told.T)
