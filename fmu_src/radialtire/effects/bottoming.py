"""The rim meets the ground through the tire: a second spring from some deflection on.

    F = F_elastic + K u1 (u / u1)^p,   u = s ln(1 + exp((x - xb) / s)),   u1 = 1 mm

K [N/m] is the second spring's stiffness, xb the deflection at which it begins, s the deflection over which it sets in
(u is x - xb well beyond xb), p = 1 for a linear spring, 3/2 for a rounded contact. s = 0 is a sharp knee. No published
curve of a rim strike through a bicycle tire was found: the bounds are wide.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior
from .soft_knee import FAR

UNIT = 1e-3
"""u1 [m]: deflection beyond xb at which the exponent has no influence."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the second spring's force [N]."""
    stiffness, onset, softness, power = values
    beyond = instant.deflection - onset
    in_air = instant.deflection <= 0.0 and not instant.two_sided
    if stiffness == 0.0 or in_air or beyond <= -FAR * softness:
        return signal, state
    if beyond < FAR * softness:
        beyond = softness * math.log1p(math.exp(beyond / softness))
    if power != 1.0:
        beyond = UNIT * (beyond / UNIT) ** power
    return signal + stiffness * beyond, state


BOTTOMING = Effect(
    name="bottoming",
    place="parallel",
    parameters=(
        Parameter(
            "stiffness",
            "K",
            "N/m",
            0.0,
            0.0,
            1e12,
            "of the second spring",
            neutral=0.0,
            nominal=2e5,
            role="strength",
            prior=Prior("log", 1.0, math.log(6), "force/travel"),
        ),
        Parameter(
            "onset",
            "xb",
            "m",
            0.025,
            0.0,
            10.0,
            "deflection at which it begins",
            prior=Prior("normal", 0.8, 0.2, "travel", "where a rim is met is near the end of the travel"),
        ),
        Parameter(
            "softness",
            "s",
            "m",
            2e-4,
            0.0,
            1.0,
            "deflection over which it sets in",
            prior=Prior("log", 0.01, math.log(3), "travel"),
        ),
        Parameter(
            "power",
            "p",
            "1",
            1.0,
            1.0,
            3.0,
            "1: linear, 1.5: rounded contact",
            optional=True,
            prior=Prior("normal", 1.0, 0.4, "1", "1 straight, 3/2 Hertz"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the force rises steeply from one deflection on, as where a tire meets the rim, or a part its stop",
    tell_tale="a local knee in the force at one deflection, on every surface; nothing below it",
    imitators=("gas_compression", "recalibration", "mullins_softening"),
    source="a second spring with a soft onset; no magnitude for bicycle tires was found, bounds wide",
    look_alike=LookAlike(
        "a stop of the machine, or a cable that gets taut",
        "move it as far without the tire or part",
    ),
    traits=("static", "localized"),
    form_error=0.0024,
)
