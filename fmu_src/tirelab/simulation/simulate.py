"""The force of a tire on a whole recording: the steps of `TireModel`, sample by sample, compiled.

    measured deflection -> deflection of the tire -> elastic law -> factors -> parallel forces -> masses -> force

`simulate` does it all. A search that tries many values calls the stages itself and keeps what lies upstream of the
parameters it varies: `history_of` (the quantities that effects use), `respond_series` (one effect). With `signal` zero
an effect in parallel returns its force alone, linear in slip force, damping, shares, stiffness or mass: the column of a
linear fit.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, CHANNELS, FLAT_RADIUS, Effect, State, TireModel
from radialtire.effect import Response
from radialtire.flat_step import AHEAD
from radialtire.model import Law
from radialtire.part_curve import PartCurve
from radialtire.tracking import EXACT

from . import compiled
from .channels import Sampled, begun, channel_rows, measured_of, writable

FloatArray = NDArray[np.float64]
T = TypeVar("T")

UPSTREAM = ("deflection", "series")
"""Places that change the deflection."""


def upstream_names() -> tuple[str, ...]:
    """Return the names of the effects that change the deflection."""
    return tuple(name for name, effect in CATALOGUE.items() if effect.place in UPSTREAM)


class Kinematics(Protocol):
    """Rate and acceleration of a deflection, sample by sample."""

    @property
    def rate(self) -> FloatArray:
        """[m/s]."""
        ...

    @property
    def acceleration(self) -> FloatArray:
        """[m/s^2]."""
        ...


class Smoothed(Kinematics, Protocol):
    """A motion without the noise in the measured deflection."""

    @property
    def deflection(self) -> FloatArray:
        """[m], compressed > 0."""
        ...


@dataclass(frozen=True)
class SmoothedMotion:
    """The motion of a recording without the noise in the measured deflection; arrays of one length.

    time [s], deflection [m], surface_radius [m]; rate [m/s], acceleration [m/s^2]: smoothed with look-ahead
    measured: the channels that were recorded, by their names
    """

    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    measured: Mapping[str, FloatArray] = field(default_factory=dict)


def smoothed_motion(recording: Sampled, motion: Smoothed) -> SmoothedMotion:
    """Return the smoothed `motion` of a recording at its times and on its surfaces."""
    return SmoothedMotion(
        recording.time,
        motion.deflection,
        recording.surface_radius,
        motion.rate,
        motion.acceleration,
        measured_of(recording),
    )


@dataclass(frozen=True)
class History:
    """The quantities that effects use, at every sample (see `radialtire.effect.Instant`); arrays of one length.

    time: [s] as recorded; deflection [m], rate [m/s], acceleration [m/s^2]
    coefficient, exponent: A [N/cm^B] and B [1]; elastic_force: [N]; curvature: [1/m]; channels: those of CHANNELS
    two_sided: whether the part is held at both ends; preload (n,) [N]: after "scale" the part of the elastic force that
    is there without a deflection, without the factor
    """

    time: FloatArray
    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    coefficient: FloatArray
    exponent: FloatArray
    elastic_force: FloatArray
    curvature: FloatArray
    channels: tuple[FloatArray, ...]
    two_sided: bool
    preload: FloatArray


def simulate(tire: TireModel, recording: Sampled, kinematics: Kinematics | None = None) -> FloatArray:
    """Return the radial force [N] of `tire` at every sample: that of `TireModel.step` from its initial state, to 1e-12.

    A part of a file starts with what was recorded before it (`channels.begun`).
    kinematics: rate and acceleration where they are known better than the tire can track them (see `tracking`)
    """
    recording, before = begun(recording) if kinematics is None else (recording, 0)
    history, force = elastic_stage(tire, recording, kinematics)
    force = force_after_law(tire, history, force, Stages())
    if tire.remainder is not None:
        force = force + learned_force(tire, recording, kinematics)
    return force[before:]


def deflection_of(tire: TireModel, recording: Sampled) -> FloatArray:
    """Return the tire's own deflection [m] at every sample, after the effects that change what was read."""
    recording, before = begun(recording)
    return elastic_stage(tire, recording)[0].deflection[before:]


class Stages:
    """Runs the stages of a simulation, each anew: the effects, and a ground that cannot pull."""

    def once(self, what: Hashable, of: tuple[Any, ...], make: Callable[[], T]) -> T:
        """Return what `make` gives for the values `what` and the objects `of`."""
        return make()

    def respond(self, effect: Effect, values: State, signal: FloatArray, history: History) -> FloatArray:
        """Return the signal after an effect."""
        given = (signal, history)
        return self.once((effect.name, values), given, lambda: respond_series(effect, values, *given))

    def alone(self, effect: Effect, values: State, start: float, history: History) -> FloatArray:
        """Return the signal after an effect where it is `start` before it at every sample."""

        def make() -> FloatArray:
            return respond_series(effect, values, np.full(history.time.size, start), history)

        own = tuple(getattr(history, name) for name in _read_by(effect.respond))
        return self.once((effect.name, values, start), own, make)


@cache
def _read_by(respond: Response) -> tuple[str, ...]:
    """Return the fields of a history that a response reads, by the names in its code: a damper's force is the same
    beside another law.
    """
    held_by = {"interval": "time", "first": "time"} | {channel.name: "channels" for channel in CHANNELS}
    read = {held_by.get(name, name) for name in compiled.names_read(respond)}
    return tuple(f.name for f in fields(History) if f.name in read)


def force_after_law(tire: TireModel, history: History, force: FloatArray, stages: Stages) -> FloatArray:
    """Return the radial force [N] from the elastic one, without a learned remainder."""
    beside = _at(tire, "parallel")
    each = [stages.alone(effect, values, 0.0, history) for effect, values in beside]

    def whole() -> FloatArray:
        together = sum(each, start=force)
        return together if tire.two_sided else np.maximum(together, 0.0)

    told = tuple((effect.name, values) for effect, values in beside)
    pressed = stages.once((told, tire.two_sided), (history, force), whole)
    return downstream(tire, history, pressed, ("mass", "reading"), stages)


def learned_force(tire: TireModel, recording: Sampled, kinematics: Kinematics | None = None) -> FloatArray:
    """Return the force [N] of the tire's learned remainder at every sample; arguments as of `simulate`."""
    learned = tire.remainder
    if learned is None:
        return np.zeros_like(recording.deflection)
    x, R = recording.deflection, recording.surface_radius
    rate, acceleration = np.zeros_like(x), np.zeros_like(x)
    if kinematics is not None:
        rate, acceleration = kinematics.rate, kinematics.acceleration
    elif learned.differentiates:
        rate, acceleration = track(recording.time, x, tire.reading_noise)
    each = zip(x.tolist(), R.tolist(), rate.tolist(), acceleration.tolist(), strict=True)
    return np.array([learned.added(*values) for values in each])


def elastic_stage(
    tire: TireModel,
    recording: Sampled,
    kinematics: Kinematics | None = None,
    stages: Stages = Stages(),  # noqa: B008 - it holds nothing
) -> tuple[History, FloatArray]:
    """Return the quantities for the effects after the elastic law, and the force [N] of the law and the preload."""
    part = (tire.two_sided, tire.inflated, tire.preload, tire.curve)
    law = (tire.law, tire.two_sided, tire.reading_noise, tire.differentiates)
    factors = _at(tire, "scale")
    read = stages.once(law, (), lambda: history_of(tire, recording, kinematics))
    moved = _moved(tire, read, kinematics, stages)
    bare = stages.once((law, part), (moved,), lambda: _bare_force(tire, moved))
    for effect, values in _at(tire, "law"):
        bare = stages.respond(effect, values, bare, moved)
    each = [stages.alone(effect, values, 1.0, moved) for effect, values in factors]
    if tire.curve is not None:
        law_alone, curve = bare, tire.curve
        bare = stages.once(curve, (moved, bare), lambda: law_alone + beyond_zero(curve, moved.deflection))

    def whole() -> tuple[History, FloatArray]:
        # As `flat_step`: without air a preload is a pretension or the zero of a load cell.
        multiplied, added = (tire.pretension, 0.0) if tire.inflated else (0.0, tire.pretension)
        elastic = np.prod(each, axis=0) * (multiplied + bare) if each else multiplied + bare
        after = replace(
            moved, elastic_force=elastic, preload=np.broadcast_to(multiplied, elastic.shape).copy()
        )
        return after, added + elastic

    return stages.once((part, tuple((e.name, v) for e, v in factors)), (moved, bare), whole)


def _at(tire: TireModel, place: str) -> list[tuple[Effect, State]]:
    """Return the effects of a tire at one place."""
    return [(effect, values) for effect, values in tire.effects if effect.place == place]


def _bare_force(tire: TireModel, history: History) -> FloatArray:
    """Return A x^B [N] at the tire's own deflection."""
    A, B = history.coefficient, history.exponent
    return elastic_force(history.deflection, A, B, two_sided=tire.two_sided)


def _moved(tire: TireModel, read: History, kinematics: Kinematics | None, stages: Stages) -> History:
    """Return the quantities at the tire's own deflection and its rate."""
    before = tuple((effect.name, values) for effect, values in tire.effects if effect.place in UPSTREAM)
    if not before:
        return read

    def make() -> History:
        x, rate = upstream(tire, read), read.rate
        if tire.differentiates:
            if kinematics is None and tire.reading_noise < EXACT:
                rate, _ = track(read.time, x, tire.reading_noise)
            else:  # as `flat_step`: what the tire's deflection holds of the rate, the known acceleration continues
                later, sooner = (upstream_beside(tire, extrapolated(read, h), read) for h in (AHEAD, -AHEAD))
                rate = (later - sooner) / (2.0 * AHEAD)
        return replace(read, deflection=x, rate=rate)

    return stages.once(before, (read,), make)


def beyond_zero(curve: PartCurve, deflection: FloatArray) -> FloatArray:
    """Return by how much the force [N] of a curve is more at the part's own `deflection` [m] than without one."""
    return np.interp(deflection, curve.at, curve.force) - curve.over(0.0)


def upstream(tire: TireModel, history: History) -> FloatArray:
    """Return the tire's own deflection [m] of every sample from the deflection that is read."""
    for place in UPSTREAM:
        history = replace(history, deflection=downstream(tire, history, history.deflection, (place,)))
    return history.deflection


def upstream_beside(tire: TireModel, beside: History, history: History) -> FloatArray:
    """Return the tire's own deflection [m] where each sample alone is that of another history, as if it were tried."""
    for place in UPSTREAM:
        tried, taken = beside.deflection, history.deflection
        for effect, values in _at(tire, place):
            tried = respond_beside(effect, values, (tried, beside), (taken, history))
            taken = respond_series(effect, values, taken, history)
        beside, history = replace(beside, deflection=tried), replace(history, deflection=taken)
    return beside.deflection


def extrapolated(history: History, ahead: float) -> History:
    """Return the motion of every sample a time `ahead` [s] later, at the acceleration that it has."""
    v, a = history.rate, history.acceleration
    return replace(history, deflection=history.deflection + ahead * v, rate=v + ahead * a)


def downstream(
    tire: TireModel,
    history: History,
    signal: FloatArray,
    places: tuple[str, ...],
    stages: Stages = Stages(),  # noqa: B008 - it holds nothing
) -> FloatArray:
    """Return `signal` after the effects of `tire` at `places`."""
    for effect, values in tire.effects:
        if effect.place in places:
            signal = stages.respond(effect, values, signal, history)
    return signal


def history_of(tire: TireModel, recording: Sampled, kinematics: Kinematics | None = None) -> History:
    """Return the quantities for the first effects at every sample of a recording."""
    time, deflection, surface_radius = (
        writable(recording.time),
        writable(recording.deflection),
        recording.surface_radius,
    )
    rate = acceleration = np.zeros_like(deflection)
    if kinematics is not None:
        rate, acceleration = writable(kinematics.rate), writable(kinematics.acceleration)
    elif tire.differentiates:
        rate, acceleration = track(time, deflection, tire.reading_noise)
    A, B = coefficients(tire.law, surface_radius)
    flat = np.abs(surface_radius) >= FLAT_RADIUS
    curvature = np.where(flat, 0.0, 1.0 / np.where(flat, 1.0, surface_radius))
    channels = channel_rows(measured_of(recording), time.size)
    return History(
        time,
        deflection,
        rate,
        acceleration,
        A,
        B,
        np.zeros_like(deflection),
        curvature,
        channels,
        tire.two_sided,
        np.zeros_like(deflection),
    )


def respond_series(effect: Effect, values: State, signal: FloatArray, history: History) -> FloatArray:
    """Return the signal after `effect` with the parameters' `values`, from its initial state."""
    answer = np.empty_like(signal)
    loop = compiled.loop("respond_loop", effect.name, effect.respond)
    given = tuple(float(value) for value in values)
    part = history.two_sided, history.preload
    loop(signal, _columns(history), effect.initial_state, given, answer, part)
    return answer


def respond_beside(
    effect: Effect, values: State, beside: tuple[FloatArray, History], taken: tuple[FloatArray, History]
) -> FloatArray:
    """Return the signal after `effect` where each sample alone is that of `beside`; its state follows those `taken`."""
    history = taken[1]
    answer = np.empty_like(taken[0])
    loop = compiled.loop("beside_loop", effect.name, effect.respond)
    given = tuple(float(value) for value in values)
    other, own = ((signal, _columns(of)) for signal, of in (beside, taken))
    loop(other, own, effect.initial_state, given, answer, (history.two_sided, history.preload))
    return answer


def _columns(history: History) -> tuple[FloatArray, ...]:
    """Return the quantities of every sample as the loops take them."""
    return (
        history.time,
        history.deflection,
        history.rate,
        history.acceleration,
        history.coefficient,
        history.exponent,
        history.elastic_force,
        history.curvature,
        *history.channels,
    )


def elastic_force(
    deflection: FloatArray, coefficient: FloatArray, exponent: FloatArray, *, two_sided: bool = False
) -> FloatArray:
    """Return A x^B [N] of every sample: deflection [m], A [N/cm^B], B [1]; of a two-sided part A sign(x) |x|^B."""
    answer = np.empty_like(deflection)
    compiled.loop("elastic_loop", "law")(deflection, coefficient, exponent, answer, two_sided)
    return answer


def coefficients(law: Law, surface_radius: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return A [N/cm^B] and B [1] of every sample; the law is evaluated once for each radius [m] that occurs."""
    starts = np.append(0, np.flatnonzero(surface_radius[1:] != surface_radius[:-1]) + 1)
    pairs = {r: law.coefficients(r) for r in set(surface_radius[starts].tolist())}
    A, B = np.array([pairs[r] for r in surface_radius[starts].tolist()]).T
    lengths = np.diff(starts, append=surface_radius.size)
    return np.repeat(A, lengths), np.repeat(B, lengths)


def track(time: FloatArray, deflection: FloatArray, reading_noise: float) -> tuple[FloatArray, FloatArray]:
    """Return rate [m/s] and acceleration [m/s^2] as the tire tracks them, without look-ahead (see `tracking`)."""
    rate, acceleration = np.empty_like(deflection), np.empty_like(deflection)
    compiled.loop("track_loop", "track")(time, deflection, float(reading_noise), rate, acceleration)
    return rate, acceleration
