"""A dashpot in parallel with the spring: force that grows with the speed of compression.

    F = F_elastic + D,    D = c r v0 (|w| / v0)^n sign(w) |x / x0|^p     while the tire is loaded (x > 0)
    w = asinh(s v_d) / s,   r = 1 while w > 0, u while w < 0
    dz/dt = v - v_d,        D = (|z| - l / 2) sign(z) / e  beyond the play, 0 within it (|z| < l / 2)

v = dx/dt, v_d: rate of the dashpot alone, v0 = 0.1 m/s, x0 = 1 cm. n = 1, p = 0, s = 0, u = 1 is the linear dashpot
c v; p > 0 makes it grow with the contact patch, s > 0 makes it grow less beyond the rate 1/s (flow by thermally
activated steps: H. Eyring, J. Chem. Phys. 4, 1936), u > 1 makes it stiffer on the way back, as dampers of vehicles are,
two to three times (J. C. Dixon, The Shock Absorber Handbook, 2nd ed., Wiley 2007).

The force of a damper passes through its oil, its mounts and its pins, which have a compliance e and a play l; z is what
they give way. With e = l = 0 the dashpot has the whole rate. A linear one with e is a Maxwell element with the time
constant c e: at quick reversals its force lags. It is integrated by implicit Euler steps of the rate, so that e = 0 is
their limit; they lag by half a step more.

Wang & Hull found no dependence on the rate from 3.2 to 63.5 mm/s (quoted in Hull, Wang & Moore 1996), which bounds
c from above for slow presses only: 300 N s/m makes a loop of 0.2 % at 0.05 Hz and of 17.9 % at 5 Hz. No published
damping of bicycle tires in this direction was found: the bounds are wide. Dampers of buildings have n from 0.1 to 1
(T. T. Soong, G. F. Dargush, Passive Energy Dissipation Systems in Structural Engineering, Wiley 1997), throttles 2.
"""

from __future__ import annotations

import math

from ..effect import Effect, Flow, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior

SPEED = 0.1
"""v0 [m/s]: speed at which the exponent of the rate has no influence."""

DEPTH = 0.01
"""x0 [m]: deflection at which the exponent of the deflection has no influence."""

NEAR = 1e-5
"""Relative length of a step of Halley's method after which the next one, its cube, is below rounding."""

HALVINGS_MOST = 60
"""Iterations at most: halving alone would shrink a bracket to rounding in so many."""

RELEASED = 1e-3
"""Time constant [s] with which, for a solver, what gives way springs back where nothing holds it."""

STEEPEST = 300.0
"""Largest argument of the hyperbolic sine, for a solver's trial steps: beyond it a rate is no rate any more."""


def force_at(rate: float, size: float, exponent: float, thinning: float) -> float:
    """Return the dashpot's force [N] at a rate [m/s], both above 0; size [N]: at the rate v0."""
    if thinning > 0.0:
        rate = math.asinh(thinning * rate) / thinning
    force: float = size * (rate / SPEED) ** exponent
    return force


def rate_at(force: float, size: float, exponent: float, thinning: float) -> tuple[float, float, float]:
    """Return the dashpot's rate [m/s] at a force [N] above 0, and its derivatives [m/s/N], [m/s/N^2]."""
    rate = SPEED * (force / size) ** (1.0 / exponent)
    slope = rate / (exponent * force)
    bend = slope * (1.0 / exponent - 1.0) / force
    if thinning > 0.0:
        turned = math.sinh(min(thinning * rate, STEEPEST))
        steeper = math.sqrt(1.0 + turned * turned)
        return turned / thinning, slope * steeper, bend * steeper + thinning * slope * slope * turned
    return rate, slope, bend


def carried(
    reach: float, interval: float, start: float, compliance: float, dashpot: tuple[float, float, float]
) -> float:
    """Return the force D [N] with e D + h v_d(D) = reach [m], h the interval [s]: by Halley's method in a bracket.

    start [N]: from where it begins, if it is in the bracket; dashpot: size, exponent and thinning
    """
    size, exponent, thinning = dashpot
    if compliance <= 0.0:
        return force_at(reach / interval, size, exponent, thinning)
    if exponent == 1.0 and thinning == 0.0:
        return reach / (compliance + interval * SPEED / size)
    high = min(force_at(reach / interval, size, exponent, thinning), reach / compliance)
    low, force = 0.0, start if start > 0.0 and start < high else high
    for _ in range(HALVINGS_MOST):
        if force <= 0.0:  # less than the smallest number
            break
        rate, slope, bend = rate_at(force, size, exponent, thinning)
        miss = compliance * force + interval * rate - reach
        if miss > 0.0:
            high = force
        else:
            low = force
        steep = compliance + interval * slope
        turn = steep * steep - 0.5 * miss * interval * bend
        following = force - miss * steep / turn if turn > 0.0 else force - miss / steep
        near = abs(following - force) <= NEAR * force
        if following < low or following > high:
            following = 0.5 * (low + high)
            near = high - low <= 1e-15 * high
        force = following
        if near:
            break
    return force


def size_of(side: float, deflection: float, values: State) -> float:
    """Return the dashpot's force [N] at the rate v0 on the way in (side 1) or back (-1)."""
    damping, _, deflection_exponent, _, rebound, _, _ = values
    size = damping * SPEED
    if deflection_exponent != 0.0:
        size *= (abs(deflection) / DEPTH) ** deflection_exponent
    return size if side > 0.0 else size * rebound


def steady(rate: float, deflection: float, values: State) -> tuple[float, float]:
    """Return the force [N] at a constant rate [m/s], and by how much the mounts give way [m]."""
    if rate == 0.0:
        return 0.0, 0.0
    side = 1.0 if rate > 0.0 else -1.0
    force = force_at(abs(rate), size_of(side, deflection, values), values[1], values[3])
    return side * force, side * (0.5 * values[6] + values[5] * force)


def in_series(instant: Instant, given_way: float, values: State) -> tuple[float, float]:
    """Return the force [N] behind compliance and play after a step, and by how much they give way [m]."""
    x, v = instant.deflection, instant.rate
    compliance, half = values[5], 0.5 * values[6]
    reach = given_way + v * instant.interval
    side = 1.0 if reach > 0.0 else -1.0
    beyond = abs(reach) - half
    if beyond <= 0.0:
        return 0.0, reach
    if instant.interval <= 0.0:
        return (side * beyond / compliance if compliance > 0.0 else 0.0), reach
    size = size_of(side, x, values)
    if size <= 0.0:
        return 0.0, side * half
    before = (side * given_way - half) / compliance if compliance > 0.0 else 0.0
    force = carried(beyond, instant.interval, before, compliance, (size, values[1], values[3]))
    return side * force, side * (half + compliance * force)


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the dashpot's force [N] while the tire is loaded; a part that is held at both ends always is."""
    damping, rate_exponent, deflection_exponent, thinning, rebound, compliance, play = values
    x, v = instant.deflection, instant.rate
    if x <= 0.0 and not instant.two_sided:
        return signal, (0.0,)
    if compliance > 0.0 or play > 0.0:
        if instant.first:
            force, given_way = steady(v, x, values)
        else:
            force, given_way = in_series(instant, state[0], values)
        return signal + force, (given_way,)
    if thinning > 0.0:
        v = math.asinh(thinning * v) / thinning
    if rate_exponent != 1.0:
        size = SPEED * (abs(v) / SPEED) ** rate_exponent
        v = size if v > 0.0 else -size
    if deflection_exponent != 0.0:
        v *= (abs(x) / DEPTH) ** deflection_exponent
    if v < 0.0:
        v *= rebound
    return signal + damping * v, (0.0,)


def flow(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the dashpot's force [N] for a solver: the state is by how much compliance and play give way."""
    compliance, half = values[5], 0.5 * values[6]
    x, v = instant.deflection, instant.rate
    if x <= 0.0 and not instant.two_sided:
        return signal, (0.0 if instant.first else -state[0] / RELEASED,)
    force, given_way = steady(v, x, values)
    if instant.first:
        return signal + force, (given_way,)
    if compliance <= 0.0 and half <= 0.0:
        return signal + force, (0.0,)
    z = state[0]
    side = 1.0 if z > 0.0 else -1.0
    beyond = abs(z) - half
    if compliance <= 0.0:
        # Rigid beyond the play: it is at the end of the play, or on its way there.
        if beyond >= 0.0 and v * side > 0.0:
            return signal + force, (0.0,)
        return signal, (v,)
    if beyond <= 0.0:
        return signal, (v,)
    size = size_of(side, x, values)
    if size <= 0.0:
        return signal, (v - side * beyond / RELEASED,)
    rate, _, _ = rate_at(beyond / compliance, size, values[1], values[3])
    return signal + side * beyond / compliance, (v - side * rate,)


VISCOUS_DAMPING = Effect(
    name="viscous_damping",
    place="parallel",
    parameters=(
        Parameter(
            "damping",
            "c",
            "N.s/m",
            0.0,
            0.0,
            1e12,
            "force for each m/s of compression",
            neutral=0.0,
            nominal=300.0,
            role="strength",
            prior=Prior("log", 0.03, math.log(8), "force/rate"),
        ),
        Parameter(
            "rate_exponent",
            "n",
            "1",
            1.0,
            0.05,
            3.0,
            "growth of the force with the rate",
            optional=True,
            prior=Prior("log", 1.0, math.log(2), "1", "dampers 0.1 to 1 (Soong & Dargush 1997), throttles 2"),
        ),
        Parameter(
            "deflection_exponent",
            "p",
            "1",
            0.0,
            0.0,
            3.0,
            "growth of the force with the deflection",
            optional=True,
            prior=Prior("normal", 0, 0.5),
        ),
        Parameter(
            "thinning",
            "s",
            "s/m",
            0.0,
            0.0,
            1e12,
            "1/s: rate beyond which it grows less",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.5, "1/rate"),
        ),
        Parameter(
            "rebound",
            "u",
            "1",
            1.0,
            1e-3,
            1e3,
            "damping on the way back over that on the way in",
            optional=True,
            prior=Prior(
                "log",
                1.0,
                math.log(4),
                "1",
                "Dixon 2007: vehicles' dampers have 2 to 3, with a check valve none one way",
            ),
        ),
        Parameter(
            "compliance",
            "e",
            "m/N",
            0.0,
            0.0,
            1e3,
            "of what the damper's force passes through: oil, mounts, pins",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.1, "travel/force"),
        ),
        Parameter(
            "play",
            "l",
            "m",
            0.0,
            0.0,
            1.0,
            "way without force at a reversal: play of pins, void in the oil",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.1, "travel"),
        ),
    ),
    initial_state=(0.0,),
    respond=respond,
    flow=Flow(flow, (0,), ("given_way",), ("m",)),
    statement="the force grows with the speed of compression",
    tell_tale="the loop's area grows with the frequency",
    imitators=("rate_independent_hysteresis", "viscoelastic_relaxation", "force_lag", "deflection_lag"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996, quoting Wang & Hull on rates from 3.2 to 63.5 mm/s",
    look_alike=LookAlike(
        "oil or seals of the machine that resist",
        "press a steel spring in its place, as fast",
    ),
    differentiates=True,
    traits=("rate", "loop"),
    form_error=0.019,
)
