"""An amplifier whose zero drifts: a force that adds with the time since the start, evenly or until it has settled.

    F_read = F + d (1 - exp(-k t)) / k,   so d t for k = 0

d [N/s] is the drift at first, k [1/s] the rate at which it settles: that of what warms up, the amplifier or its cell.
It adds to the force, where a leaking or warming tire scales it: samples of the tire in the air distinguish the two.
"""

from __future__ import annotations

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior
from .settling_drift import drift_time


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the drift since the start [N]."""
    drift, settling = values
    return signal + drift * drift_time(instant.time, settling), state


FORCE_DRIFT = Effect(
    name="force_drift",
    place="reading",
    parameters=(
        Parameter(
            "drift",
            "d",
            "N/s",
            0.0,
            -1e9,
            1e9,
            "added for each second at first",
            neutral=0.0,
            nominal=0.05,
            role="strength",
            prior=Prior("normal", 0, 0.05, "force/duration"),
        ),
        Parameter(
            "settling",
            "k",
            "1/s",
            0.0,
            0.0,
            1e6,
            "rate at which the drift settles",
            optional=True,
            prior=Prior("normal", 0, 2.0, "1/duration", "even, or settled within the recording"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the force drifts, alike at every deflection: the zero of the load cell moves, or the part creeps",
    tell_tale="the residual grows with time by the same amount at every deflection, also without contact",
    imitators=("pressure_leak", "warm_up", "deflection_drift", "force_offset"),
    source="warm-up drift of an amplifier, at first a straight line; magnitudes are in its data sheet, bounds wide",
    look_alike=LookAlike(
        "a cable that pulls at the load cell", "move the cable and read the force in the air"
    ),
    traits=("slow", "reading"),
    form_error=0.001,
)
