"""A deflection channel that lags: the tire is ahead of its measured deflection.

    x = x_read + (tau + delta) v + delta (tau + delta / 2) a

v, a: rate and acceleration of the measured deflection. The inverse of a first-order lag tau followed by a delay delta,
to the second order in delta: for tau alone it is exact, for a delay it leaves (2 pi f delta)^3 / 6 of the amplitude at
the frequency f (0.5 % for 5 ms at 10 Hz). Without look-ahead it cannot be compensated better.

Magnitude: anti-aliasing filters and displays of displacement gauges have 1 to 10 ms. A lag of the gauge and a lead of
the force are the same; it is attributed to the gauge where tau is positive.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Advance the deflection [m] by the lag of its channel."""
    tau, delta = values
    first_order = (tau + delta) * instant.rate
    second_order = delta * (tau + 0.5 * delta) * instant.acceleration
    return signal + first_order + second_order, state


DEFLECTION_LAG = Effect(
    name="deflection_lag",
    place="deflection",
    parameters=(
        Parameter(
            "lag",
            "tau",
            "s",
            0.0,
            0.0,
            0.05,
            "time constant of the channel",
            neutral=0.0,
            nominal=0.005,
            role="strength",
            prior=Prior("log", 0.005, math.log(6), "1", "filters of displacement gauges: 1 to 10 ms"),
        ),
        Parameter(
            "delay",
            "delta",
            "s",
            0.0,
            0.0,
            0.5,
            "pure delay of the channel",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.02, "1", "as of a load cell"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the deflection signal lags behind the deflection",
    tell_tale="a loop whose height grows with the rate and with the stiffness, so with the mean deflection",
    imitators=("viscous_damping", "viscoelastic_relaxation"),
    source="the inverse of a first-order lag; table of tell-tales: 5 ms at 0.5 Hz make a loop of 2.2 %; bounds wide",
    look_alike=LookAlike("play between actuator and gauge", "reverse slowly: play stays, a lag goes"),
    differentiates=True,
    traits=("rate", "loop", "reading"),
    form_error=0.01,
)
