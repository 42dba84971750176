"""A force channel that reads late: a pure delay, then a first-order lag.

    tau dF_read/dt = F(t - delta) - F_read

The lag is integrated exactly for a force that is straight between two moments. The delay looks the force up in the
last 16 moments that are kept, at least delta/14 apart, with straight lines between them: its gain is that of the
straight line, 1 - (w h)^2 / 12 with h the spacing (1 - 2e-3 for 10 Hz and 2.5 ms). Before the first moment the force
is taken as it was there.

Magnitude: 1 to 20 ms for filters and displays of load cells.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, State
from ..parameter import Parameter

KEPT = 16
"""Moments kept for the delay."""

LAST = KEPT - 1
"""Place of the newest of them."""

FORCES = 2 + KEPT
"""Where their forces begin in the state, after the reading, what it follows, and the times."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the force as read [N]; the state holds the reading, what it follows, and the kept times and forces."""
    tau, delta = values
    reading, last = state[0], state[1]
    times, forces = state[2:FORCES], state[FORCES:]
    now = instant.time
    newest, force = (now,), (signal,)
    if instant.first:  # its time is 0, like all times of the state at rest
        two = force + force
        four = two + two
        forces = four + four + four + four
    elif instant.interval <= 0.0 or times[LAST] - times[LAST - 1] < delta / (LAST - 1):
        times, forces = times[:LAST] + newest, forces[:LAST] + force
    else:
        times, forces = times[1:] + newest, forces[1:] + force
    late = signal
    if delta > 0.0:
        late = forces[0]
        for i in range(LAST, 0, -1):
            if times[i - 1] < now - delta:
                part = (now - delta - times[i - 1]) / (times[i] - times[i - 1])
                late = forces[i - 1] + part * (forces[i] - forces[i - 1])
                break
    if instant.first:
        reading = last = late
    if tau == 0.0:
        reading = late
    elif instant.interval > 0.0:
        passed = instant.interval / tau
        fall = (late - last) / passed
        reading = late - fall + (reading - last + fall) * math.exp(-passed)
    held = (reading, late)
    return reading, held + times + forces


FORCE_LAG = Effect(
    name="force_lag",
    place="reading",
    parameters=(
        Parameter("lag", "tau", "s", 0.0, 0.0, 1.0, "time constant of the channel", off=0.0, typical=0.005),
        Parameter("delay", "delta", "s", 0.0, 0.0, 0.5, "pure delay of the channel", off=0.0, typical=0.005),
    ),
    rest=(0.0,) * (2 + 2 * KEPT),
    respond=respond,
    statement="the force is read late",
    tell_tale="the loop runs the wrong way round: unloading reads higher than loading",
    imitators=("inertia", "viscous_damping", "viscoelastic_relaxation"),
    source="first-order lag and transport delay; 5 ms at 0.5 Hz make a loop of -2.2 %; magnitudes are an estimate",
)
