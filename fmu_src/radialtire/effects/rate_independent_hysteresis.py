"""Friction between tread and ground and inside the casing: a loop that does not depend on the speed.

    F = F_elastic + S z,   dz/dx = (sign(dx) - z) / reach      (Dahl's model, order one)

integrated exactly over a step without reversal: z <- s + (z - s) exp(-|dx| / reach), s = sign(dx). The loop's height is
2 S; `reach` is the deflection over which the friction turns round after a reversal. Hull, Wang & Moore (1996) saw
100 N between loading and unloading, 6.5 % of the peak.

Reference: P. R. Dahl, "A solid friction model", Aerospace Corporation TOR-0158(3107-18)-1, 1968.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the friction force S z [N] while the tire is loaded; the state holds z and the last deflection."""
    z, last = state
    x = instant.deflection
    if x <= 0.0:
        return signal, (0.0, 0.0)
    travel = x - last
    if travel > 0.0:
        z = 1.0 + (z - 1.0) * math.exp(-travel / values[1])
    elif travel < 0.0:
        z = -1.0 + (z + 1.0) * math.exp(travel / values[1])
    return signal + values[0] * z, (z, x)


RATE_INDEPENDENT_HYSTERESIS = Effect(
    name="rate_independent_hysteresis",
    place="parallel",
    parameters=(
        Parameter("slip_force", "S", "N", 0.0, 0.0, 1e4, "half the height of the friction loop", off=0.0),
        Parameter("reach", "d", "m", 1e-3, 1e-6, 0.1, "deflection over which the friction turns round"),
    ),
    rest=(0.0, 0.0),
    respond=respond,
    statement="friction: loading and unloading differ by a loop that does not depend on the speed",
    tell_tale="the loop stays as the frequency goes to zero, and keeps its area at every speed",
    imitators=("viscous_damping", "viscoelastic_relaxation", "mullins_softening"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996: 100 N, 6.5 % of the peak; Dahl 1968",
)
