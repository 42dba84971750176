"""Laws of springs, bushings and tires side by side: what each leaves of recordings of one part, and its constants.

Deflection x and force F may have both signs. All samples count alike.

    constant      F = F0                                 a damper or a seal under a preload, without a spring
    linear        F = F0 + k x
    linear_gap    F = k max(x - x0, 0)                   x0: where the force begins (a gap > 0, a preload < 0)
    power         F = A sign(x) |x|^B                    x in cm, as the tire's law
    power_preload F = F0 + A sign(x) |x|^B
    power_gap     F = A max(x - x0, 0)^B
    polynomial    F = F0 + k1 x + k2 x^2 + k3 x^3
    piecewise     straight lines between the forces at x1 ... xn, along the curve; n by the criterion. Where most places
                  are passed in and out, within the loop F + u (a + b F) of dry friction, u from -1 (out) to 1 (in)
    mf_tyre       F = (q1 x + q2 x^2) (1 + p dp)         dp = pressure over the mean one, less 1, where it was recorded

mf_tyre is the vertical force of MF-Tyre without speed and camber: H. Pacejka, "Tire and Vehicle Dynamics", 3rd ed.
2012, eq. 4.E68, with q1 = Fz0 qFz1 / R0, q2 = Fz0 qFz2 / R0^2 and p = pFz1 for the mean pressure as reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..recordings.recording import Recording
from .law_fit import (
    MM_PER_CM,
    Array,
    Fitted,
    LawFit,
    Samples,
    Symbols,
    fit_of,
    powers,
    samples_of,
    searched,
    solved,
)
from .misfit import noise_beside
from .straight_lines import piecewise

FARTHEST_LOG = 600.0
"""Logarithm of a factor at most: doubles end at 709."""


def fit_laws(recordings: Sequence[Recording]) -> tuple[LawFit, ...]:
    """Return every law fitted to recordings of one part on one surface, the one of the least criterion first.

    Raises TirelabError where the surface changes.
    """
    samples = samples_of(recordings)
    fits = (
        _constant(samples),
        _linear(samples),
        _shifted(samples, "linear_gap"),
        _power(samples),
        _power_preload(samples),
        _shifted(samples, "power_gap"),
        _polynomial(samples),
        piecewise(samples),
        _mf_tyre(samples),
    )
    return tuple(sorted(fits, key=lambda fit: fit.bic))


def constant_fit(recordings: Sequence[Recording]) -> LawFit:
    """Return the constant force fitted to recordings of one part. Errors: as `fit_laws`."""
    return _constant(samples_of(recordings))


def reading_noise(recordings: Sequence[Recording]) -> float:
    """Return the noise of the forces [N], root mean square over the recordings; NaN where they are too short.

    It is that beside a polynomial over the deflection, whatever law is fitted: the noise is no part of it.
    """
    return noise_beside(recordings, [_beside_polynomial(r.deflection, r.force) for r in recordings])


def _beside_polynomial(x: Array, force: Array) -> Array:
    way = (x - x.mean()) / max(float(np.ptp(x)), 1e-300)
    powers = np.vander(way, 4)
    return np.asarray(force - powers @ np.linalg.lstsq(powers, force, rcond=None)[0])


def _constant(s: Samples) -> LawFit:
    values, fitted = solved([np.ones_like(s.x)], s)
    return fit_of("constant", (("F0", s.load, "N"),), values, fitted, s.load)


def _linear(s: Samples) -> LawFit:
    values, fitted = solved([np.ones_like(s.x), s.x], s)
    return fit_of("linear", powers(s, ("F0", "k")), values, fitted, s.load)


def _polynomial(s: Samples) -> LawFit:
    values, fitted = solved([s.x**i for i in range(4)], s)
    return fit_of("polynomial", powers(s, ("F0", "k1", "k2", "k3")), values, fitted, s.load)


def _mf_tyre(s: Samples) -> LawFit:
    plain = [s.x, s.x**2]
    units = powers(s, ("q1", "q2"), 1)
    if s.pressure is None or np.ptp(s.pressure) <= 0.0:
        values, fitted = solved(plain, s)
        return fit_of("mf_tyre", units, values, fitted, s.load)
    relative = s.pressure / float(s.pressure.mean()) - 1.0

    def law(v: Array) -> Array:
        return np.asarray((v[0] * s.x + v[1] * s.x**2) * (1.0 + v[2] * relative))

    start = np.append(solved(plain, s)[0], 0.5)
    values, fitted = searched(law, start, s)
    return fit_of("mf_tyre", (*units, ("p", 1.0, "1")), values, fitted, s.load)


def _power(s: Samples) -> LawFit:
    size = np.abs(s.x) + 1e-12

    def law(v: Array) -> Array:
        return np.asarray(v[0] * np.sign(s.x) * size ** v[1])

    symbols, values, fitted = _over_centimetres(s, *searched(law, _power_start(s, 0.0), s))
    return fit_of("power", symbols, values, fitted, s.load)


def _power_preload(s: Samples) -> LawFit:
    size, sign = np.abs(s.x) + 1e-12, np.sign(s.x)

    def law(v: Array) -> Array:
        return np.asarray(v[2] + v[0] * sign * size ** v[1])

    (preload, stiffness), _ = solved([np.ones_like(s.x), s.x], s)
    symbols, values, fitted = _over_centimetres(s, *searched(law, np.array([stiffness, 1.0, preload]), s))
    return fit_of("power_preload", [*symbols, ("F0", s.load, "N")], values, fitted, s.load)


def _over_centimetres(s: Samples, values: Array, fitted: Fitted) -> tuple[Symbols, Array, Fitted]:
    """Return A and B of a law A (x / length)^B as those of a law of x, and its values with A in units of itself: the
    square of an A in N/cm^B may be beyond all numbers.
    """
    (scaled, exponent, *others), (residual, slopes) = values.tolist(), fitted
    shift = float(np.clip(-exponent * np.log(s.length), -FARTHEST_LOG, FARTHEST_LOG))
    by_factor = scaled * slopes[:, 0]
    slopes = np.column_stack([by_factor, slopes[:, 1] + np.log(s.length) * by_factor, slopes[:, 2:]])
    symbols = [("A", s.load * scaled * float(np.exp(shift)), "N/cm^B"), ("B", 1.0, "1")]
    return symbols, np.array([1.0, exponent, *others]), (residual, slopes)


def _shifted(s: Samples, name: str) -> LawFit:
    """Return a law that begins at x0: fitted from where the force is seen to begin, and from its straight line."""
    linear = name == "linear_gap"

    def law(v: Array) -> Array:
        beyond = np.maximum(s.x - v[-1], 0.0)
        return np.asarray(v[0] * (beyond if linear else (beyond + 1e-12) ** v[1]))

    (force, stiffness), _ = solved([np.ones_like(s.x), s.x], s)
    seen = _power_start(s, s.begins)
    starts = [[seen[0], s.begins] if linear else [*seen, s.begins]]
    if stiffness != 0.0:
        crossing = -force / stiffness
        starts.append([stiffness, crossing] if linear else [stiffness, 1.0, crossing])
    found = [searched(law, np.array(start), s) for start in starts]
    values, fitted = min(found, key=lambda f: float(f[1][0] @ f[1][0]))
    symbols = powers(s, ("k",), 1)
    if not linear:
        symbols, values, fitted = _over_centimetres(s, values, fitted)
    to_mm = MM_PER_CM * s.length
    fit = fit_of(name, [*symbols, ("x0", to_mm, "mm")], values, fitted, s.load)
    *others, (symbol, begins, deviation, unit) = fit.constants
    far = deviation > to_mm * float(np.ptp(s.x))  # it lies anywhere
    return replace(fit, constants=(*others, (symbol, begins, np.inf if far else deviation, unit)))


def _power_start(s: Samples, begins: float) -> Array:
    """Return A and B through the largest force and that at half its deflection, or a line where one is missing."""
    beyond = np.maximum(s.x - begins, 0.0)
    top = float(beyond.max()) or 1.0
    far, half_way = s.force[beyond > 0.9 * top], s.force[np.abs(beyond - 0.5 * top) < 0.1 * top]
    if not (far.size and half_way.size):
        return np.array([float(solved([np.ones_like(s.x), s.x], s)[0][1]), 1.0])
    high, half = float(np.median(far)), float(np.median(half_way))
    ratio = high / half if half > 0.0 < high else 2.0
    exponent = float(np.clip(np.log(ratio) / np.log(1.9), 0.3, 4.0))
    return np.array([high / (0.95 * top) ** exponent, exponent])
