"""The motions that a rig can drive: deflections [m] over time, none deeper or faster than its limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from numbers import Real

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Limits:
    """What the rig can do: longest stroke [m], fastest motion [m/s], sampling step [s], longest test [s].

    start [m]: deflection from which a motion goes, 0: of a tire that just touches
    surfaces [m]: radii that can be mounted; none: those that were recorded
    pressures [Pa]: gauge pressures that can be held; none: not known
    force [N]: largest that the press and its load cell take
    """

    deepest: float = 0.025
    fastest: float = 0.25
    step: float = 0.005
    longest: float = 60.0
    surfaces: tuple[float, ...] = ()
    pressures: tuple[float, ...] = ()
    start: float = 0.0
    force: float = math.inf

    def __post_init__(self) -> None:
        for name, unit in (("deepest", "m"), ("fastest", "m/s"), ("step", "s"), ("longest", "s")):
            value = getattr(self, name)
            if not (isinstance(value, Real) and 0.0 < float(value) < math.inf):
                raise ValueError(f"{name}={value!r} is no limit of a rig; give a number [{unit}] above 0")
        if not (isinstance(self.force, Real) and float(self.force) > 0.0):
            raise ValueError(f"force={self.force!r} is no limit of a rig; give a number [N] above 0")
        if not (isinstance(self.start, Real) and math.isfinite(self.start)):
            raise ValueError(f"start={self.start!r} is no deflection; give a number [m]")


def another_pressure(limits: Limits | None, recorded: bool) -> str:
    """Return the advice to record at another pressure, with those that the rig can hold where they are known.

    recorded: whether several pressures were recorded already
    """
    if recorded:
        return "repeat at a pressure further from those recorded"
    held = () if limits is None or len(limits.pressures) < 2 else limits.pressures
    figures = [f"{1e-5 * pressure:.3g}" for pressure in held]
    named = f" ({', '.join(figures[:-1])} or {figures[-1]} bar)" if figures else ""
    return f"repeat at a second pressure{named}"


Waveform = Callable[[Limits], FloatArray]

STROKE = 20
"""Samples that a stroke takes at least, whatever the rig could do: with fewer its rate is not read."""

CORNER = 8
"""Samples over which a corner is rounded: an actuator rounds it, and a mass shows in an acceleration that is read."""


def readable_rate(limits: Limits) -> float:
    """Return the fastest rate [m/s] of a motion: the rig's, or what its sampling can read."""
    return min(limits.fastest, limits.deepest / (STROKE * limits.step))


def motion(waveform: Waveform, limits: Limits) -> FloatArray:
    """Return the deflections [m] of a waveform, which goes from 0 to the longest stroke, from the rig's start."""
    return limits.start + waveform(limits)


def rounded(make: Waveform) -> Waveform:
    """Return a motion with round corners, as deep as the limits all the same: what begins at the end of the stroke, a
    stop or a saturated gauge, shows nowhere else. It is no faster than before.
    """

    def made(limits: Limits) -> FloatArray:
        path = _without_corners(make(limits))
        lost = limits.deepest - float(path.max())
        deeper = replace(limits, deepest=limits.deepest + lost, fastest=readable_rate(limits))
        return np.minimum(_without_corners(make(deeper)), limits.deepest)

    return made


def _without_corners(path: FloatArray) -> FloatArray:
    weights = np.hanning(CORNER + 3)[1:-1]
    around = np.pad(path, CORNER // 2, mode="edge")
    return np.asarray(np.convolve(around, weights / weights.sum(), "valid"))


def sample_times(limits: Limits) -> FloatArray:
    """Return the times [s] of a motion's samples."""
    return np.arange(int(limits.longest / limits.step), dtype=np.float64) * limits.step


def _triangle(limits: Limits, phase: FloatArray) -> FloatArray:
    return limits.deepest * (1.0 - np.abs(1.0 - 2.0 * (phase % 1.0)))


@rounded
def three_rates(limits: Limits) -> FloatArray:
    """Triangles at a fortieth, a fifth and the whole of the fastest rate, a third of the time each."""
    t = sample_times(limits)
    third = np.minimum((3.0 * t / limits.longest).astype(int), 2)
    rate = readable_rate(limits) * np.array([1.0 / 40.0, 1.0 / 5.0, 1.0])[third]
    return _triangle(limits, np.cumsum(rate * limits.step) / (2.0 * limits.deepest))


@rounded
def ramp_and_hold(limits: Limits) -> FloatArray:
    """Quick ramps to six levels, each held for a sixth of the time."""
    t = sample_times(limits)
    levels = limits.deepest * np.array([0.35, 0.7, 1.0, 0.55, 0.85, 0.2])
    at = np.minimum((6.0 * t / limits.longest).astype(int), 5)
    return _no_faster(levels[at], 0.5 * readable_rate(limits) * limits.step)


def sweep(limits: Limits) -> FloatArray:
    """A sine about half the largest deflection, from 0.05 Hz to what the fastest rate allows, by decades."""
    t = sample_times(limits)
    swing = 0.3 * limits.deepest
    high = readable_rate(limits) / (2.0 * np.pi * swing)
    growth = np.log(high / 0.05) / limits.longest
    return np.asarray(
        0.5 * limits.deepest - swing * np.cos(2.0 * np.pi * 0.05 * np.expm1(growth * t) / growth)
    )


@rounded
def growing(limits: Limits) -> FloatArray:
    """Triangles of growing depth, each depth twice, at a fifth of the fastest rate, and the first one again."""
    peaks = limits.deepest * np.array([0.3, 0.3, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 0.3, 0.3])
    knots = np.zeros(2 * peaks.size + 1)
    knots[1::2] = peaks
    times = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(knots)))])
    return np.interp(sample_times(limits), times * limits.longest / times[-1], knots)


@rounded
def two_means(limits: Limits) -> FloatArray:
    """The same small sine about a low and a high mean deflection, slow and fast."""
    t = sample_times(limits)
    quarter = np.minimum((4.0 * t / limits.longest).astype(int), 3)
    mean = limits.deepest * np.array([0.3, 0.8, 0.3, 0.8])[quarter]
    swing = 0.18 * limits.deepest
    frequency = np.array([0.2, 0.2, 1.0, 1.0])[quarter] * min(
        4.0, readable_rate(limits) / (2.0 * np.pi * swing)
    )
    wave = mean + swing * np.sin(2.0 * np.pi * np.cumsum(frequency) * limits.step)
    return _no_faster(wave, readable_rate(limits) * limits.step)


@rounded
def rest_and_repeat(limits: Limits) -> FloatArray:
    """Three slow cycles, a rest of a third of the time without load, and the same cycles again."""
    t = sample_times(limits) / limits.longest
    phase = np.where(t < 1.0 / 3.0, 9.0 * t, np.where(t < 2.0 / 3.0, 0.0, 9.0 * (t - 2.0 / 3.0)))
    return _triangle(limits, phase)


WAVEFORMS: dict[str, Waveform] = {
    "triangles at three rates": three_rates,
    "ramp and hold": ramp_and_hold,
    "sweep": sweep,
    "growing triangles": growing,
    "small sines about two means": two_means,
    "cycles, rest, cycles": rest_and_repeat,
}


@rounded
def slow_triangles(limits: Limits) -> FloatArray:
    """Whole triangles at about a fortieth of the fastest rate, one at least."""
    cycles = max(1, round(limits.longest * readable_rate(limits) / (80.0 * limits.deepest)))
    return _triangle(limits, cycles * sample_times(limits) / limits.longest)


@rounded
def fast_triangles(limits: Limits) -> FloatArray:
    """Triangles at the fastest rate."""
    return _triangle(limits, sample_times(limits) * readable_rate(limits) / (2.0 * limits.deepest))


def fast_sine(limits: Limits) -> FloatArray:
    """A sine about half the largest deflection at the fastest rate."""
    swing = 0.3 * limits.deepest
    phase = sample_times(limits) * readable_rate(limits) / swing
    return np.asarray(0.5 * limits.deepest - swing * np.cos(phase))


MENU: dict[str, Waveform] = {
    "slow triangles": slow_triangles,
    "fast triangles": fast_triangles,
    "fast sine": fast_sine,
    **WAVEFORMS,
}
"""What a plan chooses from."""


def _no_faster(path: FloatArray, step: float) -> FloatArray:
    limited = np.empty_like(path)
    here = 0.0
    for i, wanted in enumerate(path):
        here += float(np.clip(wanted - here, -step, step))
        limited[i] = here
    return limited
