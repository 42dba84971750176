"""The quarter bicycle coupled to a tire that is evaluated once per step: a co-simulation with its master, in Python.

Once per step H the bicycle sends deflection and surface radius, the tire returns its force, and the bicycle, which is
linear while that force is constant, is integrated exactly. Two choices decide the error.

When the force acts. A master that runs the two units one after the other applies it at once (Gauss-Seidel); one that
runs them side by side applies it during the next step (Jacobi; `late`).

What the tire receives. With the deflection at the start of the step the force lags behind the motion by H / 2 on
average, and by 3 H / 2 where it acts late. For a tire of stiffness k a lag T is a damping of -k T, which works against
the fork's: the error falls with the first power of H, and the coupling adds energy, on level ground T times the
integral of k deflection'^2. With the deflection extrapolated by T at the hub's present velocity (`look_ahead`) the lag
vanishes and the error falls with the second power of H, still with one evaluation per step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from bicycle import HeldStep, QuarterBicycle, State, held_step
from model import Course, Floats, track_of
from tirelab.errors import TirelabError
from wheel import Meeting, OffTheGroundError, Track, meet

SteppedTire = Callable[[float, float, float], float]
"""(time [s], deflection [m], negative in the air, surface radius [m]) -> radial force [N]."""


@dataclass(frozen=True, eq=False)
class SteppedMotion:
    """A stepped ride; arrays of shape (n,), `states` (n, 4) with z_s [m], v_s [m/s], z_u [m], v_u [m/s].

    time [s] of the states; asked [s]: the time for which the tire received deflection [m] and surface_radius [m] and
    returned radial_force [N]; upward_force [N]: on the hub during the step that begins at `time`.
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


@dataclass(frozen=True)
class Coupling:
    """How bicycle and tire are coupled.

    look_ahead: [s] by which the deflection is extrapolated, None for the `lag` of the coupling
    late: whether the force acts one step later; the first force then acts during the first two steps
    """

    look_ahead: float | None = None
    late: bool = False


def lag(step: float, late: bool) -> float:
    """Return the mean lag [s] of a force that is held for a step [s], which a look-ahead of the same length removes."""
    return (1.5 if late else 0.5) * step


def ahead(
    track: Track, bicycle: QuarterBicycle, state: State, position: float, speed: float, time: float
) -> Meeting:
    """Return how the wheel will meet the ground in `time` [s], the hub going on at its velocity."""
    return meet(track, position + speed * time, state[2] + time * state[3], bicycle.wheel_radius)


def run(
    bicycle: QuarterBicycle,
    course: Course,
    tire: SteppedTire,
    *,
    step: float,
    state: Floats,
    coupling: Coupling = Coupling(),
) -> SteppedMotion:
    """Return the ride along `course`, beginning in `state`, with one evaluation of the tire every `step` [s].

    Raises TirelabError for steps outside the ride, ground that ends before it, and rides that diverge.
    """
    ground, speed, start, duration = course.ground, course.speed, course.start, course.duration
    if not 0.0 < step <= duration:
        raise TirelabError(
            f"step {step:g} s of a ride of {duration:g} s; give a step above 0 s and within the ride"
        )
    look_ahead = lag(step, coupling.late) if coupling.look_ahead is None else coupling.look_ahead
    count = round(duration / step) + 1
    last = start + speed * ((count - 1) * step + max(look_ahead, 0.5 * step))
    track = track_of(ground, start, last, bicycle.wheel_radius)
    moving: HeldStep = held_step(bicycle, step)
    here: State = (float(state[0]), float(state[1]), float(state[2]), float(state[3]))
    states, sent, upward = np.empty((count, 4)), np.empty((count, 3)), np.empty(count)
    answer = math.nan
    for i in range(count):
        time = i * step
        try:
            position = start + speed * time
            meeting = ahead(track, bicycle, here, position, speed, look_ahead)
            middle = (
                meeting
                if look_ahead == 0.5 * step
                else ahead(track, bicycle, here, position, speed, 0.5 * step)
            )
        except OffTheGroundError as error:
            raise TirelabError(f"the ride ends at {time:g} s: {error}") from None
        before, answer = answer, tire(time + look_ahead, meeting.deflection, meeting.surface_radius)
        acting = before if coupling.late and i else answer
        upward[i] = acting * math.cos(middle.inclination)
        states[i], sent[i] = here, (meeting.deflection, meeting.surface_radius, answer)
        here = moving.advance(here, float(upward[i]))
    moments: Floats = step * np.arange(count, dtype=np.float64)
    return SteppedMotion(moments, moments + look_ahead, states, sent[:, 0], sent[:, 1], sent[:, 2], upward)
