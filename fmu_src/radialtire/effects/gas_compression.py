"""The air of the tire compressed by its own deflection: gauge pressure, and with it the force, rise.

    F = A x^B p / p0,   p / p0 = (1 + b) (1 - w)^-n - b,   w = W (x / 2.5 cm)^q (1 + r_w / R)^(-s)

w is the fraction of the air's volume that is lost, W that at 2.5 cm; b the atmosphere over the gauge pressure, n the
polytropic exponent (1 for slow, 1.4 for fast compression). q = 2.4, the exponent of the work A x^(B+1) / (B+1), since
the volume lost is about the work done over the pressure. W = 1 to 3 % is an estimate from that; it was not measured.
On a surface of radius R the patch of a wheel of radius r_w = 33 cm is shorter by (1 + r_w / R)^(-1/2) (the curvatures
add up, as in Hertz's contact) and displaces less air: s = 1/2 for that alone, s = 0 for the same volume everywhere.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..hull1996 import WHEEL_RADIUS
from ..parameter import Parameter
from ..prior import Prior

REFERENCE = 0.025
"""Deflection [m] at which the lost volume is stated."""

LEAST_CURVATURE = 0.05
"""Least 1 + r_w / R: a hollow of the wheel's own radius would make it 0."""

LOST_MAX = 0.9
"""Largest fraction of the volume lost: the rim meets the ground long before."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by p / p0."""
    share, power, polytropic, surface, atmosphere = values
    if share == 0.0 or instant.deflection <= 0.0:
        return signal, state
    if surface != 0.0:
        share *= max(1.0 + WHEEL_RADIUS * instant.curvature, LEAST_CURVATURE) ** -surface
    lost = min(share * (instant.deflection / REFERENCE) ** power, LOST_MAX)
    return signal * ((1.0 + atmosphere) * (1.0 - lost) ** -polytropic - atmosphere), state


GAS_COMPRESSION = Effect(
    name="gas_compression",
    place="scale",
    parameters=(
        Parameter(
            "lost_volume",
            "W",
            "1",
            0.0,
            0.0,
            0.5,
            "fraction of the air volume lost at 2.5 cm",
            neutral=0.0,
            nominal=0.02,
            role="strength",
            prior=Prior("log", 0.02, math.log(4), "1", "work over pressure: 1 to 3 %"),
        ),
        Parameter(
            "power",
            "q",
            "1",
            2.4,
            1.0,
            4.0,
            "growth of the lost volume with the deflection",
            optional=True,
            prior=Prior("normal", 2.4, 0.4, "1", "exponent of the work, 2.4"),
        ),
        Parameter(
            "polytropic_exponent",
            "n",
            "1",
            1.0,
            1.0,
            1.4,
            "1 slow, 1.4 fast compression",
            optional=True,
            prior=Prior("normal", 1.2, 0.15, "1", "1 slow, 1.4 fast"),
        ),
        Parameter(
            "surface",
            "s",
            "1",
            0.0,
            0.0,
            1.5,
            "0: same volume on all surfaces, 1: as their force",
            optional=True,
            prior=Prior("normal", 0.25, 0.3, "1", "Hertz: 1/2; 0 the same everywhere"),
        ),
        Parameter(
            "atmosphere",
            "b",
            "1",
            0.294,
            0.05,
            5.0,
            "atmospheric over gauge pressure",
            optional=True,
            prior=Prior("log", 0.294, math.log(1.4), "1", "40 to 60 psi"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the air is compressed and the pressure rises with the deflection",
    tell_tale="stiffening at large deflections in one proportion on every surface; a pressure channel shows it",
    imitators=("recalibration", "bottoming", "series_compliance"),
    source="polytropic gas law; 101.3 kPa over 344.7 kPa; 3 to 4 % of pressure at 25 mm is an estimate, bounds wide",
    look_alike=LookAlike("a load cell that reads too much at large forces", "hang known weights on it"),
    traits=("static", "air"),
    form_error=0.029,
    changes=("pressure",),
)
