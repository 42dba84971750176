"""What an effect does to the force, and what each of its parameters changes in that: curves for small pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from radialtire import TireModel
from radialtire.effect import Effect, State

from ..preprocessing.dataset import Recorded
from ..preprocessing.kinematics import FloatArray
from ..simulation.channels import measured_of
from ..simulation.simulate import simulate
from .discriminating_test import Test

SAMPLES, CYCLES = 240, 2
"""Samples and triangles of the motion."""

MORE = 1.5
"""A parameter is varied by this factor."""

DEEPEST, TYPICAL = 0.999, 0.9
"""Quantiles of the deflection and of the speed that the motion takes over."""


@dataclass(frozen=True)
class EffectSketch:
    """The force [N] that an effect adds over the deflection [m], as fitted and with each parameter larger.

    varied: parameter -> force where it alone is MORE times as large, as far as its bounds allow
    """

    deflection: FloatArray
    force: FloatArray
    varied: Mapping[str, FloatArray]


def sketch_of(name: str, tire: TireModel, recordings: Sequence[Recorded]) -> EffectSketch | None:
    """Return the curves of an effect of `tire` on two triangles as deep and as fast as the recordings.

    An effect that changes slowly with time gets triangles as long as a recording. None where the tire lacks it.
    """
    found = next(((effect, values) for effect, values in tire.effects if effect.name == name), None)
    if found is None or not recordings:
        return None
    effect, values = found
    motion = replace(
        _motion(recordings, slow="slow" in effect.traits), measured=_set(effect, values, recordings)
    )
    bare = simulate(replace(tire, effects=()), motion)

    def added(given: State) -> FloatArray:
        return simulate(replace(tire, effects=((effect, given),)), motion) - bare

    varied = {p.name: added(_larger(effect, values, i)) for i, p in enumerate(effect.parameters)}
    return EffectSketch(motion.deflection, added(values), MappingProxyType(varied))


def _set(effect: Effect, values: State, recordings: Sequence[Recorded]) -> dict[str, FloatArray]:
    """Return the channel that the effect reads at the recorded value that is farthest from its reference."""
    reads = effect.reads
    if reads is None or reads.reference is None:
        return {}
    held = [measured_of(r)[reads.channel] for r in recordings if reads.channel in measured_of(r)]
    if not held:
        return {}
    reference = values[[p.name for p in effect.parameters].index(reads.reference)]
    levels = np.array([float(np.median(values)) for values in held])
    return {reads.channel: np.full(SAMPLES, levels[np.argmax(np.abs(levels - reference))])}


def _larger(effect: Effect, values: State, index: int) -> State:
    parameter, value = effect.parameters[index], values[index]
    larger = MORE * value if value != 0.0 else parameter.nominal_value
    return (
        *values[:index],
        min(max(larger, parameter.minimum), parameter.maximum),
        *values[index + 1 :],
    )


def _motion(recordings: Sequence[Recorded], *, slow: bool) -> Test:
    deep = float(np.quantile(np.concatenate([r.deflection for r in recordings]), DEEPEST))
    speeds = np.concatenate([np.abs(np.gradient(r.deflection, r.time)) for r in recordings])
    fast = max(float(np.quantile(speeds, TYPICAL)), 1e-12)
    longest = max(float(np.ptp(r.time)) for r in recordings)
    length = longest if slow else 2.0 * CYCLES * deep / fast
    phase = np.linspace(0.0, float(CYCLES), SAMPLES)
    x = deep * (1.0 - np.abs(1.0 - 2.0 * (phase % 1.0)))
    return Test("triangles", phase * length / CYCLES, x, np.full(SAMPLES, np.inf))
