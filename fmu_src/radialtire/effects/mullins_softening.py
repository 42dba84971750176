"""Rubber softened by the largest deflection so far (Mullins): the first loading is stiffer than all that follow.

    F = A x^B (1 - D g (1 - exp(-u^p))),   u = (m_max - m(x)) / (r m_max + m_w)   for m(x) < m_max
    m(x) = x (A x^B)^e,   m_w = w (A_0 w^B_0)^e,   g = 1 - exp(-s / l)

m measures what the tire has borne, m_max its largest value so far: the deflection itself (e = 0), the stored energy
F x / (1 + B) (e = 1), or what lies between and beyond. On one surface all of them are powers of the deflection; from
one surface to another they differ. D is the share lost far below m_max; r and w how far below it softening sets in, in
proportion and fixed (rubber has no length of its own: w stays 0 unless the recordings ask for it; with A_0 and B_0 of
Hull's tire on flat ground it is the same on every surface); p = 1 sets in at once, p = 2 smoothly. Above m_max the tire
is as new. `history` is the largest deflection before the recording, 0 for a new tire. s is the way travelled below
m_max: with l > 0 the softening gathers over the cycles, with l = 0 it is there at once (g = 1). To and fro within PLAY
is no way: a gauge that reads a tire at rest at 400 Hz with 0.01 mm of noise would walk 45 mm in ten seconds.

Ogden & Roxburgh write the dependence in the energy, with an error function. No Mullins share of bicycle tires was found
in the open: the bounds are wide.

Reference: R. W. Ogden, D. G. Roxburgh, "A pseudo-elastic model for the Mullins effect in filled rubber", Proc. R. Soc.
Lond. A 455 (1999) 2861-2877.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter

PLAY = 1e-4
"""Distance [m] from where the way was last counted that has to be left before it counts on."""

FLAT_A, FLAT_B = 550.9, 1.422
"""A [N/cm^B] and B [1] of Hull's tire on flat ground (equations 3 to 6 there)."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the softening; the state: largest measure, where the way was counted, way [m]."""
    share, ratio, width, sharpness, history, gathering, load = values
    x = instant.deflection
    largest, counted, way = state
    power = 1.0 + load * instant.exponent
    by_surface = instant.coefficient**load
    if instant.first:
        largest, counted = by_surface * (100.0 * history) ** power, max(x, 0.0)
    borne = by_surface * (100.0 * max(x, 0.0)) ** power
    gone = abs(max(x, 0.0) - counted)
    if borne >= largest:
        largest, counted, gone = borne, max(x, 0.0), 0.0
    elif gone > PLAY:
        way, counted, gone = way + gone, max(x, 0.0), 0.0
    if share == 0.0 or x <= 0.0 or borne >= largest:
        return signal, (largest, counted, way)
    fixed = FLAT_A**load * (100.0 * width) ** (1.0 + load * FLAT_B)
    below = (largest - borne) / (ratio * largest + fixed)
    if sharpness != 1.0:
        below = below**sharpness
    if gathering > 0.0:
        share *= -math.expm1(-(way + gone) / gathering)
    return signal * (1.0 + share * math.expm1(-below)), (largest, counted, way)


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
        Parameter("load", "e", "1", 0.0, -0.3, 2.0, "0: measured by deflection, 1: by energy", extra=True),
    ),
    rest=(0.0, 0.0, 0.0),
    respond=respond,
    statement="the tire is softer below the largest deflection it has seen",
    tell_tale="the first loading to a new largest deflection differs from every repeat, whatever the time between",
    imitators=("rate_independent_hysteresis", "pressure_leak", "warm_up", "bottoming"),
    source="Ogden & Roxburgh 1999; no magnitude for bicycle tires was found, bounds wide",
)
