"""Rubber softened by the largest deflection so far (Mullins): the first loading is stiffer than all that follow.

    F = A x^B (1 - D g (1 - exp(-u - c u^2))),   u = (m_max - m(x)) / (r m_max + m_w)   for m(x) < m_max
    m(x) = x (A x^B)^e,   m_w = m(w),   g = 1 - exp(-s / l)

m measures the load history, m_max is its largest value so far: the deflection itself (e = 0), the stored energy F x /
(1 + B) (e = 1), or a measure between and beyond these. On one surface all of them are powers of the deflection; from
one surface to another they differ. D is the fraction lost far below m_max; r and w say how far below it softening sets
in, in proportion and as a fixed part (rubber has no characteristic length: w stays 0 unless the recordings require it).
With c = 0 softening approaches D exponentially. With c = 0.62 it is the error function of Ogden & Roxburgh within 0.002
of D, and for u < 0.2 a straight line within 0.0002 of D. Far above, it is a Gaussian, which sets in smoothly. Above
m_max the tire is as new. `history` is the largest deflection before the recording, 0 for a new tire. s is the path
length travelled below m_max: with l > 0 the softening builds up over the cycles, with l = 0 it is complete at once (g =
1). Motion within DEAD_PART of l adds no path: 0.01 mm of noise on a tire at rest, sampled at 400 Hz, would add 45 mm in
ten seconds. m_w is that of Hull's tire on flat ground, so that it is the same on every surface; a part that is held at
both ends has one law, and m_w is of that: a part far softer or far smaller than a tire softens alike.

Ogden & Roxburgh write the dependence in the energy. No published Mullins fraction of bicycle tires was found: the
bounds are wide.

Reference: R. W. Ogden, D. G. Roxburgh, "A pseudo-elastic model for the Mullins effect in filled rubber", Proc. R. Soc.
Lond. A 455 (1999) 2861-2877.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..hull1996 import FLAT_COEFFICIENT, FLAT_EXPONENT
from ..parameter import Parameter
from ..prior import Prior

ERROR_FUNCTION = 0.62
"""c with which 1 - exp(-u - c u^2) is nearest to erf(u / 1.1), within 0.002."""

DEAD_PART = 1.0 / 200.0
"""Distance from the last counted position, over l, within which motion adds nothing to the path length."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the softening; the state: largest measure, last counted position [m], path length [m]."""
    share, ratio, width, gaussian, history, gathering, load = values
    x = abs(instant.deflection) if instant.two_sided else instant.deflection
    largest, counted, path = state
    power = 1.0 + load * instant.exponent
    by_surface = instant.coefficient**load
    if instant.first:
        largest, counted = by_surface * (100.0 * history) ** power, max(x, 0.0)
    measure = by_surface * (100.0 * max(x, 0.0)) ** power
    uncounted = abs(max(x, 0.0) - counted)
    if measure >= largest:
        largest, counted, uncounted = measure, max(x, 0.0), 0.0
    elif uncounted > DEAD_PART * gathering:
        path, counted, uncounted = path + uncounted, max(x, 0.0), 0.0
    if share == 0.0 or (x <= 0.0 and not instant.two_sided) or measure >= largest:
        return signal, (largest, counted, path)
    fixed = by_surface * (100.0 * width) ** power
    if not instant.two_sided:
        fixed = FLAT_COEFFICIENT**load * (100.0 * width) ** (1.0 + load * FLAT_EXPONENT)
    below = (largest - measure) / (ratio * largest + fixed)
    below += gaussian * below * below
    if gathering > 0.0:
        share *= -math.expm1(-(path + uncounted) / gathering)
    return signal * (1.0 + share * math.expm1(-below)), (largest, counted, path)


MULLINS_SOFTENING = Effect(
    name="mullins_softening",
    place="scale",
    parameters=(
        Parameter(
            "share",
            "D",
            "1",
            0.0,
            0.0,
            0.9,
            "fraction of the stiffness lost",
            neutral=0.0,
            nominal=0.05,
            role="strength",
            prior=Prior("log", 0.05, math.log(4)),
        ),
        Parameter(
            "ratio",
            "r",
            "1",
            0.15,
            5e-3,
            10.0,
            "fraction of the largest measure over which softening sets in",
            prior=Prior("log", 0.2, math.log(3)),
        ),
        Parameter(
            "width",
            "w",
            "m",
            0.0,
            0.0,
            10.0,
            "fixed part of that range",
            optional=True,
            prior=Prior(
                "normal",
                0,
                0.3,
                "travel",
                "Ogden & Roxburgh 1999: their m is of the size of the stored energy",
            ),
        ),
        Parameter(
            "gaussian",
            "c",
            "1",
            ERROR_FUNCTION,
            0.0,
            10.0,
            "0: softens exponentially, 0.62: as an error function, far above: as a Gaussian",
            optional=True,
            prior=Prior(
                "normal", ERROR_FUNCTION, 0.4, "1", "0 exponential, 0.62 error function, 1 and more smoothly"
            ),
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
        Parameter(
            "gathering",
            "l",
            "m",
            0.0,
            0.0,
            100.0,
            "path length over which it builds up",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 3.0, "travel"),
        ),
        Parameter(
            "load",
            "e",
            "1",
            0.0,
            -0.3,
            2.0,
            "0: measured by deflection, 1: by energy",
            optional=True,
            prior=Prior("normal", 0.5, 0.5, "1", "0 deflection, 1 energy"),
        ),
    ),
    initial_state=(0.0, 0.0, 0.0),
    respond=respond,
    statement="it is softer below the largest deflection it has seen",
    tell_tale="the first loading to a new largest deflection differs from every later one, however long the rest",
    imitators=("rate_independent_hysteresis", "pressure_leak", "warm_up", "bottoming"),
    source="Ogden & Roxburgh 1999; no magnitude for bicycle tires was found, bounds wide",
    look_alike=LookAlike(
        "a bead, a clamp or a fixture that seats in the first loading",
        "take it out and put it in again: a seat settles anew",
    ),
    traits=("loop",),
    form_error=0.001,
)
