"""One step of a tire on flat numbers: the function that CPython runs and that the native FMU has as C.

The state before (s) and after (n) the step and the parameters (p) are flat rows of numbers, so that a state can be
copied, stored and restored by any host. Where the numbers of each effect stand says a `SignalPath`, a constant: the
translation to C has every effect of the catalogue and skips those whose switch is 0.

    deflection reading -> deflection of the tire -> elastic law -> factors -> parallel forces -> masses
    -> force reading

The factors act on A x^B, on the curve of a part beside it, and on the preload of a part that air carries, for it is the
force of that air. Without air the preload is a pretension or the zero of a load cell, which nothing softens: it is
added after them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from . import power_law, tracking
from .effect import PLACES, Effect, Instant, Response
from .hull1996 import FLAT_RADIUS
from .tracking import Track

TIME, DEFLECTION, RATE, ACCELERATION, STARTED, START = 0, 1, 2, 3, 4, 5
"""In the state: time [s], deflection [m], rate [m/s], acceleration [m/s^2] of the last sample; 1 once there was
one, 0 before; time [s] of the first one."""

HEAD = 6
"""Index of the first number of an effect in the state."""

TRACKED, FOLLOWED, NOISE, CONTINUOUS, TWO_SIDED, PRELOAD, INFLATED, CURVE = 0, 1, 2, 3, 4, 5, 6, 7
"""In the parameters: 1 where rate and acceleration follow from the readings (0: they are given, or not needed); 1 where
the tire's deflection differs from its reading and has a rate of its own; noise [m] of a reading; 1 where effects that
are differential equations are a solver's: their numbers in n are then rates (see `Flow`); 1 where the part is held at
both ends, and then its force [N] without a deflection; 1 where air carries it; what a curve adds to its law [N]."""

PARAMETERS = 8
"""Index of the first number of an effect in the parameters."""

TRACK = 4 * 14 + 4 + 1
"""Numbers of a track: four modes, their probabilities, the last interval."""

TANGENT_STEP = 1e-7
"""Half the distance [m] over which the tangent is taken."""

AHEAD = 1e-6
"""Half the time [s] over which the rate of the tire's deflection is taken from rate and acceleration of the reading."""


class Stage(NamedTuple):
    """One effect in the path of the signal: its responses, where its switch stands in p, and its numbers in p and s.

    flow: its response as differential equations, where `flows`; else `respond`
    """

    respond: Response
    flow: Response
    flows: int
    switch: int
    values: int
    values_end: int
    state: int
    state_end: int


class SignalPath(NamedTuple):
    """The effects place by place, and where the tracks of reading and tire stand in the state."""

    deflection: tuple[Stage, ...]
    series: tuple[Stage, ...]
    law: tuple[Stage, ...]
    scale: tuple[Stage, ...]
    parallel: tuple[Stage, ...]
    mass: tuple[Stage, ...]
    reading: tuple[Stage, ...]
    track: int
    compression: int


def laid_out(
    effects: Sequence[Effect], tracks: int = 2 * TRACK
) -> tuple[SignalPath, list[float], list[float]]:
    """Return the path of `effects`, parameters with every effect off, and the state before the first sample.

    tracks: numbers that the state keeps for the tracks of rate and acceleration, 0 where no effect needs them
    """
    p = [0.0] * PARAMETERS
    s = [0.0] * HEAD
    stages: dict[str, list[Stage]] = {place: [] for place in PLACES}
    for effect in effects:
        values, state = len(p) + 1, len(s)
        s += effect.initial_state
        p += [0.0, *(parameter.start for parameter in effect.parameters)]
        flow = effect.respond if effect.flow is None else effect.flow.respond
        flows = int(effect.flow is not None)
        stages[effect.place].append(
            Stage(effect.respond, flow, flows, values - 1, values, len(p), state, len(s))
        )
    track = len(s)
    s += [0.0] * tracks
    deflection, series, law, scale, parallel, mass, reading = (tuple(stages[place]) for place in PLACES)
    path = SignalPath(deflection, series, law, scale, parallel, mass, reading, track, track + TRACK)
    return path, p, s


def step(
    path: SignalPath,
    law: tuple[float, float],
    motion: tuple[float, float, float, float, float, float, float],
    p: Sequence[float],
    s: Sequence[float],
    n: list[float],
) -> tuple[float, float]:
    """Return the radial force [N] and the tire's deflection [m], and write the state after the step into `n`.

    law: A [N/cm^B] and B [1]; p: parameters; s: state before; n: where the state after goes, a copy of s
    motion: deflection [m], surface radius [m], time [s]; rate [m/s] and acceleration [m/s^2], used where p tracks none;
    then the channels, in the order of CHANNELS
    """
    A, B = law
    deflection, surface_radius, time, rate, acceleration, pressure, temperature = motion
    bend = 0.0 if abs(surface_radius) >= FLAT_RADIUS else 1.0 / surface_radius
    first = s[STARTED] == 0.0
    start = time if first else s[START]
    interval = 0.0 if first else time - s[TIME]
    if p[TRACKED] != 0.0:
        reading = tracked(s, path.track, deflection, interval, p[NOISE])
        store(n, path.track, reading)
        rate, acceleration = tracking.rate(reading), tracking.acceleration(reading)
    held = p[TWO_SIDED] != 0.0
    where = time - start, interval, first, pressure, temperature, held, A, B, bend
    v = rate
    differenced = p[FOLLOWED] != 0.0 and (p[TRACKED] == 0.0 or p[NOISE] >= tracking.EXACT)
    if differenced:
        # x holds rates: of noisy readings it is too noisy to be differentiated once more, as if it were a reading.
        h = AHEAD
        later = deflection + h * rate, rate + h * acceleration, acceleration
        sooner = deflection - h * rate, rate - h * acceleration, acceleration
        above = compressed(path, later, where, p, s, n)
        v = (above - compressed(path, sooner, where, p, s, n)) / (2.0 * h)
    x = compressed(path, (deflection, rate, acceleration), where, p, s, n)  # its states are those kept
    if p[FOLLOWED] != 0.0 and p[TRACKED] != 0.0:
        if differenced:
            store(n, path.compression, tracking.begin(x))
        else:
            compression = tracked(s, path.compression, x, interval, p[NOISE])
            store(n, path.compression, compression)
            v = tracking.rate(compression)

    bare = power_law.two_sided(x, A, B) if held else power_law.force(x, A, B)
    preload = p[PRELOAD] if held and p[INFLATED] != 0.0 else 0.0
    pretension = p[PRELOAD] if held and p[INFLATED] == 0.0 else 0.0
    at = Instant(
        time - start, interval, first, x, v, acceleration, A, B, 0.0, bend, pressure, temperature, held, 0.0
    )
    bare = preload + p[CURVE] + through(path.law, bare, at, p, s, n)
    elastic = through(path.scale, 1.0, at, p, s, n) * bare
    at = Instant(
        time - start,
        interval,
        first,
        x,
        v,
        acceleration,
        A,
        B,
        elastic,
        bend,
        pressure,
        temperature,
        held,
        preload,
    )
    force = through(path.parallel, pretension + elastic, at, p, s, n)
    if force < 0.0 and not held:
        force = 0.0
    force = through(path.mass, force, at, p, s, n)
    force = through(path.reading, force, at, p, s, n)
    n[TIME], n[DEFLECTION], n[RATE], n[ACCELERATION], n[STARTED], n[START] = (
        time,
        deflection,
        rate,
        acceleration,
        1.0,
        start,
    )
    return force, x


def stiffness(
    path: SignalPath,
    law: tuple[float, float],
    motion: tuple[float, float, float, float, float, float, float],
    p: Sequence[float],
    s: Sequence[float],
    n: list[float],
) -> float:
    """Return the tangent dF/dx [N/m], everything but the deflection held constant; arguments as of `step`.

    Central, or one-sided where the contact begins within TANGENT_STEP: in the air up to a deflection of 0.
    """
    x, R, t, v, a, P, T = motion
    force, here = step(path, law, (x, R, t, v, a, P, T), p, s, n)
    above, higher = step(path, law, (x + TANGENT_STEP, R, t, v, a, P, T), p, s, n)
    below, lower = step(path, law, (x - TANGENT_STEP, R, t, v, a, P, T), p, s, n)
    one_sided = p[TWO_SIDED] == 0.0
    if one_sided and here <= 0.0 and higher > 0.0:
        return (force - below) / TANGENT_STEP
    if one_sided and here > 0.0 and lower <= 0.0:
        return (above - force) / TANGENT_STEP
    return (above - below) / (2.0 * TANGENT_STEP)


def through(
    stages: tuple[Stage, ...],
    signal: float,
    at: Instant,
    p: Sequence[float],
    s: Sequence[float],
    n: list[float],
) -> float:
    """Return the signal after the effects of one place, and write their states after it into `n`."""
    for stage in stages:
        if stage.flows == 1 and p[stage.switch] != 0.0 and p[CONTINUOUS] != 0.0:
            signal, flowed = stage.flow(
                signal, at, tuple(s[stage.state : stage.state_end]), tuple(p[stage.values : stage.values_end])
            )
            n[stage.state : stage.state_end] = flowed
        elif p[stage.switch] != 0.0:
            signal, after = stage.respond(
                signal, at, tuple(s[stage.state : stage.state_end]), tuple(p[stage.values : stage.values_end])
            )
            n[stage.state : stage.state_end] = after
    return signal


def compressed(
    path: SignalPath,
    read: tuple[float, float, float],
    where: tuple[float, float, bool, float, float, bool, float, float, float],
    p: Sequence[float],
    s: Sequence[float],
    n: list[float],
) -> float:
    """Return the tire's deflection [m] for one that is read, and write the states of the effects before the law.

    read: deflection [m], rate [m/s], acceleration [m/s^2]; where: time since the first sample [s], interval [s],
    whether it is the first one, the channels, whether the part is two-sided, and the surface's A, B, curvature [1/m]
    """
    deflection, rate, acceleration = read
    time, interval, first, pressure, temperature, held, A, B, bend = where
    at = Instant(
        time,
        interval,
        first,
        deflection,
        rate,
        acceleration,
        A,
        B,
        0.0,
        bend,
        pressure,
        temperature,
        held,
        0.0,
    )
    x = through(path.deflection, deflection, at, p, s, n)
    at = Instant(
        time, interval, first, x, rate, acceleration, A, B, 0.0, bend, pressure, temperature, held, 0.0
    )
    return through(path.series, x, at, p, s, n)


def tracked(s: Sequence[float], at: int, deflection: float, interval: float, noise: float) -> Track:
    """Return the track after a reading of `deflection` [m], `interval` [s] after the last one; noise [m]."""
    if s[STARTED] == 0.0:
        return tracking.begin(deflection)
    before = (
        (
            tuple(s[at : at + 14]),
            tuple(s[at + 14 : at + 28]),
            tuple(s[at + 28 : at + 42]),
            tuple(s[at + 42 : at + 56]),
        ),
        tuple(s[at + 56 : at + 60]),
        s[at + 60],
    )
    if interval > 0.0:
        return tracking.follow(before, interval, deflection, noise)  # type: ignore[arg-type]
    return before  # type: ignore[return-value]


def store(n: list[float], at: int, track: Track) -> None:
    """Write a track into a state."""
    modes, probability, last = track
    n[at : at + 14] = modes[0]
    n[at + 14 : at + 28] = modes[1]
    n[at + 28 : at + 42] = modes[2]
    n[at + 42 : at + 56] = modes[3]
    n[at + 56 : at + 60] = probability
    n[at + 60] = last
