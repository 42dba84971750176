"""A quarter bicycle: the mass over the front wheel on a suspension fork, the wheel, and any tire under it.

    m_s z_s'' = S - m_s g                          the mass over the wheel
    m_u z_u'' = F cos(inclination) - S - m_u g     wheel and lower fork
    S = k q + c q',  q = z_u - z_s                 fork, shortened by q

The bicycle moves forward at a constant speed v. The tire pushes with F(deflection, surface radius) along the line from
the ground to the hub, both from the wheel's contact with the ground. z_s is the height of the mass less that at which
the fork hangs free. Three works complete the energies, so that the balance closes to the integrator's tolerance:

    E(t) - E(0) + damped + stored = drive
    E = m_s v_s^2 / 2 + m_u v_u^2 / 2 + g (m_s z_s + m_u z_u) + k q^2 / 2
    damped' = c q'^2;   stored' = F deflection';   drive' = -F sin(inclination) v

`drive` is what the rider or the slope pays to keep the speed against the horizontal part of the force. A tire on ground
of one radius gives back all that it has stored; where the radius changes under load it does not: the law then makes or
takes energy, and `stored` less the energy in the tire is that amount.

Values, sources and what is left out are in `bicycle.py`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from bicycle import GRAVITY, WHEEL_RADIUS, QuarterBicycle
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tirelab.errors import TirelabError
from tirelab.terrain import Ground, contact, reach, rolling_path
from wheel import Meeting, Track, meet

Floats = NDArray[np.float64]
Tire = Callable[[float, float], float]
"""(deflection [m] > 0, surface radius [m]) -> radial force [N]."""

LONGEST_STEP = 5e-3
"""Longest step [s] of the integrator, lest it pass over an obstacle: 5 cm at 10 m/s."""


@dataclass(frozen=True, eq=False)
class Course:
    """Where the bicycle rides: over `ground`, from `start` [m], for `duration` [s] at the constant `speed` [m/s]."""

    ground: Ground
    speed: float
    start: float
    duration: float


def energy(bicycle: QuarterBicycle, states: Floats) -> Floats:
    """Return E [J] in `states`, rows of (z_s, v_s, z_u, v_u); shape (n,)."""
    z_s, v_s, z_u, v_u = states.T[:4]
    joules: Floats = (
        0.5 * (bicycle.sprung_mass * v_s**2 + bicycle.unsprung_mass * v_u**2)
        + GRAVITY * (bicycle.sprung_mass * z_s + bicycle.unsprung_mass * z_u)
        + 0.5 * bicycle.fork_stiffness * (z_u - z_s) ** 2
    )
    return joules


def track_of(ground: Ground, first: float, last: float, wheel_radius: float = WHEEL_RADIUS) -> Track:
    """Return what of `ground` a wheel meets with its hub between `first` and `last` [m].

    Raises TirelabError where the ground does not reach as far.
    """
    start, end = reach(ground, wheel_radius)
    if not start - 1e-9 <= first <= last <= end + 1e-9:
        raise TirelabError(
            f"a ride from s = {first:g} m to {last:g} m on {ground.name}; its wheel has ground beneath it from "
            f"{start:g} m to {end:g} m"
        )
    margin = wheel_radius + 4.0 * ground.spacing
    kept = (ground.s >= first - margin) & (ground.s <= last + margin)
    columns = (ground.s, ground.z, ground.direction, ground.arc, ground.curvature)
    return Track(ground.spacing, *(tuple(column[kept].tolist()) for column in columns))


def pressed(tire: Tire, meeting: Meeting) -> float:
    """Return the tire's force [N], zero in the air."""
    return tire(meeting.deflection, meeting.surface_radius) if meeting.deflection > 0.0 else 0.0


@dataclass(frozen=True, eq=False)
class Motion:
    """A ride of the quarter bicycle; arrays of shape (n,), `states` (n, 4) with z_s [m], v_s [m/s], z_u [m], v_u [m/s].

    time [s]; position of the hub [m]; deflection [m]; surface_radius [m]; radial_force [N]; energy, damped, stored,
    drive [J]; lift_offs and landings: moments [s] at which the wheel left and met the ground.
    """

    time: Floats
    position: Floats
    states: Floats
    deflection: Floats
    surface_radius: Floats
    radial_force: Floats
    energy: Floats
    damped: Floats
    stored: Floats
    drive: Floats
    lift_offs: Floats
    landings: Floats

    @property
    def hub_height(self) -> Floats:
        """Height of the hub [m]."""
        height: Floats = self.states[:, 2]
        return height

    @property
    def fork_travel(self) -> tuple[float, float]:
        """Least and greatest shortening of the fork [m]; what a fork with end stops would have to allow."""
        shortening = self.states[:, 2] - self.states[:, 0]
        return float(shortening.min()), float(shortening.max())

    @property
    def imbalance(self) -> Floats:
        """What the energy balance does not account for [J]."""
        left: Floats = self.energy - self.energy[0] + self.damped + self.stored - self.drive
        return left


def at_rest(bicycle: QuarterBicycle, ground: Ground, tire: Tire, position: float) -> Floats:
    """Return the state (z_s, v_s, z_u, v_u) in which the bicycle stands still at `position` [m]."""
    free = float(rolling_path(ground, np.array([position]), bicycle.wheel_radius)[0])
    track = track_of(ground, position, position, bicycle.wheel_radius)

    def excess(hub_height: float) -> float:
        meeting = meet(track, position, hub_height, bicycle.wheel_radius)
        return pressed(tire, meeting) * math.cos(meeting.inclination) - bicycle.weight

    deepest = free - 0.5 * bicycle.wheel_radius
    if excess(deepest) < 0.0:
        raise TirelabError(
            f"the tire does not carry {bicycle.weight:.0f} N with half its radius; give a stiffer one"
        )
    hub = float(brentq(excess, deepest, free, xtol=1e-14, rtol=1e-14))
    sag = bicycle.sprung_mass * GRAVITY / bicycle.fork_stiffness
    return np.array([hub - sag, 0.0, hub, 0.0])


def integrate(
    bicycle: QuarterBicycle,
    course: Course,
    tire: Tire,
    *,
    state: Floats | None = None,
    samples: int = 2001,
    tolerance: float = 1e-7,
) -> Motion:
    """Return the motion along `course`, bicycle, tire and ground as one system.

    state: (z_s, v_s, z_u, v_u) at the start, at rest if not given. tolerance: relative, of an embedded Runge-Kutta pair
    of order 5 whose absolute tolerance is 1e-3 of it (in m, m/s and J). The sampled ground is smooth in pieces only,
    where higher orders gain nothing: order 8 took four times as long.
    """
    ground, speed, start, duration = course.ground, course.speed, course.start, course.duration
    track = track_of(ground, start, start + speed * duration, bicycle.wheel_radius)
    first = at_rest(bicycle, ground, tire, start) if state is None else np.asarray(state, dtype=np.float64)

    def met(time: float, y: Floats) -> Meeting:
        return meet(track, start + speed * time, float(y[2]), bicycle.wheel_radius)

    def derivative(time: float, y: Floats) -> list[float]:
        meeting = met(time, y)
        force = pressed(tire, meeting)
        upward, forward = force * math.cos(meeting.inclination), force * math.sin(meeting.inclination)
        sprung, unsprung = bicycle.accelerations(y.tolist(), upward)
        damped = bicycle.fork_damping * (y[3] - y[1]) ** 2
        return [y[1], sprung, y[3], unsprung, damped, -forward * speed - upward * y[3], -forward * speed]

    def gap(time: float, y: Floats) -> float:
        return met(time, y).deflection

    moments = np.linspace(0.0, duration, samples)
    solution = solve_ivp(
        derivative,
        (0.0, duration),
        np.concatenate([first, np.zeros(3)]),
        method="RK45",
        t_eval=moments,
        events=(_crossing(gap, -1.0), _crossing(gap, 1.0)),
        rtol=tolerance,
        atol=1e-3 * tolerance,
        max_step=LONGEST_STEP,
    )
    if not solution.success:
        raise TirelabError(f"the ride cannot be integrated beyond {solution.t[-1]:g} s: {solution.message}")
    states = np.ascontiguousarray(solution.y[:4].T)
    position = start + speed * moments
    touch = contact(ground, position, states[:, 2], bicycle.wheel_radius)
    force = [
        pressed(tire, Meeting(x, r, 0.0)) for x, r in zip(touch.deflection, touch.surface_radius, strict=True)
    ]
    return Motion(
        moments,
        position,
        states,
        touch.deflection,
        touch.surface_radius,
        np.array(force),
        energy(bicycle, states),
        *solution.y[4:7],
        *solution.t_events,
    )


def _crossing(gap: Callable[[float, Floats], float], direction: float) -> Callable[[float, Floats], float]:
    """Return `gap` as an event of solve_ivp that counts zeros passed in `direction`."""

    def event(time: float, y: Floats) -> float:
        return gap(time, y)

    event.direction = direction  # type: ignore[attr-defined]
    return event
