"""The quarter bicycle stepped beside a tire that is asked once per step: a co-simulation, master and all, in Python.

Once per step H the bicycle tells deflection and surface radius, the tire answers with its force, and the bicycle, which
is linear while that force is held, moves on exactly. Two things decide how good that is.

When the answer acts. A master that runs the two units one after the other has it act at once; one that runs them side
by side hands it over at the step's end, so that it acts during the next step (`late`).

What is told. As it is at the start of the step, the force lags behind the motion by H / 2 on average, and by 3 H / 2
where it acts late. To a tire of stiffness k a lag T is a damping of -k T, which works against the fork's: the error
falls with the first power of H, and the coupling makes energy out of nothing, on level ground T times the integral of
k deflection'^2. Told by T ahead instead, where the hub's present velocity carries it (`look_ahead`), the lag is gone
and the error falls with the second power of H, still with one question per step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from bicycle import HeldStep, QuarterBicycle, State, held_step
from model import Floats, track_of
from tirelab.errors import TirelabError
from tirelab.terrain import Ground
from wheel import Meeting, OffTheGroundError, Track, meet

SteppedTire = Callable[[float, float, float], float]
"""(time [s], deflection [m], negative in the air, surface radius [m]) -> radial force [N]."""


@dataclass(frozen=True, eq=False)
class SteppedMotion:
    """A stepped ride; arrays of shape (n,), `states` (n, 4) with z_s [m], v_s [m/s], z_u [m], v_u [m/s].

    time [s] of the states; asked [s]: the moment for which the tire was told deflection [m] and surface_radius [m] and
    answered with its radial_force [N]; upward_force [N]: what acts on the hub in the step that begins at `time`.
    """

    time: Floats
    asked: Floats
    states: Floats
    deflection: Floats
    surface_radius: Floats
    radial_force: Floats
    upward_force: Floats

    @property
    def hub_height(self) -> Floats:
        """Height of the hub [m]."""
        height: Floats = self.states[:, 2]
        return height


def lag(step: float, late: bool) -> float:
    """Return by how much [s] a force that is held for a step [s] comes after what was told: what to look ahead by."""
    return (1.5 if late else 0.5) * step


def ahead(
    track: Track, bicycle: QuarterBicycle, state: State, position: float, speed: float, time: float
) -> Meeting:
    """Return how the wheel will meet the ground in `time` [s], the hub going on at its velocity."""
    return meet(track, position + speed * time, state[2] + time * state[3], bicycle.wheel_radius)


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
    look_ahead: float | None = None,
    late: bool = False,
) -> SteppedMotion:
    """Return the ride from `start` [m] in `state` for `duration` [s] at `speed` [m/s], asking once a `step` [s].

    look_ahead [s]: None takes the `lag` of the coupling; late: the force acts one step after the answer, the first
    answer during the first two
    Raises TirelabError for steps outside the ride, ground that ends before it, and rides that diverge.
    """
    if not 0.0 < step <= duration:
        raise TirelabError(
            f"step {step:g} s of a ride of {duration:g} s; give a step above 0 s and within the ride"
        )
    told_ahead = lag(step, late) if look_ahead is None else look_ahead
    count = round(duration / step) + 1
    last = start + speed * ((count - 1) * step + max(told_ahead, 0.5 * step))
    track = track_of(ground, start, last, bicycle.wheel_radius)
    moving: HeldStep = held_step(bicycle, step)
    here: State = (float(state[0]), float(state[1]), float(state[2]), float(state[3]))
    states, told, upward = np.empty((count, 4)), np.empty((count, 3)), np.empty(count)
    answer = math.nan
    for i in range(count):
        time = i * step
        try:
            position = start + speed * time
            meeting = ahead(track, bicycle, here, position, speed, told_ahead)
            middle = (
                meeting
                if told_ahead == 0.5 * step
                else ahead(track, bicycle, here, position, speed, 0.5 * step)
            )
        except OffTheGroundError as error:
            raise TirelabError(f"the ride ends at {time:g} s: {error}") from None
        before, answer = answer, tire(time + told_ahead, meeting.deflection, meeting.surface_radius)
        acting = before if late and i else answer
        upward[i] = acting * math.cos(middle.inclination)
        states[i], told[i] = here, (meeting.deflection, meeting.surface_radius, answer)
        here = moving.advance(here, float(upward[i]))
    moments: Floats = step * np.arange(count, dtype=np.float64)
    return SteppedMotion(moments, moments + told_ahead, states, told[:, 0], told[:, 1], told[:, 2], upward)
