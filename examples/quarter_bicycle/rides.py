"""The rides of this example: over a log and over rough ground, from rest on the ground at a constant speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from bicycle import QuarterBicycle
from model import Course, Floats, Motion, Tire, at_rest, integrate, track_of
from radialtire import TireModel, power_law
from tirelab.terrain import Ground, flat, force_at, ground_from, iso8608, log, place, reach, root
from wheel import Track

SLACK = 0.2
"""Ground [m] beyond the ride's end, for the look-ahead."""


@dataclass(frozen=True, eq=False)
class RideOnGround:
    """A bicycle that rides from `start` [m] in `state` for `duration` [s] at `speed` [m/s]."""

    name: str
    bicycle: QuarterBicycle
    ground: Ground
    speed: float
    start: float
    duration: float
    state: Floats

    @property
    def track(self) -> Track:
        """The ground that the ride needs."""
        last = min(
            self.start + self.speed * self.duration + SLACK, reach(self.ground, self.bicycle.wheel_radius)[1]
        )
        return track_of(self.ground, self.start, last, self.bicycle.wheel_radius)

    def integrated(self, tire: Tire, samples: int) -> Motion:
        """Return the ride as one system with `tire`, with `samples` times."""
        return integrate(self.bicycle, self.course, tire, state=self.state, samples=samples)

    @property
    def course(self) -> Course:
        """Ground, speed, start and duration."""
        return Course(self.ground, self.speed, self.start, self.duration)


def elastic(tire: TireModel, pressure: float | None = None) -> Tire:
    """Return the elastic law of `tire`: (deflection [m] > 0, surface radius [m]) -> force [N].

    pressure [Pa]: gauge pressure at which it is ridden, where the tire says what that does to its force
    """
    if pressure is not None:
        at_pressure = force_at(tire, {"pressure": pressure})
        return lambda x, radius: float(at_pressure(np.array([x]), np.array([radius]))[0])

    def force(deflection: float, surface_radius: float) -> float:
        return power_law.force(deflection, *tire.law.coefficients(surface_radius))

    return force


def elastic_array(tire: TireModel) -> Callable[[Floats, Floats], Floats]:
    """Return the elastic law of `tire` for arrays."""
    vectorised = np.vectorize(elastic(tire), otypes=[np.float64])

    def force(deflection: Floats, surface_radius: Floats) -> Floats:
        newtons: Floats = vectorised(deflection, surface_radius) if deflection.size else np.zeros(0)
        return newtons

    return force


def over_obstacle(tire: TireModel, speed: float, *, radius: float, half_sunk: bool) -> RideOnGround:
    """Return a ride over a log of `radius` [m], or a root of it, 0.6 m before it to 1.2 m after."""
    obstacle = root(radius) if half_sunk else log(radius)
    ground = ground_from(place(flat(8.0), obstacle, 4.0), 0.002)
    return _from_rest(f"{obstacle.name}, {speed:g} m/s", ground, tire, speed, 3.4, 1.8)


def over_rough_ground(
    tire: TireModel, speed: float, *, road_class: str = "D", seed: int = 1, length: float = 20.0
) -> RideOnGround:
    """Return a ride over `length` [m] of ISO 8608 ground."""
    ground = ground_from(iso8608(road_class, length + 1.5, seed), 0.005)
    return _from_rest(f"{ground.name}, {speed:g} m/s", ground, tire, speed, 0.5, length)


GROUNDS: dict[str, Callable[[TireModel, float], RideOnGround]] = {
    "log": partial(over_obstacle, radius=0.05, half_sunk=False),
    "root": partial(over_obstacle, radius=0.05, half_sunk=True),
    "class-d": over_rough_ground,
}
"""The grounds to choose from: (tire, speed [m/s]) -> ride."""


def _from_rest(
    name: str, ground: Ground, tire: TireModel, speed: float, start: float, length: float
) -> RideOnGround:
    bicycle = QuarterBicycle()
    state = at_rest(bicycle, ground, elastic(tire), start)
    return RideOnGround(name, bicycle, ground, speed, start, length / speed, state)
