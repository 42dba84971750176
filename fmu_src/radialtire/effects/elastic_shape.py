"""An elastic law that is no power of the deflection: its logarithm bends over that of the deflection.

    F = A x^B exp(c2 l^2 + c3 l^3),   l = ln(x / x_ref), held below x_ref / 100

No physics is missing where only this is needed: the law was fitted to another tire, or over another range. A contact
patch gives such bends: for a thin toroid the exponent is 3/2 at small loads and falls as the patch grows
(Renart & Roura-Grabulosa, Am. J. Phys. 87, 102, 2019).
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by exp(c2 l^2 + c3 l^3)."""
    bend, twist, reference = values
    x = instant.deflection
    if x <= 0.0 or (bend == 0.0 and twist == 0.0):
        return signal, state
    way = math.log(max(x / reference, 0.01))
    return signal * math.exp(way * way * (bend + twist * way)), state


ELASTIC_SHAPE = Effect(
    name="elastic_shape",
    place="scale",
    parameters=(
        Parameter("bend", "c2", "1", 0.0, -2.0, 2.0, "curvature of ln F over ln x", off=0.0, typical=0.02),
        Parameter("twist", "c3", "1", 0.0, -1.0, 1.0, "change of that curvature", off=0.0, extra=True),
        Parameter(
            "reference", "xr", "m", 0.0125, 1e-4, 0.2, "deflection at which the power law holds", extra=True
        ),
    ),
    rest=(),
    respond=respond,
    statement="the elastic law bends away from a power of the deflection",
    tell_tale="a smooth misfit over the deflection, the same at every rate and time",
    imitators=("gas_compression", "series_compliance", "deflection_offset", "bottoming"),
    source="Renart & Roura-Grabulosa, Am. J. Phys. 87, 102 (2019); Hull, Wang & Moore 1996: errors up to 13.5 %",
)
