"""A ceiling of the force channel: amplifier or load cell indicate no more than a limit.

    F_read = F - k ln(1 + exp((F - L) / k)),   k = 0: min(F, L)

L is the limit, k the rounding of the knee. The article's load cell was rated at 4480 N.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior
from .soft_knee import FAR

NO_LIMIT = 1e9
"""L [N] of a channel without a ceiling."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the force as read [N]."""
    limit, knee = values
    beyond = signal - limit
    if limit >= NO_LIMIT or beyond <= -FAR * knee:
        return signal, state
    if beyond >= FAR * knee:
        return limit, state
    return signal - knee * math.log1p(math.exp(beyond / knee)), state


SATURATION = Effect(
    name="saturation",
    place="reading",
    parameters=(
        Parameter(
            "limit",
            "L",
            "N",
            NO_LIMIT,
            1e-12,
            NO_LIMIT,
            "largest force read",
            neutral=NO_LIMIT,
            nominal=1e3,
            role="limit",
            prior=Prior(
                "log",
                1.02,
                math.log(1.1),
                "force",
                "no reading passes a ceiling; a round knee stays below it",
            ),
        ),
        Parameter(
            "knee",
            "k",
            "N",
            0.0,
            0.0,
            1e9,
            "rounding of the knee",
            optional=True,
            prior=Prior("normal", 0, 0.02, "force"),
        ),
    ),
    initial_state=(),
    respond=respond,
    statement="the force channel saturates",
    tell_tale="a flat top: the residual is one-sided above one force, on every surface",
    imitators=("series_compliance", "recalibration"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996: load cell rated at 4480 N; limits are set by the rig",
    look_alike=LookAlike(
        "a machine that yields or is limited in force",
        "load the load cell alone beyond that force",
    ),
    traits=("static", "localized", "reading"),
    form_error=0.0015,
)
