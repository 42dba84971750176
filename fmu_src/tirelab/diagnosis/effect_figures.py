"""What a corrected tire's effects are in figures and curves that a reader knows.

How large each is in the force, what it does to the force and what each of its parameters changes in that, and a
refitted law as A and B on each surface before and after, with the curve of their difference.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from radialtire import FLAT_RADIUS, TireModel
from radialtire.effect import Effect, State

from ..estimation.findings import Estimate
from ..names import REFITTED_LAW
from ..preprocessing.motion import FloatArray
from ..preprocessing.samples import Recorded
from ..simulation.channels import measured_of
from ..simulation.simulate import simulate
from .binning import MOST_SURFACES
from .discriminating_test import Test


def without(name: str, corrected: TireModel, baseline: TireModel) -> TireModel:
    """Return the `corrected` tire with one of its effects as the `baseline` has it: left out where it has none.

    name: of the effect; a refitted law takes the effects with it that are part of a law (its shape)
    """
    own = {effect.name: (effect, values) for effect, values in baseline.effects}
    kept = []
    for effect, values in corrected.effects:
        if effect.name == name or (name == REFITTED_LAW and "law" in effect.traits):
            kept += [own[effect.name]] if effect.name in own else []
        else:
            kept.append((effect, values))
    law = baseline.law if name == REFITTED_LAW else corrected.law
    return replace(corrected, law=law, effects=tuple(kept))


def effect_size(
    name: str, corrected: TireModel, baseline: TireModel, recordings: Sequence[Recorded]
) -> float | None:
    """Return the root mean square [N] of what an effect adds to the `corrected` tire's force; None without samples.

    size^2 = mean (F - F_without)^2   over all samples of the recordings
    """
    less = without(name, corrected, baseline)
    added = [simulate(corrected, r) - simulate(less, r) for r in recordings]
    return float(np.sqrt(np.mean(np.concatenate(added) ** 2))) if added else None


def load_of(recordings: Sequence[Recorded]) -> float | None:
    """Return the root mean square [N] of the recorded force, which sizes are compared with; None without samples."""
    if not recordings:
        return None
    return float(np.sqrt(np.mean(np.concatenate([r.force for r in recordings]) ** 2)))


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


POINTS = 60
"""Points of a curve of difference."""


@dataclass(frozen=True)
class LawChange:
    """The law F = A x^B on one surface before and after the correction.

    radius [m]; before, after: A [N/cm^B] and B [1]; std: standard deviations of those after, None where not known
    deflection [m], difference [N]: the corrected law's force less the baseline's, with the law's bend, as far as the
    surface was pressed
    """

    radius: float
    before: tuple[float, float]
    after: tuple[float, float]
    std: tuple[float, float] | None
    deflection: FloatArray
    difference: FloatArray

    def to_dict(self) -> dict[str, object]:
        """Return the entry of `law` in diagnosis.json."""
        keys = ("A", "B")
        told = {
            key: {
                "before": self.before[i],
                "after": self.after[i],
                "std": None if self.std is None else self.std[i],
            }
            for i, key in enumerate(keys)
        }
        return {"radius": self.radius if np.isfinite(self.radius) else "inf", **told}


def law_changes(
    baseline: TireModel,
    corrected: TireModel,
    estimates: Mapping[str, Estimate],
    recordings: Sequence[Recorded],
) -> tuple[LawChange, ...]:
    """Return the change on every recorded surface, from concave to convex.

    estimates: the fitted changes of ln A and of B by their labels, for the deviations
    """
    deepest: dict[float, float] = {}
    for r in recordings:
        for radius in np.unique(r.surface_radius):
            own = float(np.inf) if abs(radius) >= FLAT_RADIUS else float(radius)
            there = float(r.deflection[r.surface_radius == radius].max())
            deepest[own] = max(deepest.get(own, 0.0), there)
    radii = sorted(deepest, key=lambda radius: 1.0 / radius)
    if len(radii) > MOST_SURFACES:
        radii = [radii[i] for i in np.linspace(0, len(radii) - 1, MOST_SURFACES).round().astype(int)]
    pulled = min(float(r.deflection.min()) for r in recordings) if baseline.two_sided else 0.0
    spans = ((radius, (min(pulled, 0.0), deepest[radius])) for radius in radii)
    return tuple(_change(radius, span, (baseline, corrected), estimates) for radius, span in spans)


def _change(
    radius: float,
    span: tuple[float, float],
    tires: tuple[TireModel, TireModel],
    estimates: Mapping[str, Estimate],
) -> LawChange:
    x = np.linspace(span[0], max(span[1], span[0] + 1e-12), POINTS)
    motion = Test("ramp", np.arange(POINTS, dtype=float), x, np.full(POINTS, radius))
    before, after = (_bare(tire) for tire in tires)
    a, b = before.law.coefficients(radius), after.law.coefficients(radius)
    difference = simulate(after, motion) - simulate(before, motion)
    return LawChange(radius, a, b, _deviations(radius, b[0], estimates), x, difference)


def _bare(tire: TireModel) -> TireModel:
    """Return the law of a tire with the effects that are part of it."""
    return replace(tire, effects=tuple(pair for pair in tire.effects if "law" in pair[0].traits))


def _deviations(
    radius: float, coefficient: float, estimates: Mapping[str, Estimate]
) -> tuple[float, float] | None:
    """Return the deviations of A and B: that of ln A is that of A over A."""
    own = "flat" if np.isinf(radius) else f"{100.0 * radius:.4g} cm"
    for where in (own, "all surfaces"):
        factor, exponent = estimates.get(f"log factor on A, {where}"), estimates.get(f"change of B, {where}")
        if factor is not None and exponent is not None:
            return coefficient * factor.std, exponent.std
    return None
