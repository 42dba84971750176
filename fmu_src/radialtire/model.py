"""A tire: one elastic law, the effects that act with it, and the range in which it was tested."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol

from . import hull1996, power_law, tracking
from .effect import PLACES, Effect, Instant, State
from .hull1996 import FLAT_RADIUS, Hull1996
from .parameter import Parameter, ParameterError
from .tracking import UNTRACKED, Track

DEFLECTION_LOWEST = -1e3
"""Lowest deflection accepted [m]: a wheel this high above the ground is a mistake."""

DEFLECTION_HIGHEST = hull1996.WHEEL_RADIUS
"""Highest deflection accepted [m]: with more than the wheel's radius the axle would be below the ground."""

READING_NOISE = Parameter(
    "reading_noise",
    "s",
    "m",
    0.0,
    0.0,
    0.01,
    "standard deviation of the noise in the measured deflection",
)

TANGENT_STEP = 1e-7
"""Half the distance [m] over which the tangent of a tire with effects is taken."""


class InputError(ValueError):
    """A deflection or surface radius that no tire can have; the sentence names it, its value and what is allowed."""


class Law(Protocol):
    """An elastic law F = A x^B: its name, its parameters, and A and B on a surface."""

    name: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]."""
        ...


@dataclass(frozen=True)
class TestedRange:
    """Where a tire was measured: curvatures 1/R [1/m], deflections up to [m] and forces up to [N]."""

    curvature_min: float = 1.0 / hull1996.CONCAVE_RADIUS_RANGE[1]
    curvature_max: float = 1.0 / hull1996.CONVEX_RADIUS_RANGE[0]
    deflection_max: float = hull1996.DEFLECTION_MAX
    force_max: float = hull1996.FORCE_MAX

    __test__: ClassVar[bool] = False  # not a test class, whatever its name

    def contains(self, deflection: float, surface_radius: float, force: float) -> bool:
        """Return whether the surface's curvature, the deflection [m] and the force [N] all lie inside."""
        return (
            self.curvature_min <= 1.0 / surface_radius <= self.curvature_max
            and deflection <= self.deflection_max
            and force <= self.force_max
        )


class ModelState(NamedTuple):
    """The state of a tire after a sample: plain numbers and tuples of them, so that JSON can carry it.

    time: [s] of the last sample; deflection: [m] measured there; rate [m/s] and acceleration [m/s^2] of the measurement
    started: whether there was a sample; effects: their states in the order of the tire's effects
    start: [s] time of the first sample; reading, compression: tracks of the measured deflection and of the tire's own
    """

    time: float
    deflection: float
    rate: float
    acceleration: float
    started: bool
    effects: tuple[State, ...]
    start: float = 0.0
    reading: Track = UNTRACKED
    compression: Track = UNTRACKED

    @classmethod
    def restored(cls, values: Sequence[Any]) -> ModelState:
        """Return the state whose values went through JSON, which has lists in place of tuples."""
        time, deflection, rate, acceleration, started, effects, start, reading, compression = values
        return cls(
            time,
            deflection,
            rate,
            acceleration,
            started,
            tuple(tuple(state) for state in effects),
            start,
            tracking.restored(reading),
            tracking.restored(compression),
        )


def check_inputs(deflection: float, surface_radius: float) -> None:
    """Raise InputError unless `deflection` [m] and `surface_radius` [m] are numbers that a wheel can meet."""
    if not DEFLECTION_LOWEST <= deflection <= DEFLECTION_HIGHEST:
        raise InputError(
            f"deflection = {deflection:.17g} m is not allowed; it must lie between {DEFLECTION_LOWEST:g} m (wheel "
            f"in the air) and {DEFLECTION_HIGHEST:g} m (the wheel's radius)"
        )
    if not (surface_radius > 0.0 or surface_radius < 0.0):
        raise InputError(
            f"surface_radius = {surface_radius:.17g} m is not allowed; it must be positive (convex), negative "
            "(concave), or infinite (flat)"
        )


@dataclass(frozen=True)
class TireModel:
    """An elastic law with effects.

    effects: pairs of an effect and its parameters' values, at most one of each name, ordered by place
    tested_range: where the tire was measured, or None where that is not known
    reading_noise: [m] standard deviation of the noise in the measured deflection, which rate and acceleration must not
    follow (see `tracking`); 0 takes the deflection as exact
    """

    law: Law = Hull1996()
    effects: tuple[tuple[Effect, State], ...] = ()
    tested_range: TestedRange | None = TestedRange()
    name: str = "Hull, Wang & Moore 1996"
    source: str = "Hull, Wang & Moore, Cycling Science, Spring 1996"
    reading_noise: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "reading_noise", READING_NOISE.checked(self.reading_noise))
        names = [effect.name for effect, _ in self.effects]
        if len(set(names)) < len(names):
            raise ParameterError(f"an effect occurs twice in {', '.join(names)}; keep one of each")
        order = [PLACES.index(effect.place) for effect, _ in self.effects]
        if order != sorted(order):
            raise ParameterError(f"the effects {', '.join(names)} must stand in the order of the signal path")
        checked = tuple((effect, effect.checked(values)) for effect, values in self.effects)
        object.__setattr__(self, "effects", checked)

    @cached_property
    def _stages(self) -> dict[str, tuple[tuple[int, Effect, State], ...]]:
        return {
            place: tuple((i, e, values) for i, (e, values) in enumerate(self.effects) if e.place == place)
            for place in PLACES
        }

    @cached_property
    def differentiates(self) -> bool:
        """Whether an effect uses rate or acceleration."""
        return any(effect.differentiates for effect, _ in self.effects)

    @property
    def initial_state(self) -> ModelState:
        """The state of a tire before the first sample."""
        return ModelState(
            0.0, 0.0, 0.0, 0.0, False, tuple(effect.initial_state for effect, _ in self.effects)
        )

    def step(
        self, deflection: float, surface_radius: float, time: float, state: ModelState
    ) -> tuple[float, ModelState]:
        """Return the radial force [N] at `time` [s] and the state after it.

        Pure: called again with the same state it gives the same answer, so a step may be tried and discarded.
        At the time of the state itself, rate and acceleration are those of the state.
        """
        A, B = self.law.coefficients(surface_radius)
        if not self.effects:
            return power_law.force(deflection, A, B), state

        bend = 0.0 if abs(surface_radius) >= FLAT_RADIUS else 1.0 / surface_radius
        first = not state.started
        start = time if first else state.start
        interval = 0.0 if first else time - state.time
        states = list(state.effects)

        def through(place: str, signal: float, x: float, v: float, elastic: float) -> float:
            for i, effect, values in self._stages[place]:
                instant = Instant(time - start, interval, first, x, v, acceleration, A, B, elastic, bend)
                signal, states[i] = effect.respond(signal, instant, states[i], values)
            return signal

        reading = self._tracked(state.reading, deflection, interval, first)
        rate, acceleration = tracking.rate(reading), tracking.acceleration(reading)
        x = through("deflection", deflection, deflection, rate, 0.0)
        x = through("series", x, x, rate, 0.0)
        compression = reading
        if self._stages["deflection"] or self._stages["series"]:
            compression = self._tracked(state.compression, x, interval, first)
        v = tracking.rate(compression)

        bare = power_law.force(x, A, B)
        elastic = through("scale", 1.0, x, v, bare) * bare
        force = through("parallel", elastic, x, v, elastic)
        if force < 0.0:
            force = 0.0
        force = through("inertia", force, x, v, elastic)
        force = through("reading", force, x, v, elastic)
        after = ModelState(
            time, deflection, rate, acceleration, True, tuple(states), start, reading, compression
        )
        return force, after

    def _tracked(self, track: Track, deflection: float, interval: float, first: bool) -> Track:
        if not self.differentiates:
            return track
        if first:
            return tracking.begin(deflection)
        if interval > 0.0:
            return tracking.follow(track, interval, deflection, self.reading_noise)
        return track

    def stiffness(self, deflection: float, surface_radius: float, state: ModelState) -> float:
        """Return the tangent dF/dx [N/m] at the time of `state`, everything but the deflection held constant."""
        if not self.effects:
            return power_law.stiffness(deflection, *self.law.coefficients(surface_radius))
        above, _ = self.step(deflection + TANGENT_STEP, surface_radius, state.time, state)
        below, _ = self.step(deflection - TANGENT_STEP, surface_radius, state.time, state)
        return (above - below) / (2.0 * TANGENT_STEP)

    def in_tested_range(self, deflection: float, surface_radius: float, force: float) -> bool:
        """Return whether surface, deflection and force lie in the tested range; False where that is not known."""
        return self.tested_range is not None and self.tested_range.contains(deflection, surface_radius, force)
