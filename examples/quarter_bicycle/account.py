"""The energy of a stepped ride: what the held force brought, and what of it the coupling made.

Between the steps the bicycle's motion under the held force is known exactly, so that every work is an integral over it
(Gauss-Legendre, four moments per step):

    change of E + damped = received          the bicycle's own balance
    made = received - the law's work along the same path

`made` is what a coupling brings in or takes out of nothing: the law, asked at every moment, would not have done it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bicycle import QuarterBicycle, held_step
from coupled import SteppedMotion
from model import Floats, energy
from tirelab.terrain import Ground, TireForce, contact


@dataclass(frozen=True)
class Account:
    """Energies of a stepped ride [J].

    change of the bicycle's energy; damped by the fork; received from the tire; made by the coupling; lag_power: what
    the coupling makes per second of lag [W], the integral of k deflection' w over the ride, with k the law's stiffness
    and w the velocity at which the hub is pressed on the tire.
    """

    change: float
    damped: float
    received: float
    made: float
    lag_power: float

    @property
    def imbalance(self) -> float:
        """What the balance does not account for [J]."""
        return self.change + self.damped - self.received


def account(
    bicycle: QuarterBicycle,
    ground: Ground,
    law: TireForce,
    ride: SteppedMotion,
    *,
    speed: float,
    start: float,
) -> Account:
    """Return the energies of `ride`, which began at `start` [m] and went on at `speed` [m/s] under the tire's `law`."""
    step = float(ride.time[1] - ride.time[0])
    shares, weights = np.polynomial.legendre.leggauss(4)
    damped = received = by_law = lag_power = 0.0
    first, held = ride.states[:-1], ride.upward_force[:-1]
    for share, weight in zip(0.5 * (shares + 1.0), 0.5 * step * weights, strict=True):
        part = held_step(bicycle, float(share * step))
        states = first @ np.array(part.moved).T + np.outer(held, part.pushed) + part.fallen
        time = ride.time[:-1] + share * step
        upward, power = _pressed(bicycle, ground, law, states, start + speed * time, speed)
        damped += weight * bicycle.fork_damping * float(np.sum((states[:, 3] - states[:, 1]) ** 2))
        received += weight * float(held @ states[:, 3])
        by_law += weight * float(upward @ states[:, 3])
        lag_power += weight * float(np.sum(power))
    level = energy(bicycle, ride.states[[0, -1]])
    return Account(float(level[1] - level[0]), damped, received, received - by_law, lag_power)


def _pressed(
    bicycle: QuarterBicycle, ground: Ground, law: TireForce, states: Floats, position: Floats, speed: float
) -> tuple[Floats, Floats]:
    """Return the law's upward force [N] and k deflection' w [W/s] in `states`."""
    touch = contact(ground, position, states[:, 2], bicycle.wheel_radius)
    down = touch.deflection > 0.0
    force, stiffness = np.zeros(position.size), np.zeros(position.size)
    x, radius = touch.deflection[down], touch.surface_radius[down]
    force[down] = law(x, radius)
    stiffness[down] = (law(1.001 * x, radius) - law(0.999 * x, radius)) / (0.002 * x)
    pressing = -np.cos(touch.inclination) * states[:, 3]
    rate = pressing - np.sin(touch.inclination) * speed
    return force * np.cos(touch.inclination), stiffness * rate * pressing
