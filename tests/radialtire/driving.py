"""Drives a tire through a motion, step by step as the FMU does, and measures the loop that it makes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from radialtire import CATALOGUE, CHANNELS, Effect, PowerLaw, TireModel
from radialtire.effect import NOT_MEASURED, PLACES

FloatArray = NDArray[np.float64]

FLAT = math.inf

LINEAR = PowerLaw(coefficient=1000.0, exponent=1.0)
"""A tire that is a straight spring of 1e5 N/m, for which linear theory gives the numbers."""

STIFFNESS = 1e5
"""Of LINEAR [N/m]."""


def tire_with(
    *effects: tuple[str, Sequence[float]], reading_noise: float = 0.0, law: object = None
) -> TireModel:
    """Return a tire with the effects of these names and values, put in the order of the signal's way."""
    pairs = [(CATALOGUE[name], tuple(values)) for name, values in effects]
    pairs.sort(key=lambda pair: (PLACES.index(pair[0].place), list(CATALOGUE).index(pair[0].name)))
    tire = TireModel(effects=tuple(pairs), reading_noise=reading_noise)
    return tire if law is None else TireModel(law, tuple(pairs), reading_noise=reading_noise)  # type: ignore[arg-type]


def values_of(effect: Effect, **changed: float) -> tuple[float, ...]:
    """Return the effect's values where it is off, with those of `changed` in their places."""
    names = [parameter.name for parameter in effect.parameters]
    assert changed.keys() <= set(names)
    return tuple(changed.get(name, value) for name, value in zip(names, effect.neutral, strict=True))


def only(name: str, law: object = None, reading_noise: float = 0.0, **changed: float) -> TireModel:
    """Return a tire with one effect, off but for the values of `changed`."""
    return tire_with((name, values_of(CATALOGUE[name], **changed)), reading_noise=reading_noise, law=law)


def drive(
    tire: TireModel,
    time: ArrayLike,
    deflection: ArrayLike,
    surface_radius: ArrayLike = FLAT,
    **channels: ArrayLike,
) -> FloatArray:
    """Return the force [N] at every moment, from rest; channels: measured, by their names."""
    t, x, R = np.broadcast_arrays(*(np.asarray(a, dtype=float) for a in (time, deflection, surface_radius)))
    values = [np.broadcast_to(channels.get(c.name, NOT_MEASURED), t.shape) for c in CHANNELS]
    measured = np.stack(values, axis=1).tolist()
    state = tire.initial_state
    force = np.empty(t.size)
    for i in range(t.size):
        force[i], state = tire.step(float(x[i]), float(R[i]), float(t[i]), state, tuple(measured[i]))
    return force


def channels_for(effect: Effect, time: ArrayLike) -> Mapping[str, FloatArray]:
    """Return a course of the channel that the effect reads, rising by 1 % a second; nothing where it reads none."""
    if effect.reads is None:
        return {}
    usual = {c.name: c.usual for c in CHANNELS}[effect.reads.channel]
    return {effect.reads.channel: usual * (1.0 + 0.01 * (np.asarray(time) - np.min(time) + 1.0))}


def loop_area(deflection: FloatArray, force: FloatArray) -> float:
    """Return the work [J] done on the tire along a closed path of deflection."""
    middle = 0.5 * (force[1:] + force[:-1])
    return float(np.sum(middle * np.diff(deflection)))


def sine(
    frequency: float, amplitude: float, mean: float, cycles: float, samples: int
) -> tuple[FloatArray, FloatArray]:
    """Return time [s] and deflection [m] of a sine with `samples` intervals in each cycle."""
    time = np.linspace(0.0, cycles / frequency, round(cycles * samples) + 1)
    return time, mean + amplitude * np.sin(2.0 * math.pi * frequency * time)


def harmonic(time: FloatArray, signal: FloatArray, frequency: float) -> complex:
    """Return the complex amplitude of `signal` at `frequency` [Hz] over its last cycle, relative to a sine."""
    last = time > time[-1] - 1.0 / frequency + 1e-9
    wave = np.exp(-2j * math.pi * frequency * time[last])
    return complex(2j * np.mean((signal[last] - np.mean(signal[last])) * wave))


def converges(force_at: Callable[[int], FloatArray], order: float, count: int) -> bool:
    """Return whether halving the interval three times makes the error fall with `order`, or below 1e-5 of the peak.

    force_at: gives the forces on a grid of so many intervals; compared on the coarsest one's second half with a grid
    8 times finer than the finest.
    """
    exact = force_at(64 * count)[::64]

    def error(times: int) -> float:
        off = np.abs(force_at(times * count)[::times] - exact)
        return float(np.max(off[count // 2 :]))

    coarse, fine = error(1), error(8)
    return fine < 1e-5 * float(np.max(np.abs(exact))) or math.log2(coarse / fine) / 3.0 > order
