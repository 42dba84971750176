"""A tire that warms: the pressure, and with it the force, rises to a new level.

    F = A x^B (1 + g (1 - exp(-(t / tau)^s)))

t is the time since the start; s below 1 stretches the rise over several time constants, as the air, the rubber and the
rim warm one after the other. By the gas law near 40 psi of gauge pressure 10 degF are about 1 psi: g = 0.03 is 10 K.

Where the temperature T is measured, the rise follows it and no course of time is assumed: F = A x^B (1 + g (T - Ts) /
10 K), with Ts the first one that was measured.
"""

from __future__ import annotations

import math

from ..effect import Effect, Instant, LookAlike, Reading, State, is_measured
from ..parameter import Parameter
from ..prior import Prior

WARMING = 10.0
"""Rise of a measured temperature [K] that raises the force by the gain."""


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Multiply the factor by the rise of the pressure; the state is the first measured temperature [K], 0 before it."""
    gain, tau, stretch = values
    if is_measured(instant.temperature):
        start = state[0] if state[0] > 0.0 else instant.temperature
        return signal * max(1.0 + gain * (instant.temperature - start) / WARMING, 0.0), (start,)
    return signal * (1.0 - gain * math.expm1(-((instant.time / tau) ** stretch))), state


WARM_UP = Effect(
    name="warm_up",
    place="scale",
    parameters=(
        Parameter(
            "gain",
            "g",
            "1",
            0.0,
            0.0,
            1.0,
            "final rise of the force, as a fraction of it; that for 10 K where the temperature is measured",
            neutral=0.0,
            nominal=0.05,
            role="strength",
            prior=Prior("log", 0.03, math.log(4), "1", "gas law: 0.03 is 10 K"),
        ),
        Parameter(
            "time_constant",
            "tau",
            "s",
            60.0,
            1e-4,
            1e8,
            "time to 63 % of the rise",
            prior=Prior("log", 0.4, math.log(3), "duration"),
        ),
        Parameter(
            "stretch",
            "s",
            "1",
            1.0,
            0.3,
            1.0,
            "1: one time constant, below 1: spread over several",
            optional=True,
            prior=Prior("normal", 1.0, 0.25),
        ),
    ),
    initial_state=(0.0,),
    respond=respond,
    statement="it warms: the force rises with time to a new level at every deflection",
    tell_tale="a cycle that is repeated at the end is higher, in proportion to the force; the rise levels off",
    imitators=("pressure_leak", "mullins_softening", "force_drift"),
    source="gas law at constant volume: about 1 psi for 10 degF near 40 psi; time constants not found, bounds wide",
    look_alike=LookAlike(
        "an amplifier whose gain rises as it warms",
        "hang a known weight on the load cell, before and after",
    ),
    traits=("slow",),
    form_error=0.011,
    reads=Reading("temperature"),
    changes=("pressure",),
)
