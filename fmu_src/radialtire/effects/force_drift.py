"""An amplifier whose zero drifts: a force that adds in proportion to the time since the start.

    F_read = F + d t

It adds to the force, where a leaking or warming tire scales it: samples of the tire in the air distinguish the two.
"""

from __future__ import annotations

from ..effect import Effect, Instant, State
from ..parameter import Parameter
from ..prior import Prior


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add d t [N]."""
    return signal + values[0] * instant.time, state


FORCE_DRIFT = Effect(
    name="force_drift",
    place="reading",
    parameters=(
        Parameter(
            "drift",
            "d",
            "N/s",
            0.0,
            -100.0,
            100.0,
            "added for each second",
            neutral=0.0,
            nominal=0.05,
            role="strength",
            prior=Prior("normal", 0, 0.05, "force/duration"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the force's zero drifts with time",
    tell_tale="the residual grows with time by the same amount at every deflection, also without contact",
    imitators=("pressure_leak", "warm_up", "force_offset"),
    source="straight-line drift of an amplifier; magnitudes are in the gauge's data sheet, bounds wide",
    traits=("slow", "reading"),
    form_error=0.001,
)
