"""A ride: a wheel led over the ground, and the tire's force at every moment of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from radialtire import CHANNELS, TestedRange, TireModel, check_measured
from radialtire.hull1996 import WHEEL_RADIUS
from radialtire.model import Law
from radialtire.power_law import CM_PER_M

from ..errors import TirelabError, check_given, check_tire_given
from ..names import plain
from ..recordings.plausibility import PRESSURES
from ..simulation.simulate import SmoothedMotion, simulate
from .contact import Contact, contact, hub_positions, rolling_path
from .curvature import Ground
from .limits import ARTICLES, LimitReport, limit_report, limits
from .profile import Floats

TireForce: TypeAlias = Callable[[Floats, Floats], Floats]
"""(deflection [m] > 0, surface radius [m]) -> radial force [N]; arrays of one shape, in the order of time."""

FORCE_TOLERANCE = 1e-6
LOAD_TOLERANCE = 1e-9
"""The path under a constant load is found to this share of the load, or where the force jumps to this height [m]."""

MOST_STEPS = 60
"""Regula falsi needs about 6 steps, and 30 where the force jumps."""

DEEPEST_DROP = 0.5
"""Share of the wheel's radius by which the hub may sink under a load before the load counts as too high."""


@dataclass(frozen=True, eq=False)
class Ride:
    """The ride of a wheel; arrays of shape (n,), one value per position of the hub.

    time [s] at the constant speed [m/s]; rolling_height: the hub's height without deflection [m];
    radial_force: compressive, along the line from hub to ground [N]; limits: bits of `Limit`;
    tested: where the tire was measured, None where that is not known.
    """

    ground: Ground
    speed: float
    wheel_radius: float
    time: Floats
    contact: Contact
    rolling_height: Floats
    radial_force: Floats
    limits: NDArray[np.uint16]
    tested: TestedRange | None = ARTICLES

    @property
    def vertical_force(self) -> Floats:
        """Upward component of the force on the wheel [N]."""
        up: Floats = self.radial_force * np.cos(self.contact.inclination)
        return up

    @property
    def horizontal_force(self) -> Floats:
        """Forward component of the force on the wheel [N], negative where the ground holds the wheel back."""
        forward: Floats = self.radial_force * np.sin(self.contact.inclination)
        return forward

    @cached_property
    def report(self) -> LimitReport:
        """How much of the ride lay beyond the tire's limits."""
        length = float(self.contact.position[-1] - self.contact.position[0])
        return limit_report(self.limits, length, self.tested)


@dataclass(frozen=True, eq=False)
class HubPath:
    """The path of the hub: its height [m] (n,) at growing positions [m] (n,), by default those of `hub_positions`."""

    height: Floats
    position: Floats | None = None


def ride(
    ground: Ground,
    tire: TireModel | TireForce,
    *,
    speed: float,
    load: float | None = None,
    hub_path: HubPath | None = None,
    wheel_radius: float = WHEEL_RADIUS,
) -> Ride:
    """Return the ride of a wheel over `ground` at a constant `speed` [m/s] > 0.

    The hub follows `hub_path`, from a multibody tool or a measurement; or, where `load` [N] is given instead, the path
    on which the tire carries that load upwards at every position: a ride so slow that nothing bounces. tire: a tire, of
    which the elastic law acts, one at a pressure (see `force_at`), or a force (see TireForce), which is evaluated only
    where the wheel is on the ground and counts as tested where the article's tire was.

    Raises TirelabError for paths that are not over the ground, and for loads that the tire cannot carry, TypeError for
    what is no ground or no tire.
    """
    check_given(
        ground, Ground, "ground", "a ground", "ground_from(flat(20.0)) or ground_from(read_profile(FILE))"
    )
    if not callable(tire):
        check_tire_given(tire)
    if not (np.isfinite(speed) and speed > 0.0):
        raise TirelabError(f"speed {speed:g} m/s; give a speed above 0 m/s")
    if (load is None) == (hub_path is None):
        raise TirelabError("a ride follows either a load or a path of the hub; give one of the two")
    tire_force = law_force(tire.law) if isinstance(tire, TireModel) else tire
    tested = tire.tested_range if isinstance(tire, TireModel | HeldTire) else ARTICLES
    given = None if hub_path is None else hub_path.position
    place = hub_positions(ground, wheel_radius) if given is None else np.asarray(given, dtype=np.float64)
    if np.any(np.diff(place) <= 0.0):
        i = int(np.flatnonzero(np.diff(place) <= 0.0)[0])
        raise TirelabError(f"the hub goes backwards after s = {place[i]:g} m; give positions that only grow")
    rolling = rolling_path(ground, place, wheel_radius)
    if hub_path is None:
        assert load is not None
        hub_height = constant_load_path(ground, tire_force, load, place, wheel_radius, rolling)
    else:
        hub_height = hub_path.height
    touch = contact(ground, place, hub_height, wheel_radius)
    force = _force(tire_force, touch)
    return Ride(
        ground,
        speed,
        wheel_radius,
        (place - place[0]) / speed,
        touch,
        rolling,
        force,
        limits(touch, force, wheel_radius, tested),
        tested,
    )


def law_force(law: Law) -> TireForce:
    """Return the force of an elastic law for arrays of deflection [m] > 0 and surface radius [m]."""

    def force(deflection: Floats, surface_radius: Floats) -> Floats:
        coefficients = np.array([law.coefficients(radius) for radius in surface_radius.tolist()])
        newtons: Floats = coefficients[:, 0] * (CM_PER_M * deflection) ** coefficients[:, 1]
        return newtons

    return force


@dataclass(frozen=True)
class HeldTire:
    """The force of a tire whose channels are held at values [SI]; a TireForce.

    acting: the tire's elastic law with the effects that read a channel; tested_range: that of the tire
    """

    acting: TireModel
    channels: Mapping[str, float]
    tested_range: TestedRange | None

    def __call__(self, deflection: Floats, surface_radius: Floats) -> Floats:
        """Return the force [N] at deflections [m] on surfaces of these radii [m]."""
        count = deflection.size
        still, order = np.zeros(count), np.arange(count, dtype=np.float64)
        measured = {name: np.full(count, value) for name, value in self.channels.items()}
        motion = SmoothedMotion(order, deflection, surface_radius, still, still, measured)
        return simulate(self.acting, motion)


def force_at(tire: TireModel, channels: Mapping[str, float]) -> HeldTire:
    """Return the force of a tire whose channels, such as the pressure, are held at values [SI].

    Its elastic law acts, with the effects that read one of them and depend on nothing but the deflection beside it.

    Raises TirelabError where no such effect of the tire reads one of the channels, InputError for one that cannot be.
    """
    known = {channel.name: channel for channel in CHANNELS}
    reading = tuple(
        (e, v)
        for e, v in tire.effects
        if e.reads is not None and e.reads.channel in channels and "static" in e.traits
    )
    read = {effect.reads.channel for effect, _ in reading if effect.reads is not None}
    for name, value in channels.items():
        check_measured(known[name], value)
        if name == "pressure" and not tire.is_part and not 0.0 <= value <= PRESSURES[1]:
            raise TirelabError(
                f"a gauge pressure of {plain(value / 1e5, 3)} bar is none that a bicycle tire has "
                f"(0 to {PRESSURES[1] / 1e5:.0f} bar); check its unit"
            )
        if name not in read:
            raise TirelabError(
                f"the tire {tire.name!r} does not say how its force depends on the {name}; tirelab diagnose finds that "
                f"from recordings at several values, or write the effect that reads it into the tire file"
            )
    return HeldTire(TireModel(tire.law, reading, None), dict(channels), tire.tested_range)


def constant_load_path(
    ground: Ground,
    tire_force: TireForce,
    load: float,
    position: Floats,
    wheel_radius: float = WHEEL_RADIUS,
    rolling_height: Floats | None = None,
) -> Floats:
    """Return the hub's height [m] at which the tire carries `load` [N] > 0 upwards, at every `position` [m].

    It lies between the rolling path, where the force is zero, and a drop with more force than the load. Where the
    contact leaps from one place of the ground to another, the force of a tire with one contact jumps, and no height may
    carry the load: there the hub stays at the jump, and the ride is flagged for it.
    """
    if not (np.isfinite(load) and load > 0.0):
        raise TirelabError(f"load {load:g} N; give a load above 0 N")
    rolling = rolling_path(ground, position, wheel_radius) if rolling_height is None else rolling_height

    def excess(drop: Floats, which: NDArray[np.int64]) -> Floats:
        touch = contact(ground, position[which], rolling[which] - drop, wheel_radius)
        upward: Floats = _force(tire_force, touch) * np.cos(touch.inclination) - load
        return upward

    low, below = np.zeros(position.size), np.full(position.size, -float(load))
    high = np.full(position.size, 0.01)
    above = excess(high, np.arange(position.size))
    while (short := np.flatnonzero(above < 0.0)).size:
        low[short], below[short] = high[short], above[short]
        high[short] *= 1.5
        if np.max(high) > DEEPEST_DROP * wheel_radius:
            i = int(short[np.argmax(high[short])])
            raise TirelabError(
                f"the tire cannot carry {load:g} N at s = {position[i]:g} m with less than {plain(low[i], 3)} m of "
                "deflection; give a smaller load"
            )
        above[short] = excess(high[short], short)
    path: Floats = rolling - _roots(excess, (low, below), (high, above), FORCE_TOLERANCE * load)
    return path


def _roots(
    function: Callable[[Floats, NDArray[np.int64]], Floats],
    lower: tuple[Floats, Floats],
    upper: tuple[Floats, Floats],
    tolerance: float,
) -> Floats:
    """Return the root of many functions by regula falsi (Illinois), all at once.

    function: of arguments and the indices of the functions; lower, upper: arguments (n,), which are changed, and values
    (n,) < 0 and >= 0 there; tolerance: of the values, that of the arguments is LOAD_TOLERANCE
    """
    (low, below), (high, above) = lower, upper
    root: Floats = high.copy()
    last_side, open_ = np.zeros(high.size), np.arange(high.size)
    for _ in range(MOST_STEPS):
        root[open_] = (low[open_] * above[open_] - high[open_] * below[open_]) / (above[open_] - below[open_])
        value = function(root[open_], open_)
        side = np.sign(value)
        up, down = open_[value >= 0.0], open_[value < 0.0]
        high[up], above[up] = root[up], value[value >= 0.0]
        low[down], below[down] = root[down], value[value < 0.0]
        stuck = last_side[open_] == side
        below[open_[stuck & (side > 0.0)]] *= 0.5
        above[open_[stuck & (side < 0.0)]] *= 0.5
        last_side[open_] = side
        open_ = open_[(np.abs(value) > tolerance) & (high[open_] - low[open_] > LOAD_TOLERANCE)]
        if not open_.size:
            break
    return root


def _force(tire_force: TireForce, touch: Contact) -> Floats:
    force = np.zeros(touch.deflection.size)
    loaded = touch.deflection > 0.0
    if np.any(loaded):
        force[loaded] = tire_force(touch.deflection[loaded], touch.surface_radius[loaded])
    if not np.all(np.isfinite(force)):
        i = int(np.flatnonzero(~np.isfinite(force))[0])
        raise TirelabError(
            f"the tire's force is not a number at s = {touch.position[i]:g} m (deflection {touch.deflection[i]:g} m, "
            f"radius {touch.surface_radius[i]:g} m); check the tire's parameters"
        )
    return force
