"""An elastic law that is not a power of the deflection: ln F is a curved function of ln x.

    F = A x^B exp(c2 l^2 + c3 l^3),   l = ln(x / x_ref), held below x_ref / 100

Where only this is needed no physics is missing: the law was fitted to another tire, or over another range. A contact
patch gives such curvature: for a thin toroid the exponent is 3/2 at small loads and falls as the patch grows
(Renart & Roura-Grabulosa, Am. J. Phys. 87, 102, 2019).
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by exp(c2 l^2 + c3 l^3)."""
    bend, twist, reference = values
    x = instant.deflection
    if x <= 0.0 or (bend == 0.0 and twist == 0.0):
        return signal, state
    log_ratio = math.log(max(x / reference, 0.01))
    return signal * math.exp(log_ratio * log_ratio * (bend + twist * log_ratio)), state


ELASTIC_SHAPE = Effect(
    name="elastic_shape",
    place="scale",
    parameters=(
        Parameter(
            "bend",
            "c2",
            "1",
            0.0,
            -2.0,
            2.0,
            "curvature of ln F over ln x",
            neutral=0.0,
            nominal=0.02,
            role="strength",
            prior=Prior("normal", 0, 0.1, "1", "Hull, Wang & Moore 1996: errors of the law up to 13.5 %"),
        ),
        Parameter(
            "twist",
            "c3",
            "1",
            0.0,
            -1.0,
            1.0,
            "change of that curvature",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.03),
        ),
        Parameter(
            "reference",
            "xr",
            "m",
            0.0125,
            1e-4,
            0.2,
            "deflection at which the power law holds",
            optional=True,
            role="reading",
            prior=Prior("log", 0.5, math.log(2), "travel", "the middle of what was measured"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the elastic law bends away from a power of the deflection",
    tell_tale="a smooth misfit over the deflection, the same at every rate and time",
    imitators=("gas_compression", "series_compliance", "deflection_offset", "bottoming"),
    source="Renart & Roura-Grabulosa, Am. J. Phys. 87, 102 (2019); Hull, Wang & Moore 1996: errors up to 13.5 %",
    traits=("static", "law"),
    form_error=0.005,
)
