"""A force channel that lags: a pure delay, then a low-pass of first or second order.

    (Q tau)^2 d2F_read/dt2 + tau dF_read/dt + F_read = F(t - delta)

tau is the delay of slow changes, Q the quality of the low-pass: 0 of first order, 1/sqrt(3) Bessel's, 1/sqrt(2)
Butterworth's, as the amplifiers of load cells have. It is integrated exactly for a force that is linear between two
samples. The delay interpolates linearly between the last 16 stored samples, at least delta/14 apart: the gain of that
interpolation is 1 - (w h)^2 / 12 with h the spacing (1 - 2e-3 for 10 Hz and 2.5 ms). Before the first sample the force
is taken as it was there.

Magnitude: 1 to 20 ms for filters and displays of load cells.
"""

from __future__ import annotations

import math

from ..effect import Effect, Flow, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior

KEPT = 16
"""Samples stored for the delay."""

LAST = KEPT - 1
"""Index of the newest of them."""

TIMES, FORCES = 3, 3 + KEPT
"""Where times and forces begin in the state, after the output, its slope, and its last input."""

NO_TIME = 1e-9
"""Q tau [s] below which a low-pass is of first order: nothing of a tire happens in a nanosecond."""

NEARLY_CRITICAL = 1e-5
"""Square of the phase between two samples up to which two terms of the cosine and the sine are exact to 1e-11."""


def low_passed(
    before: tuple[float, float, float], late: float, interval: float, tau: float, quality: float
) -> tuple[float, float]:
    """Return output [N] and slope [N/s] after an interval [s] over which the input changes linearly to `late` [N].

    before: output [N], its slope [N/s] and the input [N] at the start of the interval
    """
    reading, slope, last = before
    rate = (late - last) / interval
    # The output follows a ramp with the delay tau; any other deviation decays.
    off, off_slope = reading - last + tau * rate, slope - rate
    if quality * tau < NO_TIME:
        return late - tau * rate + off * math.exp(-interval / tau), 0.0
    square = (quality * tau) ** 2
    damping = 0.5 * tau / square
    beyond = damping * damping - 1.0 / square
    drive = off_slope + damping * off
    if beyond * interval * interval > NEARLY_CRITICAL:
        width = math.sqrt(beyond)
        quick = damping + width
        slow = 1.0 / (square * quick)
        long = 0.5 * (off + drive / width) * math.exp(-slow * interval)
        short = 0.5 * (off - drive / width) * math.exp(-quick * interval)
        off, off_slope = long + short, -slow * long - quick * short
    else:
        phase_squared = beyond * interval * interval
        cosine, sine = 1.0 + phase_squared / 2.0, interval * (1.0 + phase_squared / 6.0)
        if phase_squared < -NEARLY_CRITICAL:
            width = math.sqrt(-beyond)
            cosine, sine = math.cos(width * interval), math.sin(width * interval) / width
        fall = math.exp(-damping * interval)
        spring = damping * off_slope + off / square
        off, off_slope = fall * (off * cosine + drive * sine), fall * (off_slope * cosine - spring * sine)
    return late - tau * rate + off, rate + off_slope


def delayed(signal: float, instant: Instant, state: State, delta: float) -> tuple[float, State]:
    """Return the force [N] a delay `delta` [s] ago and the stored samples after this one: times, then forces."""
    times, forces = state[TIMES:FORCES], state[FORCES:]
    now = instant.time
    newest, force = (now,), (signal,)
    if instant.first:  # its time is 0, like all times of the initial state
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
    return late, times + forces


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the measured force [N]; the state: output, its slope, its last input, and the stored samples."""
    tau, delta, quality = values
    reading, slope, last = state[0], state[1], state[2]
    late, samples = delayed(signal, instant, state, delta)
    if instant.first:
        reading = last = late
    if tau == 0.0:
        reading = late
    elif instant.interval > 0.0:
        reading, slope = low_passed((reading, slope, last), late, instant.interval, tau, quality)
    held = (reading, slope, late)
    return reading, held + samples


def flow(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Return the measured force [N] for a solver: the states are the output and its slope; the delay is memory."""
    tau, delta, quality = values
    reading, slope = state[0], state[1]
    late, samples = delayed(signal, instant, state, delta)
    if instant.first:
        held = (late, 0.0, late)
        return late, held + samples
    if tau == 0.0:
        held = (0.0, 0.0, late)
        return late, held + samples
    if quality * tau < NO_TIME:
        held = ((late - reading) / tau, 0.0, late)
        return reading, held + samples
    held = (slope, (late - reading - tau * slope) / ((quality * tau) ** 2), late)
    return reading, held + samples


FORCE_LAG = Effect(
    name="force_lag",
    place="reading",
    parameters=(
        Parameter(
            "lag",
            "tau",
            "s",
            0.0,
            0.0,
            1.0,
            "time constant of the channel",
            neutral=0.0,
            nominal=0.005,
            role="strength",
            prior=Prior("log", 0.005, math.log(6), "1", "filters of load cells: 1 to 20 ms"),
        ),
        Parameter(
            "delay",
            "delta",
            "s",
            0.0,
            0.0,
            0.5,
            "pure delay of the channel",
            neutral=0.0,
            nominal=0.005,
            role="strength",
            prior=Prior("normal", 0, 0.02, "1", "as the lag"),
        ),
        Parameter(
            "quality",
            "Q",
            "1",
            0.0,
            0.0,
            1.0,
            "0: first order, above: second order",
            optional=True,
            prior=Prior("normal", 0.3, 0.3, "1", "0 first order, 0.58 Bessel, 0.71 Butterworth"),
        ),
    ),
    initial_state=(0.0,) * (3 + 2 * KEPT),
    respond=respond,
    flow=Flow(flow, (0, 1), ("reading", "slope"), ("N", "N/s")),
    statement="the force signal lags behind the force",
    tell_tale="the loop is reversed: unloading reads higher than loading",
    imitators=("inertia", "viscous_damping", "viscoelastic_relaxation"),
    source="low-pass and transport delay; 5 ms at 0.5 Hz make a loop of -2.2 %; magnitudes are an estimate",
    look_alike=LookAlike("two loggers out of step", "knock on it once: both channels show it at one time"),
    traits=("rate", "loop", "reading"),
    form_error=0.013,
)
