"""A tire: one elastic law, the effects that act with it, and the range in which it was tested."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Protocol

from . import flat_step, hull1996, power_law
from .effect import CHANNELS, NONE_MEASURED, PLACES, Channel, Effect, State
from .flat_step import (
    ACCELERATION,
    CURVE,
    FOLLOWED,
    INFLATED,
    NOISE,
    PARAMETERS,
    PRELOAD,
    RATE,
    TANGENT_STEP,
    TIME,
    TRACK,
    TRACKED,
    TWO_SIDED,
    SignalPath,
    laid_out,
)
from .hull1996 import Hull1996
from .learned_remainder import LearnedRemainder
from .parameter import Parameter, ParameterError
from .part_curve import PartCurve

DEFLECTION_LOWEST = -1e3
"""Lowest deflection accepted [m]: a wheel this high above the ground is a mistake."""

DEFLECTION_HIGHEST = hull1996.WHEEL_RADIUS
"""Highest deflection of a tire accepted [m]: beyond the wheel's radius the axle would be below the ground. A part has
no wheel: it is accepted as far as the other way.
"""

READING_NOISE = Parameter(
    "reading_noise",
    "s",
    "m",
    0.0,
    0.0,
    0.01,
    "standard deviation of the noise in the measured deflection",
)


PRELOAD_FORCE = Parameter(
    "preload",
    "F0",
    "N",
    0.0,
    -1e9,
    1e9,
    "force of a two-sided part without a deflection, beside its law",
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


def check_inputs(deflection: float, surface_radius: float, highest: float = DEFLECTION_HIGHEST) -> None:
    """Raise InputError unless `deflection` [m] and `surface_radius` [m] are numbers that a wheel can meet.

    highest [m]: deflection of the tire or part (`TireModel.deflection_highest`)
    """
    if not DEFLECTION_LOWEST <= deflection <= highest:
        of_tire = highest == DEFLECTION_HIGHEST
        air, radius = (" (wheel in the air)", " (the wheel's radius)") if of_tire else ("", "")
        raise InputError(
            f"deflection = {deflection:.17g} m is not allowed; it must lie between {DEFLECTION_LOWEST:g} m{air} "
            f"and {highest:g} m{radius}"
        )
    if not (surface_radius > 0.0 or surface_radius < 0.0):
        raise InputError(
            f"surface_radius = {surface_radius:.17g} m is not allowed; it must be positive (convex), negative "
            "(concave), or infinite (flat)"
        )


def check_measured(channel: Channel, value: float) -> None:
    """Raise InputError unless `value` is one that the channel can have."""
    if not channel.minimum <= value <= channel.maximum:
        raise InputError(
            f"{channel.variable} = {value:.17g} {channel.unit} is not allowed; it must lie between "
            f"{channel.minimum:g} and {channel.maximum:g} {channel.unit}"
        )


@dataclass(frozen=True)
class TireModel:
    """An elastic law with effects.

    effects: pairs of an effect and its parameters' values, at most one of each name, ordered by place
    tested_range: where the tire was measured, or None where that is not known
    reading_noise: [m] standard deviation of the noise in the measured deflection, which rate and acceleration must not
    follow (see `tracking`); 0 takes the deflection as exact
    two_sided: whether the part is held at both ends, as a damper or a bushing is: it has a force at deflections below 0
    and can pull. A tire on the ground can do neither.
    inflated: whether air carries its load: without, nothing of a pressure is looked for
    preload: [N] force of a two-sided part without a deflection, to which its law is added: that of a gas spring, which
    effects that multiply the law multiply too, as a pressure does; where it is not inflated a pretension, or the zero
    of a load cell, which nothing multiplies
    curve: a force over the deflection that is added to the law, None for a part that a power law follows
    remainder: a force without physics that is added to all others, None where nobody asked for one
    """

    law: Law = Hull1996()
    effects: tuple[tuple[Effect, State], ...] = ()
    tested_range: TestedRange | None = TestedRange()
    name: str = "Hull, Wang & Moore 1996"
    source: str = "Hull, Wang & Moore, Cycling Science, Spring 1996"
    reading_noise: float = 0.0
    two_sided: bool = False
    preload: float = 0.0
    remainder: LearnedRemainder | None = None
    inflated: bool = True
    curve: PartCurve | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "reading_noise", READING_NOISE.checked(self.reading_noise))
        object.__setattr__(self, "preload", PRELOAD_FORCE.checked(self.preload))
        if self.preload != 0.0 and not self.two_sided:
            raise ParameterError(
                f"preload = {self.preload:g} N needs a two-sided part; a tire without a deflection has no force"
            )
        if self.curve is not None and not self.two_sided:
            raise ParameterError("a curve needs a two-sided part; a tire has a law of its ground")
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
    def pretension(self) -> float:
        """The force [N] of a two-sided part without a deflection: its preload and what its curve has there."""
        return self.preload if self.curve is None else self.preload + self.curve.over(0.0)

    @property
    def is_part(self) -> bool:
        """Whether it is a spring, a damper or a bushing, not a tire: it is held at both ends, or has neither air nor a
        law that knows its ground, as a spring with a gap.
        """
        law = getattr(self.law, "base", self.law)  # a refitted law knows no more of the ground than its base
        return self.two_sided or (not self.inflated and isinstance(law, power_law.PowerLaw))

    @property
    def deflection_highest(self) -> float:
        """Highest deflection accepted [m]: of what is held or has no air as far as the other way, of a tire the wheel's
        radius.
        """
        return -DEFLECTION_LOWEST if self.two_sided or not self.inflated else DEFLECTION_HIGHEST

    @property
    def bare(self) -> bool:
        """Whether it is an elastic law on the ground and nothing else, so that a step needs no state."""
        return not self.effects and not self.two_sided and self.remainder is None

    @cached_property
    def channels(self) -> tuple[tuple[int, Channel, float], ...]:
        """The channels that its effects read: their numbers in CHANNELS, themselves, their values without a reading."""
        found = {}
        unknown = {channel.name: channel.unknown for channel in CHANNELS}
        for effect, values in self.effects:
            if effect.reads is not None:
                names = [parameter.name for parameter in effect.parameters]
                name, reference = effect.reads.channel, effect.reads.reference
                found[name] = unknown[name] if reference is None else values[names.index(reference)]
        return tuple((i, c, found[c.name]) for i, c in enumerate(CHANNELS) if c.name in found)

    @cached_property
    def _flat(self) -> tuple[SignalPath, State, State]:
        """Where the numbers of the effects stand, their parameters, and the state before the first sample."""
        effects = tuple(effect for effect, _ in self.effects)
        follows = self.differentiates and any(e.place in ("deflection", "series") for e in effects)
        path, parameters, initial_state = laid_out(effects, TRACK * (self.differentiates + follows))
        parameters[TRACKED], parameters[FOLLOWED] = float(self.differentiates), float(follows)
        parameters[NOISE] = self.reading_noise
        parameters[TWO_SIDED], parameters[PRELOAD] = float(self.two_sided), self.pretension
        parameters[INFLATED] = float(self.inflated)
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
        self,
        deflection: float,
        surface_radius: float,
        time: float,
        state: State,
        measured: tuple[float, ...] = NONE_MEASURED,
    ) -> tuple[float, State]:
        """Return the radial force [N] at `time` [s] and the state after it.

        measured: the value of each of CHANNELS, NOT_MEASURED where there is none
        Pure: called again with the same state it gives the same answer, so a step may be tried and discarded.
        At the time of the state itself, rate and acceleration are those of the state.
        """
        law = self.law.coefficients(surface_radius)
        if self.bare:
            return power_law.force(deflection, *law), state
        path, parameters, _ = self._flat
        if self.curve is not None:
            x = self.tire_deflection(deflection, surface_radius, time, state, measured)
            parameters = (*parameters[:CURVE], self.curve.beyond_zero(x), *parameters[CURVE + 1 :])
        after = list(state)
        force, _ = flat_step.step(
            path, law, _motion(deflection, surface_radius, time, measured), parameters, state, after
        )
        if self.remainder is not None:
            force += self.remainder.added(deflection, surface_radius, after[RATE], after[ACCELERATION])
        return force, tuple(after)

    def tire_deflection(
        self,
        deflection: float,
        surface_radius: float,
        time: float,
        state: State,
        measured: tuple[float, ...] = NONE_MEASURED,
    ) -> float:
        """Return the tire's own deflection [m] at `time` [s]: the measured one after offset, lag and series springs."""
        if not self.effects:
            return deflection
        path, parameters, _ = self._flat
        law = self.law.coefficients(surface_radius)
        motion = _motion(deflection, surface_radius, time, measured)
        _, x = flat_step.step(path, law, motion, parameters, state, list(state))
        return x

    def stiffness(
        self,
        deflection: float,
        surface_radius: float,
        state: State,
        measured: tuple[float, ...] = NONE_MEASURED,
    ) -> float:
        """Return the tangent dF/dx [N/m] at the time of `state`, everything but the deflection held constant.

        measured: as for `step`.
        Where the contact begins it is that of the side on which the tire is: in the air up to a deflection of 0.
        """
        law = self.law.coefficients(surface_radius)
        if self.bare:
            return power_law.stiffness(deflection, *law)
        if self.curve is not None:
            h, now = TANGENT_STEP, (surface_radius, state[TIME], state, measured)
            above, below = (self.step(deflection + step, *now)[0] for step in (h, -h))
            return (above - below) / (2.0 * h)
        path, parameters, _ = self._flat
        motion = _motion(deflection, surface_radius, state[TIME], measured)
        tangent = flat_step.stiffness(path, law, motion, parameters, state, list(state))
        if self.remainder is not None:
            h, moving = TANGENT_STEP, (surface_radius, state[RATE], state[ACCELERATION])
            above, below = (self.remainder.added(deflection + step, *moving) for step in (h, -h))
            tangent += (above - below) / (2.0 * h)
        return tangent

    def in_tested_range(self, deflection: float, surface_radius: float, force: float) -> bool:
        """Return whether surface, deflection and force lie in the tested range; False where that is not known."""
        return self.tested_range is not None and self.tested_range.contains(deflection, surface_radius, force)


def _motion(
    deflection: float, surface_radius: float, time: float, measured: tuple[float, ...]
) -> tuple[float, float, float, float, float, float, float]:
    """Return the motion as `flat_step` takes it: rate and acceleration are tracked."""
    pressure, temperature = measured
    return deflection, surface_radius, time, 0.0, 0.0, pressure, temperature
