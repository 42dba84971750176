"""Mass that moves between the tire and the load cell: force in proportion to the acceleration.

    F_read = F + m d2x/dt2

x is the measured deflection, as the actuator moves the fixture that the mass belongs to. A fixture of wood and steel
has a few kg. It acts in the air too.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add m d2x/dt2 [N]."""
    return signal + values[0] * instant.acceleration, state


INERTIA = Effect(
    name="inertia",
    place="mass",
    parameters=(
        Parameter(
            "mass",
            "m",
            "kg",
            0.0,
            0.0,
            1e6,
            "moved with the deflection",
            neutral=0.0,
            nominal=2.0,
            role="strength",
            prior=Prior(
                "log", 1e-3, math.log(6), "force", "fixtures of a few kg beside 2 kN, others in proportion"
            ),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="a mass is accelerated in front of the load cell",
    tell_tale="the residual is in proportion to the acceleration, so it grows with the square of the frequency",
    imitators=("force_lag", "deflection_lag", "viscous_damping"),
    source="Newton's second law; masses of fixtures are not published, bounds wide",
    look_alike=LookAlike(
        "a filter of the force of a higher order",
        "move it in the air: a mass shows there, a filter does not",
    ),
    differentiates=True,
    traits=("rate",),
    form_error=0.01,
)
