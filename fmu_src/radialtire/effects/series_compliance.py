"""Wheel, frame or machine in series with the tire: they deflect too, so the tire is compressed less than measured.

    x_tire + d = x,    d (1 + h d) = k F(x_tire),    F(x) = A (100 x)^B,    k = 1 / stiffness

F is the elastic law alone: friction and damping are a few percent of it, and their part of the wheel's deflection is a
few percent of a few percent. Hull, Wang & Moore (1996) had a wheel of 2e6 N/m in their readings (5e-7 m/N;
Hopkins & Principe 1990) and state up to 8.8 % of stiffness lost to it.

h = 0 is a plain spring; a wheel or fixture that settles under load has h > 0.

With h = 0 solved by Newton's method on a convex rising function, in x for B >= 1 and in F for B < 1, from above its
root: every step goes down to the root and none passes it. With h > 0 in d between 0 and the plain spring's d, by
Newton's method inside a bracket.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior

NEAR = 1e-9
"""Relative length of a step of Newton's method after which the next one, its square, is below rounding."""

HALVINGS_MOST = 60
"""Iterations at most: halving alone would shrink a bracket to rounding in so many."""


def stiffening(x: float, k: float, h: float, A: float, B: float, plain: float) -> float:
    """Return the tire's part of the deflection x [m] over a spring that stiffens; plain: over one that does not.

    d (1 + h d) - k F(x - d) rises with d: it is negative at d = 0 and h d^2 at the plain spring's d.
    """
    low, high = 0.0, x - plain
    d = high if high < x else 0.5 * x  # plain may be less than the rounding of x
    for _ in range(HALVINGS_MOST):
        if x - d <= 0.0:  # less than the rounding of x is left to the tire
            break
        force = A * (100.0 * (x - d)) ** B
        miss = d * (1.0 + h * d) - k * force
        if miss > 0.0:
            high = d
        else:
            low = d
        slope = 1.0 + 2.0 * h * d + k * B * force / (x - d)
        following = d - miss / slope
        near = abs(following - d) <= NEAR * (x - d)
        if following <= low or following >= high:
            following = 0.5 * (low + high)
            near = abs(following - d) <= 1e-15 * x
        d = following
        if near:
            break
    return x - d


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the tire's part [m] of the deflection; that of a two-sided part is odd."""
    if values[0] == 0.0 or (signal <= 0.0 and not (instant.two_sided and signal < 0.0)):
        return signal, state
    if signal < 0.0:
        return -pressed(-signal, instant, values), state
    return pressed(signal, instant, values), state


def pressed(signal: float, instant: Instant, values: State) -> float:
    """Return the tire's part [m] of a deflection above 0."""
    k, h = values
    A, B = instant.coefficient, instant.exponent
    root = signal
    force = A * (100.0 * root) ** B
    if k * force > signal:
        force = signal / k
        root = 0.01 * (force / A) ** (1.0 / B)
    # now root is above the solution, and force is F(root)
    if B >= 1.0:
        step = (root + k * force - signal) / (1.0 + k * B * force / root)
        while step > NEAR * root:
            root -= step
            force = A * (100.0 * root) ** B
            step = (root + k * force - signal) / (1.0 + k * B * force / root)
        root -= step
        return stiffening(signal, k, h, A, B, root) if h > 0.0 else root
    step = (root + k * force - signal) / (k + root / (B * force))
    while step > NEAR * force:
        force -= step
        root = 0.01 * (force / A) ** (1.0 / B)
        step = (root + k * force - signal) / (k + root / (B * force))
    root = 0.01 * ((force - step) / A) ** (1.0 / B)
    return stiffening(signal, k, h, A, B, root) if h > 0.0 else root


SERIES_COMPLIANCE = Effect(
    name="series_compliance",
    place="series",
    parameters=(
        Parameter(
            "compliance",
            "k",
            "m/N",
            0.0,
            0.0,
            1e9,
            "deflection of wheel and machine for each N; 1/k is their stiffness",
            neutral=0.0,
            nominal=5e-7,
            role="strength",
            prior=Prior(
                "log", 0.02, math.log(6), "travel/force", "Hull, Wang & Moore 1996: a wheel of 2e6 N/m"
            ),
        ),
        Parameter(
            "stiffening",
            "h",
            "1/m",
            0.0,
            0.0,
            1e9,
            "stiffening of the spring with its deflection",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 6.0, "1/travel"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="something gives way in series: the wheel, a fixture or the machine",
    tell_tale="large forces are too low, on every surface by the same function of the force",
    imitators=("recalibration", "deflection_offset", "gas_compression", "saturation"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996, quoting Hopkins & Principe 1990: 2e6 N/m",
    look_alike=LookAlike("a load cell that reads too little at large forces", "hang known weights on it"),
    traits=("static",),
    form_error=0.001,
)
