"""A dashpot beside the spring: force in proportion to the speed of compression.

    F = F_elastic + c dx/dt      while the tire is loaded (x > 0)

Wang & Hull found no dependence on the rate from 3.2 to 63.5 mm/s (quoted in Hull, Wang & Moore 1996), which bounds
c from above for slow presses only: 300 N s/m makes a loop of 0.2 % at 0.05 Hz and of 17.9 % at 5 Hz.
"""

from __future__ import annotations

from ..effect import Effect, Instant, State
from ..parameter import Parameter


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add c dx/dt [N] while the tire is loaded."""
    if instant.deflection <= 0.0:
        return signal, state
    return signal + values[0] * instant.rate, state


VISCOUS_DAMPING = Effect(
    name="viscous_damping",
    place="parallel",
    parameters=(
        Parameter("damping", "c", "N.s/m", 0.0, 0.0, 1e5, "force for each m/s of compression", off=0.0),
    ),
    rest=(),
    respond=respond,
    statement="a force in proportion to the speed of compression",
    tell_tale="the loop's area grows with the frequency",
    imitators=("rate_independent_hysteresis", "viscoelastic_relaxation", "force_lag"),
    source="Hull, Wang & Moore, Cycling Science, Spring 1996, quoting Wang & Hull on rates from 3.2 to 63.5 mm/s",
)
