"""A tire: one elastic law, the effects that act with it, and the range in which it was tested."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Protocol

from . import flat_step, hull1996, power_law
from .effect import PLACES, Effect, State
from .flat_step import (
    ACCELERATION,
    FOLLOWED,
    NOISE,
    PARAMETERS,
    RATE,
    TANGENT_STEP,
    TIME,
    TRACK,
    TRACKED,
    SignalPath,
    laid_out,
)
from .hull1996 import Hull1996
from .learned_remainder import LearnedRemainder
from .parameter import Parameter, ParameterError

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
    remainder: a force without physics that is added to all others, None where nobody asked for one
    """

    law: Law = Hull1996()
    effects: tuple[tuple[Effect, State], ...] = ()
    tested_range: TestedRange | None = TestedRange()
    name: str = "Hull, Wang & Moore 1996"
    source: str = "Hull, Wang & Moore, Cycling Science, Spring 1996"
    reading_noise: float = 0.0
    remainder: LearnedRemainder | None = None

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
    def differentiates(self) -> bool:
        """Whether an effect uses rate or acceleration."""
        learned = self.remainder is not None and self.remainder.differentiates
        return learned or any(effect.differentiates for effect, _ in self.effects)

    @property
    def bare(self) -> bool:
        """Whether the tire is its elastic law alone."""
        return not self.effects and self.remainder is None

    @cached_property
    def _flat(self) -> tuple[SignalPath, State, State]:
        """Where the numbers of the effects stand, their parameters, and the state before the first sample."""
        effects = tuple(effect for effect, _ in self.effects)
        follows = self.differentiates and any(e.place in ("deflection", "series") for e in effects)
        path, parameters, initial_state = laid_out(effects, TRACK * (self.differentiates + follows))
        parameters[TRACKED], parameters[FOLLOWED] = float(self.differentiates), float(follows)
        parameters[NOISE] = self.reading_noise
        at = PARAMETERS
        for effect, values in self.effects:
            parameters[at : at + 1 + len(values)] = (1.0, *values)
            at += 1 + len(effect.parameters)
        return path, tuple(parameters), tuple(initial_state)

    @property
    def initial_state(self) -> State:
        """The state of a tire before the first sample: a row of numbers (see `flat_step`)."""
        return self._flat[2]

    def step(
        self, deflection: float, surface_radius: float, time: float, state: State
    ) -> tuple[float, State]:
        """Return the radial force [N] at `time` [s] and the state after it.

        Pure: called again with the same state it gives the same answer, so a step may be tried and discarded.
        At the time of the state itself, rate and acceleration are those of the state.
        """
        law = self.law.coefficients(surface_radius)
        if self.bare:
            return power_law.force(deflection, *law), state
        path, parameters, _ = self._flat
        after = list(state)
        force, _ = flat_step.step(
            path, law, (deflection, surface_radius, time, 0.0, 0.0), parameters, state, after
        )
        if self.remainder is not None:
            force += self.remainder.added(deflection, surface_radius, after[RATE], after[ACCELERATION])
        return force, tuple(after)

    def tire_deflection(self, deflection: float, surface_radius: float, time: float, state: State) -> float:
        """Return the tire's own deflection [m] at `time` [s]: the measured one after offset, lag and series springs."""
        if not self.effects:
            return deflection
        path, parameters, _ = self._flat
        law = self.law.coefficients(surface_radius)
        _, x = flat_step.step(
            path, law, (deflection, surface_radius, time, 0.0, 0.0), parameters, state, list(state)
        )
        return x

    def stiffness(self, deflection: float, surface_radius: float, state: State) -> float:
        """Return the tangent dF/dx [N/m] at the time of `state`, everything but the deflection held constant.

        Where the contact begins it is that of the side on which the tire is: in the air up to a deflection of 0.
        """
        law = self.law.coefficients(surface_radius)
        if self.bare:
            return power_law.stiffness(deflection, *law)
        path, parameters, _ = self._flat
        motion = (deflection, surface_radius, state[TIME], 0.0, 0.0)
        tangent = flat_step.stiffness(path, law, motion, parameters, state, list(state))
        if self.remainder is not None:
            h, moving = TANGENT_STEP, (surface_radius, state[RATE], state[ACCELERATION])
            above, below = (self.remainder.added(deflection + step, *moving) for step in (h, -h))
            tangent += (above - below) / (2.0 * h)
        return tangent

    def in_tested_range(self, deflection: float, surface_radius: float, force: float) -> bool:
        """Return whether surface, deflection and force lie in the tested range; False where that is not known."""
        return self.tested_range is not None and self.tested_range.contains(deflection, surface_radius, force)
