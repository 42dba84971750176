"""Wheel, frame or machine in series with the tire: they give way too, so the tire is compressed less than was read.

    x_tire + k F(x_tire) = x,    F(x) = A (100 x)^B,    k = 1 / stiffness

F is the elastic law alone: what acts beside it (friction, damping) is a few percent of it, and its share of the wheel's
deflection a few percent of a few percent. Hull, Wang & Moore (1996) had a wheel of 2e6 N/m in their readings (5e-7 m/N;
Hopkins & Principe 1990) and state up to 8.8 % of stiffness lost to it.

Solved by Newton's method on a convex rising function, in x for B >= 1 and in F for B < 1, from above its root: every
step goes down to the root and none passes it.
"""

from __future__ import annotations

from ..effect import Effect, Instant, State
from ..parameter import Parameter

NEAR = 1e-9
"""Relative length of a step whose successor, its square, is below the rounding."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the tire's part [m] of the deflection."""
    k = values[0]
    A, B = instant.coefficient, instant.exponent
    if k == 0.0 or signal <= 0.0:
        return signal, state
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
        return root - step, state
    step = (root + k * force - signal) / (k + root / (B * force))
    while step > NEAR * force:
        force -= step
        root = 0.01 * (force / A) ** (1.0 / B)
        step = (root + k * force - signal) / (k + root / (B * force))
    return 0.01 * ((force - step) / A) ** (1.0 / B), state


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
            1e-4,
            "deflection of wheel and machine for each N; 1/k is their stiffness",
            off=0.0,
            typical=5e-7,
        ),
    ),
    rest=(),
    respond=respond,
    statement="the wheel or the machine gives way in series with the tire",
    tell_tale="the force falls behind at large forces, on every surface as one function of the force",
    imitators=("recalibration", "deflection_offset", "gas_compression", "saturation"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996, quoting Hopkins & Principe 1990: 2e6 N/m",
)
