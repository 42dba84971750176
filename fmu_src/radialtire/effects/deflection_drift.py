"""A zero of the deflection that drifts: the gauge warms, or what holds the part settles, evenly or until it is over.

    x = x_read + u (1 - exp(-k t)) / k,   so x_read + u t for k = 0

u [m/s] is the drift at first, k [1/s] the rate at which it is over. Below zero what carries the part gives way, so that
the part is deflected less than the gauge reads. The force changes in proportion to the stiffness at each deflection,
where a leaking or warming tire scales the force, and a drift of the load cell adds to it.
"""

from __future__ import annotations

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior
from .settling_drift import drift_time


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Shift the deflection [m] by the drift since the start."""
    drift, settling = values
    return signal + drift * drift_time(instant.time, settling), state


DEFLECTION_DRIFT = Effect(
    name="deflection_drift",
    place="deflection",
    parameters=(
        Parameter(
            "drift",
            "u",
            "m/s",
            0.0,
            -1.0,
            1.0,
            "added to the measured deflection for each second at first",
            neutral=0.0,
            nominal=-1e-6,
            role="strength",
            prior=Prior("normal", 0, 0.05, "travel/duration"),
        ),
        Parameter(
            "settling",
            "k",
            "1/s",
            0.0,
            0.0,
            1e6,
            "rate at which the drift is over",
            optional=True,
            prior=Prior("normal", 0, 2.0, "1/duration", "even, or over within the recording"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the zero of the deflection drifts: the gauge warms, or what holds the part settles",
    tell_tale="the first contact moves with time; the residual follows the tangent of the force against the deflection",
    imitators=("pressure_leak", "warm_up", "force_drift", "permanent_set"),
    source="warm-up drift of a displacement gauge, as that of a load cell; magnitudes are in its data sheet",
    look_alike=LookAlike("a specimen that slips in its grips", "mark it where the grips hold it"),
    traits=("slow", "reading"),
    form_error=0.008,
)
