"""A wrong zero of the deflection: the tire touched the surface before, or after, the gauge indicated zero.

    x = x_read + x0

Hull, Wang & Moore (1996) explain the difference to an earlier rig by 1 mm of it, or by 22 N of preload.
"""

from __future__ import annotations

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Shift the deflection [m] by x0."""
    return signal + values[0], state


DEFLECTION_OFFSET = Effect(
    name="deflection_offset",
    place="deflection",
    parameters=(
        Parameter(
            "offset",
            "x0",
            "m",
            0.0,
            -1.0,
            1.0,
            "added to the measured deflection",
            neutral=0.0,
            nominal=1e-3,
            role="strength",
            prior=Prior("normal", 0, 0.1, "travel", "Hull, Wang & Moore 1996: 1 mm of 25"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the deflection's zero is shifted",
    tell_tale="misfit at small deflections, where the tangent of the force against the deflection is steepest",
    imitators=("recalibration", "series_compliance", "force_offset"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996: 1 mm, or 22 N of preload, between two rigs",
    look_alike=LookAlike(
        "knobs or a foot that give way at the first touch",
        "read the gauge where a sheet of paper is just held",
    ),
    traits=("static", "reading"),
    form_error=0.001,
)
