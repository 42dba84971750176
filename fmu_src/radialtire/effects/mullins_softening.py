"""Rubber softened by the largest deflection so far (Mullins): the first loading is stiffer than all that follow.

    F = A x^B (1 - D g (1 - exp(-u^p))),   u = (x_max^c - x^c) / (r x_max^c + w^c)   for x < x_max
    g = 1 - exp(-s / l)

x_max is the largest deflection so far; D the share lost far below it; r and w how far below it softening sets in, in
proportion to x_max and fixed (rubber has no length of its own: w stays 0 unless the recordings ask for it); p = 1 sets
in at once, p = 2 smoothly; c is the power of the deflection in which the distance is measured: 1 the deflection itself,
B the force, 1 + B the stored energy. Above x_max the tire is as new. `history` is the largest deflection before the
recording, 0 for a new tire. s is the way travelled below x_max: with l > 0 the softening gathers over the cycles, with
l = 0 it is there at once (g = 1).

Ogden & Roxburgh write the dependence in the energy, with an error function. No Mullins share of bicycle tires was found
in the open: the bounds are wide.

Reference: R. W. Ogden, D. G. Roxburgh, "A pseudo-elastic model for the Mullins effect in filled rubber", Proc. R. Soc.
Lond. A 455 (1999) 2861-2877.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the softening; the state: largest deflection so far, the last one, way below [m]."""
    share, ratio, width, sharpness, history, gathering, measure = values
    x = instant.deflection
    before, last, way = state
    if instant.first:
        before, last = history, x
    deepest = max(x, before)
    if x < deepest:
        way += abs(max(x, 0.0) - max(last, 0.0))
    if share == 0.0 or x <= 0.0 or x >= deepest:
        return signal, (deepest, x, way)
    below = (1.0 - (x / deepest) ** measure) / (ratio + (width / deepest) ** measure)
    if sharpness != 1.0:
        below = below**sharpness
    if gathering > 0.0:
        share *= -math.expm1(-way / gathering)
    return signal * (1.0 + share * math.expm1(-below)), (deepest, x, way)


MULLINS_SOFTENING = Effect(
    name="mullins_softening",
    place="scale",
    parameters=(
        Parameter("share", "D", "1", 0.0, 0.0, 0.9, "share of the stiffness lost", off=0.0, typical=0.05),
        Parameter("ratio", "r", "1", 0.15, 5e-3, 10.0, "part of the largest deflection to soften over"),
        Parameter("width", "w", "m", 0.0, 0.0, 0.1, "what of that is fixed", extra=True),
        Parameter("sharpness", "p", "1", 1.0, 0.5, 4.0, "1: softens at once, 2: smoothly", extra=True),
        Parameter("history", "xh", "m", 0.0, 0.0, 0.1, "largest deflection before the recording", extra=True),
        Parameter("gathering", "l", "m", 0.0, 0.0, 1.0, "way over which it gathers", off=0.0, extra=True),
        Parameter("measure", "c", "1", 1.0, 0.5, 4.0, "power of the deflection that measures it", extra=True),
    ),
    rest=(0.0, 0.0, 0.0),
    respond=respond,
    statement="the tire is softer below the largest deflection it has seen",
    tell_tale="the first loading to a new largest deflection differs from every repeat, whatever the time between",
    imitators=("rate_independent_hysteresis", "pressure_leak", "warm_up", "bottoming"),
    source="Ogden & Roxburgh 1999; no magnitude for bicycle tires was found, bounds wide",
)
