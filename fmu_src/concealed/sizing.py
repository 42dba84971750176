"""How large an effect is against the noise, and the strength that gives it a wanted size."""

from dataclasses import dataclass

import numpy as np

from .bench import Bench
from .effects.effect import Effect
from .motion import BoolArray, FloatArray, Motion

#: Relative error of a size that the search accepts.
CLOSE_ENOUGH = 0.01
SECANT_STEPS = 12


@dataclass(frozen=True)
class Size:
    """Sizes of an effect in units of the noise's RMS.

    requested: what was asked for (0: nothing was); raw: RMS of the force with the effect less the force without it,
    over the samples in which the effect is active; overall: the same over all samples; refitted: overall, after A and
    B of every surface were refitted to it; beyond_shape: overall, after the best smooth function of deflection on
    every surface was subtracted; share: part of the samples in which the effect is active; reached: whether the raw
    size is the requested one (within 5 %); it is not where that would take an implausible strength.
    """

    requested: float
    raw: float
    overall: float
    refitted: float
    beyond_shape: float
    share: float
    reached: bool


def contributions(bench: Bench, name: str, motions: tuple[Motion, ...]) -> list[FloatArray]:
    """Force with the effect less force without it [N], on the recorded samples of every motion.

    An effect that falsifies the reading adds what the force lacks at the deflection that the gauge shows.
    """
    less = bench.without(name)
    gauge = Bench(bench.tire, tuple(e for e in bench.effects if e.name == name))
    return [m.recorded(bench.force(m) - less.force(gauge.seen(m))) for m in motions]


def measured(
    bench: Bench, effect: Effect, motions: tuple[Motion, ...], noise: float, requested: float
) -> Size:
    """All sizes of one effect, with the other effects present."""
    parts = contributions(bench, effect.name, motions)
    return _sizes(bench, motions, parts, _active(bench, effect, motions), noise, requested)


def misfit_size(bench: Bench, motions: tuple[Motion, ...], misfit: list[FloatArray], noise: float) -> Size:
    """All sizes of the difference [N] between a tire and the baseline tire."""
    everywhere = [np.ones(part.size, dtype=bool) for part in misfit]
    return _sizes(bench, motions, misfit, everywhere, noise, 0.0)


def resized(bench: Bench, effect: Effect, motions: tuple[Motion, ...], noise: float, wanted: float) -> Effect:
    """The effect in the strength at which its raw size is the wanted one, or at its limit.

    Secant on the logarithms of strength and size, which are nearly proportional for every effect.
    """

    def size(strength: float) -> float:
        changed = bench.replacing(effect.with_strength(strength))
        inside = np.concatenate(_active(changed, effect.with_strength(strength), motions))
        parts = np.concatenate(contributions(changed, effect.name, motions))
        return _rms(parts[inside]) / noise

    sign = 1.0 if effect.strength >= 0.0 else -1.0
    strength, slope = min(abs(effect.strength), effect.limit), 1.0
    last: tuple[float, float] | None = None
    for _ in range(SECANT_STEPS):
        found = size(sign * strength)
        if found > 0.0 and abs(found / wanted - 1.0) < CLOSE_ENOUGH:
            break
        if strength >= effect.limit and found < wanted:
            break
        if found <= 0.0:
            # too small to change a single sample: back towards the last strength that did
            strength = min(effect.limit, np.sqrt(strength * last[0]) if last else 4.0 * strength)
            continue
        if last is not None and abs(np.log(strength / last[0])) > 1e-9:
            slope = float(np.clip(np.log(found / last[1]) / np.log(strength / last[0]), 0.3, 3.0))
        last = (strength, found)
        strength = min(effect.limit, strength * float(np.exp(np.log(wanted / found) / slope)))
    return effect.with_strength(sign * strength)


def _sizes(
    bench: Bench,
    motions: tuple[Motion, ...],
    parts: list[FloatArray],
    active: list[BoolArray],
    noise: float,
    requested: float,
) -> Size:
    whole, inside = np.concatenate(parts), np.concatenate(active)
    plain = np.concatenate(_aligned([_elastic_columns(bench, m) for m in motions]))
    smooth = np.concatenate(
        [_smooth_columns(m.recorded(m.deflection), m.recorded(m.radius), motions) for m in motions]
    )
    raw = _rms(whole[inside]) / noise
    return Size(
        requested=requested,
        raw=raw,
        overall=_rms(whole) / noise,
        refitted=_rms(_left_over(whole, plain)) / noise,
        beyond_shape=_rms(_left_over(whole, smooth)) / noise,
        share=float(np.mean(inside)),
        reached=requested > 0.0 and abs(raw / requested - 1.0) < 0.05,
    )


def _active(bench: Bench, effect: Effect, motions: tuple[Motion, ...]) -> list[BoolArray]:
    result = []
    for motion in motions:
        contact = bench.contact(motion)
        where = effect.active(contact)
        everywhere = np.ones(motion.time.size, dtype=bool)
        result.append(motion.recorded(everywhere if where is None else where))
    return result


def _elastic_columns(bench: Bench, motion: Motion) -> dict[float, FloatArray]:
    """Sensitivities of the elastic force to A and B on every surface: F and F ln x."""
    force = motion.recorded(Bench(bench.tire).force(motion))
    log = np.log(np.maximum(100.0 * motion.recorded(motion.deflection), 1e-3))
    radius = motion.recorded(motion.radius)
    return {r: np.stack([force, force * log], axis=1) * (radius == r)[:, None] for r in motion.surfaces}


def _aligned(parts: list[dict[float, FloatArray]]) -> list[FloatArray]:
    surfaces = sorted({r for part in parts for r in part})
    aligned = []
    for part in parts:
        empty = np.zeros_like(next(iter(part.values())))
        aligned.append(np.concatenate([part.get(r, empty) for r in surfaces], axis=1))
    return aligned


def _smooth_columns(deflection: FloatArray, radius: FloatArray, motions: tuple[Motion, ...]) -> FloatArray:
    """Chebyshev polynomials of the deflection up to the eighth degree, on every surface."""
    deepest = max(float(np.max(m.deflection)) for m in motions)
    basis = np.polynomial.chebyshev.chebvander(2.0 * deflection / deepest - 1.0, 8)
    surfaces = sorted({r for m in motions for r in m.surfaces})
    return np.concatenate([basis * (radius == r)[:, None] for r in surfaces], axis=1)


def _left_over(values: FloatArray, columns: FloatArray) -> FloatArray:
    columns = columns / np.maximum(np.sqrt(np.sum(columns**2, axis=0)), 1e-30)
    fit, *_ = np.linalg.lstsq(columns.T @ columns, columns.T @ values, rcond=1e-12)
    return np.asarray(values - columns @ fit, dtype=np.float64)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0
