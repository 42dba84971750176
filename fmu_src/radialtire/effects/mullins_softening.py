"""Rubber softened by the largest deflection so far (Mullins): the first loading is stiffer than all that follow.

    F = A x^B (1 - D g (1 - exp(-u^p))),   u = (x_max - x) / (w + r x_max)   for x < x_max
    g = 1 - exp(-s / l)

x_max is the largest deflection so far; D the share lost far below it; w and r how far below it the softening sets in,
fixed and in proportion to x_max; p = 1 sets in at once, p = 2 smoothly. Above x_max the tire is as new. `history` is
the largest deflection before the recording, 0 for a new tire. s is the way travelled below x_max: with l > 0 the
softening gathers over the cycles, with l = 0 it is there at once (g = 1).

Ogden & Roxburgh write the same dependence in the energy, with an error function. No Mullins share of bicycle tires
was found in the open: the bounds are wide.

Reference: R. W. Ogden, D. G. Roxburgh, "A pseudo-elastic model for the Mullins effect in filled rubber", Proc. R. Soc.
Lond. A 455 (1999) 2861-2877.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the softening; the state: largest deflection so far, the last one, way below [m]."""
    share, width, ratio, sharpness, history, gathering = values
    x = instant.deflection
    before, last, way = state
    if instant.first:
        before, last = history, x
    deepest = max(x, before)
    if x < deepest:
        way += abs(max(x, 0.0) - max(last, 0.0))
    if share == 0.0 or x <= 0.0 or x >= deepest:
        return signal, (deepest, x, way)
    below = (deepest - x) / (width + ratio * deepest)
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
        Parameter("width", "w", "m", 3e-3, 1e-4, 0.1, "distance below the largest deflection to soften over"),
        Parameter("ratio", "r", "1", 0.0, 0.0, 10.0, "part of that distance in proportion to it", extra=True),
        Parameter("sharpness", "p", "1", 1.0, 0.5, 4.0, "1: softens at once, 2: smoothly", extra=True),
        Parameter("history", "xh", "m", 0.0, 0.0, 0.1, "largest deflection before the recording", extra=True),
        Parameter("gathering", "l", "m", 0.0, 0.0, 1.0, "way over which it gathers", off=0.0, extra=True),
    ),
    rest=(0.0, 0.0, 0.0),
    respond=respond,
    statement="the tire is softer below the largest deflection it has seen",
    tell_tale="the first loading to a new largest deflection differs from every repeat, whatever the time between",
    imitators=("rate_independent_hysteresis", "pressure_leak", "warm_up", "bottoming"),
    source="Ogden & Roxburgh 1999; no magnitude for bicycle tires was found, bounds wide",
)
