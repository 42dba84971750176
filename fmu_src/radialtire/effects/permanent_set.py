"""A part that does not come back to its length: a fraction of its largest deflection so far has become permanent.

    x = x_max ((x_read - x_s) / (x_max - x_s))^(q^S),   x_s = S (x_max - x_y)   for x_read < x_max, and 0 below x_s

x_max is the largest deflection so far; of what it is beyond the yield deflection x_y, the fraction S stays. At a new
largest deflection the force is that of the law, as it was identified under a growing load. Below it the part springs
back and is loaded again on one steeper curve, which begins at x_s: there is no loop below the largest deflection, at
any speed. With q = 1 that curve is the law's own, compressed; where all stays, q is the exponent of the unloading over
that of the law. `history` is the largest deflection before the recording, 0 for a new part. Below x_max nothing sets:
what grows from cycle to cycle at one deflection is not in this equation.

In an indentation the depth that stays is a fixed fraction of the largest one wherever loading and unloading are powers
of the depth: near 1 for soft metals, near 0 for rubber.

Reference: W. C. Oliver, G. M. Pharr, "An improved technique for determining hardness and elastic modulus using load
and displacement sensing indentation experiments", J. Mater. Res. 7 (1992) 1564-1583: the unloading is elastic, from the
final depth on, with exponents of 1.25 to 1.51; the same, J. Mater. Res. 19 (2004) 3-20: what stays, from 0 to 1.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the deflection [m] at which the law has the force; the state: largest deflection so far [m]."""
    share, power, onset, history = values
    largest = max(history if instant.first else state[0], signal)
    stays = share * max(largest - onset, 0.0)
    if signal >= largest or stays <= 0.0:
        return signal, (largest,)
    if signal <= stays:
        return signal - stays, (largest,)
    return largest * ((signal - stays) / (largest - stays)) ** (power**share), (largest,)


PERMANENT_SET = Effect(
    name="permanent_set",
    place="deflection",
    parameters=(
        Parameter(
            "share",
            "S",
            "1",
            0.0,
            0.0,
            0.99,
            "fraction of the largest deflection beyond the yield deflection that stays",
            neutral=0.0,
            nominal=0.05,
            role="strength",
            prior=Prior("log", 0.1, math.log(4), "1", "elastic 0, rigid-plastic 1: Oliver & Pharr 2004"),
        ),
        Parameter(
            "power",
            "q",
            "1",
            1.0,
            0.2,
            5.0,
            "exponent of the unloading over that of the law, where all stays",
            optional=True,
            prior=Prior(
                "normal",
                1.0,
                0.3,
                "1",
                "Oliver & Pharr 1992: 1.25 to 1.51 of six materials, under a cone of 2",
            ),
        ),
        Parameter(
            "onset",
            "xy",
            "m",
            0.0,
            0.0,
            10.0,
            "largest deflection that leaves nothing",
            optional=True,
            prior=Prior("normal", 0, 0.3, "travel"),
        ),
        Parameter(
            "history",
            "xh",
            "m",
            0.0,
            0.0,
            10.0,
            "largest deflection before the recording",
            optional=True,
            prior=Prior("normal", 0, 0.3, "travel"),
        ),
    ),
    initial_state=(0.0,),
    respond=respond,
    statement="it does not come back to its length: a part of the largest deflection stays",
    tell_tale="unloading is steeper than loading, and the next loading begins where it ended, without a loop",
    imitators=("mullins_softening", "rate_independent_hysteresis", "viscoelastic_relaxation"),
    source="Oliver & Pharr 1992; no magnitude for bicycle tires was found, bounds wide",
    look_alike=LookAlike(
        "a clamp or a gauge that slips",
        "read the gauge at the first touch, before and after",
    ),
    traits=("loop",),
    form_error=0.003,
)
