"""A dashpot in parallel with the spring: force that grows with the speed of compression.

    F = F_elastic + c r v0 (|w| / v0)^n sign(w) |x / x0|^p     while the tire is loaded (x > 0)
    w = asinh(s v) / s,   r = 1 while v > 0, u while v < 0

v = dx/dt, v0 = 0.1 m/s, x0 = 1 cm. n = 1, p = 0, s = 0, u = 1 is the linear dashpot c v; p > 0 makes it grow with the
contact patch, s > 0 makes it grow less beyond the rate 1/s (flow by thermally activated steps: H. Eyring, J. Chem.
Phys. 4, 1936), u > 1 makes it stiffer on the way back, as dampers of vehicles are, two to three times (J. C. Dixon, The
Shock Absorber Handbook, 2nd ed., Wiley 2007).

Wang & Hull found no dependence on the rate from 3.2 to 63.5 mm/s (quoted in Hull, Wang & Moore 1996), which bounds
c from above for slow presses only: 300 N s/m makes a loop of 0.2 % at 0.05 Hz and of 17.9 % at 5 Hz. No published
damping of bicycle tires in this direction was found: the bounds are wide.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter
from ..prior import Prior

SPEED = 0.1
"""v0 [m/s]: speed at which the exponent of the rate has no influence."""

DEPTH = 0.01
"""x0 [m]: deflection at which the exponent of the deflection has no influence."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the dashpot's force [N] while the tire is loaded; a part that is held at both ends always is."""
    damping, rate_exponent, deflection_exponent, thinning, rebound = values
    x, v = instant.deflection, instant.rate
    if x <= 0.0 and not instant.two_sided:
        return signal, state
    if thinning > 0.0:
        v = math.asinh(thinning * v) / thinning
    if rate_exponent != 1.0:
        size = SPEED * (abs(v) / SPEED) ** rate_exponent
        v = size if v > 0.0 else -size
    if deflection_exponent != 0.0:
        v *= (abs(x) / DEPTH) ** deflection_exponent
    if v < 0.0:
        v *= rebound
    return signal + damping * v, state


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
            0.2,
            3.0,
            "growth of the force with the rate",
            optional=True,
            prior=Prior("log", 1.0, math.log(1.5), "1", "thinning to throttle"),
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
            1e4,
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
            0.1,
            10.0,
            "damping on the way back over that on the way in",
            optional=True,
            prior=Prior(
                "log", 1.0, math.log(2), "1", "Dixon 2007: vehicles' dampers have 2 to 3, tires about 1"
            ),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the force grows with the speed of compression",
    tell_tale="the loop's area grows with the frequency",
    imitators=("rate_independent_hysteresis", "viscoelastic_relaxation", "force_lag", "deflection_lag"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996, quoting Wang & Hull on rates from 3.2 to 63.5 mm/s",
    differentiates=True,
    traits=("rate", "loop"),
    form_error=0.019,
)
