"""The quarter bicycle itself: the mass over the front wheel on a suspension fork, and the wheel.

    m_s z_s'' = S - m_s g                 the mass over the wheel
    m_u z_u'' = upward force - S - m_u g  wheel and lower fork
    S = k q + c q',  q = z_u - z_s        fork, shortened by q

z_s is the height of the mass less that at which the fork hangs free. The bicycle moves forward at a constant speed.
Standard library only: QuarterBicycle.fmu carries this file.

What is left out: the fork's rake, its friction and end stops, pitch, and the rider's arms and legs.

Parameters and sources:

- 80 kg of rider and frame, 40 % of them over the front wheel, 3.5 kg of front wheel and lower fork, fork stiffness
  18 kN/m, damping ratio 0.25 of the mass on the fork: B. Blockmans, half-car model of a mountain bicycle,
  github.com/bartblockmans/halfcar, matlab/Main_downhill.m (commit 6a4d93d). The damping coefficient is
  2 x 0.25 x sqrt(18 kN/m x 32 kg) = 379 N s/m.
- They sag the fork by 17 mm: 17 % of 100 mm of travel, within the 15 to 30 % that a manufacturer asks for (Ideal Bikes,
  Instructions for use EN 4210, section 40.1); a magazine advises 18 to 20 % (Mountain Biking UK, September 2022).
- The front wheel of bicycles that were weighed, without a fork: 2.0 kg (J. K. Moore, as quoted with his model's
  parameters, rider and frame 86 kg).
- To compare with: measured off-road, downhill, the largest loads came near 3 times the rider's weight at the front
  wheel, and the energy lay between 0 and 50 Hz (D. S. De Lorenzo, M. L. Hull, "Quantification of structural loading
  during off-road cycling", Journal of Biomechanical Engineering 121 (1999) 399-405; its abstract).
- Not found in the open: the parameters of Wilczynski & Hull (1994), Wang & Hull (1996, 1997), Good & McPhee (1999) and
  Redfield (2005); a measured damping of such a fork; and the identified values of N. Schoeneck, M. Nagurka,
  "Identification and modeling of a mountain bike front suspension subsystem", Bicycle and Motorcycle Dynamics 2023,
  the ones to replace the damping with.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s^2]."""

WHEEL_RADIUS = 0.33
"""Unloaded radius [m] of the article's 26 in wheel."""

State = tuple[float, float, float, float]
"""z_s [m], v_s [m/s], z_u [m], v_u [m/s]: mass over the wheel, then hub."""


@dataclass(frozen=True)
class QuarterBicycle:
    """Masses [kg], fork stiffness [N/m], fork damping [N s/m] and wheel radius [m]; sources in the module's text."""

    sprung_mass: float = 0.4 * 80.0
    unsprung_mass: float = 3.5
    fork_stiffness: float = 18e3
    fork_damping: float = 2.0 * 0.25 * math.sqrt(18e3 * 32.0)
    wheel_radius: float = WHEEL_RADIUS

    @property
    def weight(self) -> float:
        """Weight on the ground at rest [N]."""
        return (self.sprung_mass + self.unsprung_mass) * GRAVITY

    def accelerations(self, state: Sequence[float], upward_force: float) -> tuple[float, float]:
        """Return z_s'' and z_u'' [m/s^2] in `state` under the tire's `upward_force` [N]."""
        fork = self.fork_stiffness * (state[2] - state[0]) + self.fork_damping * (state[3] - state[1])
        return (
            fork / self.sprung_mass - GRAVITY,
            (upward_force - fork) / self.unsprung_mass - GRAVITY,
        )


@dataclass(frozen=True)
class HeldStep:
    """state(t + step) = moved state(t) + pushed upward_force + fallen, exact while the force [N] is held."""

    moved: tuple[State, ...]
    pushed: State
    fallen: State

    def advance(self, state: Sequence[float], upward_force: float) -> State:
        """Return the state after the step."""
        a, b, c, d = state
        next_state = tuple(
            row[0] * a + row[1] * b + row[2] * c + row[3] * d + push * upward_force + fall
            for row, push, fall in zip(self.moved, self.pushed, self.fallen, strict=True)
        )
        return next_state[0], next_state[1], next_state[2], next_state[3]


@lru_cache(maxsize=16)
def held_step(bicycle: QuarterBicycle, step: float) -> HeldStep:
    """Return how `bicycle` moves in `step` [s] > 0 under a force that is held.

    The exponential of the linear system, with the force and gravity as two more states: its Taylor series for a
    2^-n-th of the step, squared n times.
    """
    k, c, m_s, m_u = bicycle.fork_stiffness, bicycle.fork_damping, bicycle.sprung_mass, bicycle.unsprung_mass
    system = [
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [-k / m_s, -c / m_s, k / m_s, c / m_s, 0.0, -GRAVITY],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        [k / m_u, c / m_u, -k / m_u, -c / m_u, 1.0 / m_u, -GRAVITY],
        [0.0] * 6,
        [0.0] * 6,
    ]
    size = step * max(sum(map(abs, row)) for row in system)
    halvings = max(0, math.ceil(math.log2(2.0 * size))) if size > 0.0 else 0
    part = [[value * step / 2**halvings for value in row] for row in system]
    term = [[float(i == j) for j in range(6)] for i in range(6)]
    total = [row[:] for row in term]
    for n in range(1, 19):  # 0.5^19 / 19! is below the last digit
        term = [[value / n for value in row] for row in _product(term, part)]
        total = [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(total, term, strict=True)]
    for _ in range(halvings):
        total = _product(total, total)
    rows = [(row[0], row[1], row[2], row[3]) for row in total[:4]]
    pushed, fallen = ([row[column] for row in total[:4]] for column in (4, 5))
    return HeldStep(tuple(rows), (*pushed,), (*fallen,))  # type: ignore[arg-type]


def _product(left: list[list[float]], right: list[list[float]]) -> list[list[float]]:
    columns = list(zip(*right, strict=True))
    return [[sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in left]
