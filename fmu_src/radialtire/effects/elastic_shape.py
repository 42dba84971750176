"""An elastic law that is not a power of the deflection: ln F is a curved function of ln x.

    F = A x^B exp(c2 l^2 + c3 l^3 + h(x)),   l = ln(x / x_ref)

l is held below x_ref / 100 and above 100 x_ref.

h: straight lines between h_1 to h_10 at x = 0.2, 0.4 ... 2 x_ref, constant beyond them; for laws of any shape.

Where only this is needed no physics is missing: the law was fitted to another tire, or over another range. A contact
patch gives such curvature: for a thin toroid the exponent is 3/2 at small loads and falls as the patch grows
(Renart & Roura-Grabulosa, Am. J. Phys. 87, 102, 2019).
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter
from ..prior import Prior


def hat(place: float, number: float) -> float:
    """Return 1 at the place of that number, 0 from the next ones on."""
    return max(1.0 - abs(place - number), 0.0)


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the force of the law by exp(c2 l^2 + c3 l^3 + h(x))."""
    bend, twist, reference, h1, h2, h3, h4, h5, h6, h7, h8, h9, h10 = values
    x = abs(instant.deflection) if instant.two_sided else instant.deflection
    if x <= 0.0 and not instant.two_sided:
        return signal, state
    exponent = 0.0
    if bend != 0.0 or twist != 0.0:
        log_ratio = math.log(min(max(x / reference, 0.01), 100.0))
        exponent = log_ratio * log_ratio * (bend + twist * log_ratio)
    place = min(max(5.0 * x / reference, 1.0), 10.0)
    exponent += h1 * hat(place, 1.0) + h2 * hat(place, 2.0) + h3 * hat(place, 3.0) + h4 * hat(place, 4.0)
    exponent += h5 * hat(place, 5.0) + h6 * hat(place, 6.0) + h7 * hat(place, 7.0) + h8 * hat(place, 8.0)
    exponent += h9 * hat(place, 9.0) + h10 * hat(place, 10.0)
    return signal * math.exp(exponent), state


def _height(number: int) -> Parameter:
    return Parameter(
        f"height_{number}",
        f"h{number}",
        "1",
        0.0,
        -2.0,
        2.0,
        f"change of ln F at {0.2 * number:g} times the reference deflection",
        neutral=0.0,
        optional=True,
        prior=Prior("normal", 0, 0.1, "1", "Hull, Wang & Moore 1996: errors of the law up to 13.5 %"),
    )


ELASTIC_SHAPE = Effect(
    name="elastic_shape",
    place="law",
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
            1e-8,
            10.0,
            "deflection at which the power law holds",
            optional=True,
            role="reading",
            prior=Prior("log", 0.5, math.log(2), "travel", "the middle of what was measured"),
        ),
        *(_height(number) for number in range(1, 11)),
    ),
    initial_state=(),
    respond=respond,
    statement="the elastic law bends away from a power of the deflection",
    tell_tale="a smooth misfit over the deflection, the same at every rate and time",
    imitators=("gas_compression", "series_compliance", "deflection_offset", "bottoming"),
    source="Renart & Roura-Grabulosa, Am. J. Phys. 87, 102 (2019); Hull, Wang & Moore 1996: errors up to 13.5 %",
    traits=("static", "law"),
    form_error=0.0029,
)
