"""The loops over a recording's samples, with the same functions that run in the FMU.

`compiled` loads this file once for each effect, replaces `respond` by that effect's response, and has numba compile
the result.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from radialtire.effect import Instant, State
from radialtire.power_law import force as elastic_force
from radialtire.power_law import two_sided as held_force
from radialtire.tracking import acceleration, begin, follow, rate

from tirelab.simulation.instants import instant

FloatArray = NDArray[np.float64]


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Stand for the response of an effect, which `compiled` puts in this place."""
    return signal, state


def respond_loop(
    signal: FloatArray,
    history: tuple[FloatArray, ...],
    state: State,
    values: State,
    answer: FloatArray,
    part: tuple[bool, FloatArray],
) -> None:
    """Fill `answer` with the effect's signal at every sample; `state` is its initial state.

    part: whether it is held at both ends, and its force without a deflection [N] at every sample
    history: time, deflection, rate, acceleration, coefficient, exponent, elastic force, curvature and the channels
    of every sample
    """
    for i in range(signal.size):
        answer[i], state = respond(signal[i], instant(history, i, part), state, values)


def beside_loop(
    beside: tuple[FloatArray, tuple[FloatArray, ...]],
    taken: tuple[FloatArray, tuple[FloatArray, ...]],
    state: State,
    values: State,
    answer: FloatArray,
    part: tuple[bool, FloatArray],
) -> None:
    """Fill `answer` with the effect's signal where each sample alone is another; arguments as of `respond_loop`.

    beside: signal and history of the other samples, of which the state keeps nothing; taken: those of the recording
    """
    for i in range(answer.size):
        answer[i], _ = respond(beside[0][i], instant(beside[1], i, part), state, values)
        _, state = respond(taken[0][i], instant(taken[1], i, part), state, values)


def track_loop(
    time: FloatArray,
    deflection: FloatArray,
    reading_noise: float,
    rates: FloatArray,
    accelerations: FloatArray,
) -> None:
    """Fill `rates` [m/s] and `accelerations` [m/s^2] with those of the deflection [m]."""
    track = begin(deflection[0])
    for i in range(deflection.size):
        if i > 0 and time[i] > time[i - 1]:
            track = follow(track, time[i] - time[i - 1], deflection[i], reading_noise)
        rates[i] = rate(track)
        accelerations[i] = acceleration(track)


def elastic_loop(
    deflection: FloatArray,
    coefficient: FloatArray,
    exponent: FloatArray,
    answer: FloatArray,
    two_sided: bool,
) -> None:
    """Fill `answer` with A x^B [N], of a two-sided part A sign(x) |x|^B."""
    for i in range(deflection.size):
        if two_sided:
            answer[i] = held_force(deflection[i], coefficient[i], exponent[i])
        else:
            answer[i] = elastic_force(deflection[i], coefficient[i], exponent[i])
