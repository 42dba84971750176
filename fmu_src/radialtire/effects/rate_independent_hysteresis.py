"""Friction between tread and ground and inside the casing: a loop that does not depend on the speed.

    F = F_elastic + (S + mu F_elastic) r f
    f = (1 - m) z + m (y1 + y2 + y3 + y4) / 4,   r = 1 where f > 0, u where f < 0
    dz/dx   = (sign(dx) - z) / d                                                  Dahl's element
    y_i     <- min(max(y_i + dx / d_i, -1), 1),   d_i = 4/3 d (1 + c (2 i - 5) / 4)   elastic-plastic elements

The loop's height is (1 + u) (S + mu F_elastic); u differs from 1 where the way back slips at another force, as seals
do that are pressed on by what they seal. The breakaway distance d (parameter `reach`) is the deflection over which the
friction changes sign after a reversal. m selects the form: 0 follows exponentials without memory (Dahl), 1 uses
elements that slip one after the other and remember the points of reversal (Maxwell, Iwan); c is the spread of their
breakaway distances. Values between also follow Bouc and Wen's loops: each of these forms is met within 3 % of S on a
ride, while Dahl's element alone is 10 % from Iwan's.

Integrated exactly over travel without reversal. Deflections below 0 count as 0, so in the air nothing slips and no
memory is lost. The initial preload q (parameter `seat`) sets the friction at the first sample: q times that of a tire
that was pressed there from 0 (q = 1: it was).

Noise in the measured deflection counts as travel: unchecked, it makes Dahl's element lose its memory (10 to 15 % of S
at 2 mm/s and all of it in a hold, at 400 Hz with 8e-6 m of noise). So travel after a reversal counts in full only once
it exceeds 2 w, before that by its square over 2 w; w is the dead zone (parameter `play`). Four times the noise keeps
the error at 1 % of S for d = 1 mm, at 3 % in a hold. The elastic-plastic elements need none: noise far below d_i does
not move them.

Hull, Wang & Moore (1996) measured 100 N between loading and unloading, 6.5 % of the peak, growing with the load.

References: P. R. Dahl, "A solid friction model", Aerospace Corporation TOR-0158(3107-18)-1, 1968; W. D. Iwan, "A
distributed-element model for hysteresis and its steady-state dynamic response", J. Appl. Mech. 33 (1966) 893-900.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def dahl(z: float, travel: float, reach: float) -> float:
    """Return z after `travel` [m] in one direction."""
    if travel > 0.0:
        return z - (1.0 - z) * math.expm1(-travel / reach)
    if travel < 0.0:
        return z + (1.0 + z) * math.expm1(travel / reach)
    return z


def slip(y: float, travel: float, reach: float) -> float:
    """Return y after `travel` [m] of an element that slips at `reach` [m]."""
    return min(max(y + travel / reach, -1.0), 1.0)


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the friction force [N].

    The state: z and the deflection at which it was last updated, the direction (1 or -1) of travel there, the last
    deflection, and y1 to y4.
    """
    slip_force, load_share, reach, memory, spread, play, seat, rebound = values
    z, updated_at, direction, last, y1, y2, y3, y4 = state
    x = instant.deflection if instant.two_sided else max(instant.deflection, 0.0)
    if instant.first:
        updated_at = last = 0.0
    travel = x - updated_at
    if instant.first or travel * direction > 0.0 or abs(travel) >= 2.0 * play:
        z = friction = dahl(z, travel, reach) * (seat if instant.first else 1.0)
        updated_at = x
        direction = 1.0 if travel >= 0.0 else -1.0
    else:
        friction = dahl(z, travel * abs(travel) / (2.0 * play), reach)
    if memory != 0.0:
        travel = x - last
        mean = reach * 4.0 / 3.0
        y1 = slip(y1, travel, mean * (1.0 - 0.75 * spread))
        y2 = slip(y2, travel, mean * (1.0 - 0.25 * spread))
        y3 = slip(y3, travel, mean * (1.0 + 0.25 * spread))
        y4 = slip(y4, travel, mean * (1.0 + 0.75 * spread))
        if instant.first:
            y1, y2, y3, y4 = seat * y1, seat * y2, seat * y3, seat * y4
        friction += memory * (0.25 * (y1 + y2 + y3 + y4) - friction)
    after = (z, updated_at, direction, x, y1, y2, y3, y4)
    if instant.deflection <= 0.0 and not instant.two_sided:
        return signal, after
    if friction < 0.0:
        friction *= rebound
    return signal + (slip_force + load_share * abs(instant.elastic_force)) * friction, after


RATE_INDEPENDENT_HYSTERESIS = Effect(
    name="rate_independent_hysteresis",
    place="parallel",
    parameters=(
        Parameter(
            "slip_force",
            "S",
            "N",
            0.0,
            0.0,
            1e9,
            "friction whatever the load: half the loop's height, on the way in",
            neutral=0.0,
            nominal=30.0,
            role="strength",
            prior=Prior(
                "log",
                0.02,
                math.log(6),
                "force",
                "Hull, Wang & Moore 1996: 6.5 % of the peak between the ways",
            ),
        ),
        Parameter(
            "load_share",
            "mu",
            "1",
            0.0,
            0.0,
            1.0,
            "friction for each newton of the elastic force, beside it",
            neutral=0.0,
            nominal=0.02,
            role="strength",
            prior=Prior("log", 0.02, math.log(6), "1", "Hull, Wang & Moore 1996: grows with the load"),
        ),
        Parameter(
            "reach",
            "d",
            "m",
            1e-3,
            1e-12,
            10.0,
            "breakaway distance: deflection over which the friction changes sign",
            prior=Prior(
                "log",
                0.05,
                math.log(8),
                "travel",
                "from 2 to 5 um between metals (B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 "
                "(1994) 1083), 1e-4 of a travel at three standard deviations, to millimetres in a casing",
            ),
        ),
        Parameter(
            "memory",
            "m",
            "1",
            0.0,
            0.0,
            1.0,
            "0: no memory of reversals (Dahl), 1: full memory (Iwan)",
            optional=True,
            prior=Prior("normal", 0.5, 0.5, "1", "0 Dahl, 1 Iwan"),
        ),
        Parameter(
            "spread",
            "c",
            "1",
            0.6,
            0.0,
            1.0,
            "spread of the elements' breakaway distances",
            optional=True,
            prior=Prior("normal", 0.6, 0.3),
        ),
        Parameter(
            "play",
            "w",
            "m",
            0.0,
            0.0,
            0.1,
            "dead zone: half of the travel after a reversal that is noise",
            optional=True,
            role="reading",
            prior=Prior("log", 4.0, math.log(2), "gauge", "four times the noise: see above"),
        ),
        Parameter(
            "seat",
            "q",
            "1",
            1.0,
            -1.0,
            1.0,
            "initial preload: 1 as pressed there from 0, 0 none",
            optional=True,
            prior=Prior("normal", 1.0, 0.7, "1", "1 as pressed there, 0 none, -1 as released"),
        ),
        Parameter(
            "rebound",
            "u",
            "1",
            1.0,
            0.1,
            10.0,
            "friction on the way back over that on the way in",
            optional=True,
            prior=Prior("log", 1.0, math.log(1.5), "1", "1 without pressed-on seals; wide"),
        ),
    ),
    initial_state=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    respond=respond,
    statement="friction: loading and unloading differ by a loop that does not depend on the speed",
    tell_tale="the loop stays as the frequency goes to zero, and keeps its area at every speed",
    imitators=("viscous_damping", "viscoelastic_relaxation", "mullins_softening"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996: 100 N, 6.5 % of the peak; Dahl 1968; Iwan 1966",
    look_alike=LookAlike("friction in the guides of the machine", "press a steel spring in its place"),
    traits=("loop",),
    form_error=0.028,
)
