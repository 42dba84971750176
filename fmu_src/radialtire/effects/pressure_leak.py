"""Air that leaks: the force falls with time, by one factor at every deflection.

    F = A x^B (1 - (1 - s) (1 - q)),   dq/dt = -l q^n,   so q = (1 - (1 - n) l t)^(1 / (1 - n)), exp(-l t) for n = 1

q is the pressure over that at the start, l [1/s] the rate of leaking then, n how the flow grows with the pressure: 1
through pores, 1/2 through a hole, 2 where the air expands in a long capillary. s is the fraction of the force that the
air does not carry (casing), t the time since the start. A sound tire loses 0.3 psi of 40 to 50 a day (8e-8 /s); a loss
that is visible within minutes is a puncture.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the remaining pressure."""
    rate, structural, flow = values
    lost = rate * instant.time
    # Through logarithms, so that n = 1 is no special case.
    slowing = (flow - 1.0) * lost
    if slowing <= -1.0:
        return signal * structural, state
    if abs(slowing) > 1e-9:
        lost *= math.log1p(slowing) / slowing
    return signal * (1.0 + (1.0 - structural) * math.expm1(-lost)), state


PRESSURE_LEAK = Effect(
    name="pressure_leak",
    place="scale",
    parameters=(
        Parameter(
            "rate",
            "l",
            "1/s",
            0.0,
            0.0,
            1.0,
            "fraction of the pressure lost each second",
            neutral=0.0,
            nominal=3e-4,
            role="strength",
            prior=Prior(
                "log", 0.05, math.log(6), "1/duration", "what shows within a recording is a puncture"
            ),
        ),
        Parameter(
            "structural",
            "s",
            "1",
            0.0,
            0.0,
            0.95,
            "fraction of the force not carried by air",
            optional=True,
            prior=Prior("normal", 0, 0.3),
        ),
        Parameter(
            "flow",
            "n",
            "1",
            1.0,
            0.4,
            2.5,
            "power of the pressure with which air flows",
            optional=True,
            prior=Prior("normal", 1.0, 0.4, "1", "1/2 hole, 1 pores, 2 capillary"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="air leaks: the force falls with time at every deflection",
    tell_tale="a cycle that is repeated at the end is lower, in proportion to the force",
    imitators=("warm_up", "mullins_softening", "force_drift"),
    source="outflow with a power of the pressure; 0.3 psi a day is from weak web sources, bounds wide",
    look_alike=LookAlike(
        "a zero of the deflection's gauge that creeps",
        "read the gauge at the first touch, before and after",
    ),
    traits=("slow", "air"),
    form_error=0.001,
    changes=("pressure",),
)
