"""The pressure at which a tire is ridden: the air's share of the force is in proportion to it.

    F = A x^B (1 + g ((p / p0)^n - 1))

p is the gauge pressure, measured or given; p0 the one at which A and B hold. g is the share of the force that the air
carries at p0; the casing carries 1 - g at every pressure, and all of it at p = 0. Without a pressure nothing changes.

With n = 1 this is the factor 1 + pFz1 dp, dp = (p - p0) / p0, of MF-Tyre 6.1, so g is its pFz1. For a thin toroid of
inextensible walls F is in proportion to p: g = 1. Measured on mountain bike tires of four sizes at several pressures
the radial stiffness rises with the pressure. A and B of the article hold at 344.7 kPa (50 psi).

Blind trials hide it in `--kind pressure` alone, so its form error is reckoned: an air's share that grows with another
power of the deflection than the casing's, B + 0.05, leaves sqrt(1 - (2B + 1)(2B + 1.1) / (2B + 1.05)^2) = 1.3 % of the
effect.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, Reading, State, is_measured
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the share of the casing and that of the air at this pressure."""
    gain, reference, power = values
    if not is_measured(instant.pressure):
        return signal, state
    ratio = max(instant.pressure / reference, 0.0)
    if power != 1.0:
        ratio = ratio**power
    return signal * (1.0 + gain * (ratio - 1.0)), state


INFLATION_PRESSURE = Effect(
    name="inflation_pressure",
    place="scale",
    parameters=(
        Parameter(
            "gain",
            "g",
            "1",
            0.0,
            0.0,
            2.0,
            "share of the force that the air carries at the reference",
            neutral=0.0,
            nominal=0.8,
            role="strength",
            prior=Prior(
                "normal", 0.8, 0.25, "1", "thin toroid 1; pFz1 of car tires about 0.7; less the casing"
            ),
        ),
        Parameter(
            "reference",
            "p0",
            "Pa",
            344.7e3,
            1e3,
            1e7,
            "gauge pressure at which the elastic law holds",
            prior=Prior(
                "log", 1.0, math.log(1.6), "pressure", "tires are pressed near where they are ridden"
            ),
        ),
        Parameter(
            "power",
            "n",
            "1",
            1.0,
            0.3,
            2.0,
            "power of the pressure with which the air's share grows",
            optional=True,
            prior=Prior("normal", 1.0, 0.15, "1", "1 in MF-Tyre 6.1 and for a thin toroid"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="it is at another pressure: the force changes with the gauge pressure at every deflection",
    tell_tale="recordings at several pressures differ in proportion to the force, as the pressure channel says",
    imitators=("recalibration", "pressure_leak", "gas_compression", "warm_up"),
    source="MF-Tyre 6.1, pFz1 (Besselink, Schmeitz & Pacejka, Vehicle System Dynamics 48, 2010, S1); Dressel & "
    "Sadauckas, Appl. Sci. 10(9), 3156 (2020), doi 10.3390/app10093156; Renart & Roura-Grabulosa, Am. J. Phys. 87, 102 "
    "(2019); Hull, Wang & Moore 1996: 344.7 kPa",
    look_alike=LookAlike("a pressure gauge with another scale", "read a second gauge beside it"),
    traits=("static", "air"),
    form_error=0.013,
    reads=Reading("pressure", "reference"),
)
