"""Air that leaks: the force falls with time, by one factor at every deflection.

    F = A x^B (1 - (1 - s) (1 - exp(-l t)))

l [1/s] is the rate of leaking, s the share of the force that the air does not carry (casing), t the time since the
start. A sound tire loses 0.3 psi of 40 to 50 a day (8e-8 /s); what shows within minutes is a puncture.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by what is left of the pressure."""
    rate, structural = values
    return signal * (1.0 + (1.0 - structural) * math.expm1(-rate * instant.time)), state


PRESSURE_LEAK = Effect(
    name="pressure_leak",
    place="scale",
    parameters=(
        Parameter(
            "rate", "l", "1/s", 0.0, 0.0, 1.0, "share of the pressure lost each second", off=0.0, typical=3e-4
        ),
        Parameter(
            "structural", "s", "1", 0.0, 0.0, 0.95, "share of the force not carried by air", extra=True
        ),
    ),
    rest=(),
    respond=respond,
    statement="air leaks: the force falls with time at every deflection",
    tell_tale="the first cycle repeated last is lower, in proportion to the force",
    imitators=("warm_up", "mullins_softening", "force_drift"),
    source="first-order outflow; 0.3 psi a day is from weak web sources, bounds wide",
)
