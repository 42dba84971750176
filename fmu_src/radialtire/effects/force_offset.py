"""A wrong zero of the force: the load cell was not tared, or carries a weight.

    F_read = F + F0

Hull, Wang & Moore (1996) could explain the difference from an earlier rig by 22 N of preload there.
"""

from __future__ import annotations

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Shift the force [N] by F0."""
    return signal + values[0], state


FORCE_OFFSET = Effect(
    name="force_offset",
    place="reading",
    parameters=(
        Parameter(
            "offset",
            "F0",
            "N",
            0.0,
            -1e9,
            1e9,
            "added to the force",
            neutral=0.0,
            nominal=20.0,
            role="strength",
            prior=Prior("normal", 0, 0.05, "force", "Hull, Wang & Moore 1996: 22 N of 2240"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the force's zero is shifted",
    tell_tale="the residual is one constant at every deflection and time, also without contact",
    imitators=("deflection_offset", "force_drift", "recalibration"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996: 22 N of preload, or 1 mm, between two rigs",
    look_alike=LookAlike(
        "a spring or a cable beside what is tested",
        "read the force in the air at two heights",
    ),
    traits=("static", "reading"),
    form_error=0.001,
)
