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

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from ..errors import TirelabError
from ..recordings.plausibility import force_begins
from ..recordings.recording import Recording
from .both_ways import loop_state, passed_both_ways
from .misfit import noise_beside
from .surfaces import CM_PER_M

Array = NDArray[np.float64]

MM_PER_CM = 10.0

SAMPLES_MOST = 20_000
"""Most samples that are fitted, evenly spaced."""

LINES = (5, 10, 20, 40, 80)
"""Numbers of straight lines of the piecewise law of which the one of the least criterion is taken: a detent needs four,
a part has some."""

SAMPLES_OF_LINE = 8
"""Fewest samples of one of many lines: four for each of its two numbers. A place is one of as many parts of a line."""

PASSES = 6
"""Number of steps in which lines and a loop in proportion to them are fitted."""

REACHES, REACH_KNOWN = (0.001, 0.003, 0.01, 0.03, 0.1), 0.02
"""Parts of the range of the deflection over which a loop may go half from one way to the other after a turn, of which
the best is looked for further, to so much of itself."""

FARTHEST_LOG = 600.0
"""Logarithm of a factor at most: doubles end at 709."""

UNSEEN = 1e-9
"""Part of what a law leaves by which a constant moves its force at most where the recordings do not determine it."""


@dataclass(frozen=True)
class LawFit:
    """One law fitted: its constants with standard uncertainties for white noise, and the RMSE [N] it leaves.

    constants: symbol, value, uncertainty (without end where nothing determines it) and unit of each
    bic: Bayesian criterion relative to nothing, lower is better
    at: the deflections [m] whose forces the constants are, in the piecewise law; amid_loop: whether it was fitted
    within a loop, which its RMSE counts
    """

    name: str
    constants: tuple[tuple[str, float, float, str], ...]
    rmse: float
    bic: float
    at: tuple[float, ...] = ()
    amid_loop: bool = False

    def value(self, symbol: str) -> float:
        """Return a constant; raises KeyError where the law has none of that symbol."""
        return {s: value for s, value, _, _ in self.constants}[symbol]

    def to_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        constants = {
            symbol: {"value": value, "std": deviation if isfinite(deviation) else None, "unit": unit}
            for symbol, value, deviation, unit in self.constants
        }
        return {"name": self.name, "constants": constants, "rmse": self.rmse, "bic": self.bic}


@dataclass(frozen=True)
class _Samples:
    """Deflection and force of all recordings together, over `length` [cm] and `load` [N], their largest, so that parts
    of any size are fitted alike; pressure [Pa] or None.

    begins: deflection where the force is seen to begin; each: deflection of each recording; both_ways: whether most
    places are passed in and out
    """

    x: Array
    force: Array
    length: float
    load: float
    pressure: Array | None
    begins: float
    each: tuple[Array, ...]
    both_ways: bool


def fit_laws(recordings: Sequence[Recording]) -> tuple[LawFit, ...]:
    """Return every law fitted to recordings of one part on one surface, the one of the least criterion first.

    Raises TirelabError where the surface changes.
    """
    samples = _samples(recordings)
    fits = (
        _constant(samples),
        _linear(samples),
        _shifted(samples, "linear_gap"),
        _power(samples),
        _power_preload(samples),
        _shifted(samples, "power_gap"),
        _polynomial(samples),
        _piecewise(samples),
        _mf_tyre(samples),
    )
    return tuple(sorted(fits, key=lambda fit: fit.bic))


def constant_fit(recordings: Sequence[Recording]) -> LawFit:
    """Return the constant force fitted to recordings of one part. Errors: as `fit_laws`."""
    return _constant(_samples(recordings))


def reading_noise(recordings: Sequence[Recording]) -> float:
    """Return the noise of the forces [N], root mean square over the recordings; NaN where they are too short.

    It is that beside a polynomial over the deflection, whatever law is fitted: the noise is no part of it.
    """
    return noise_beside(recordings, [_beside_polynomial(r.deflection, r.force) for r in recordings])


def _beside_polynomial(x: Array, force: Array) -> Array:
    way = (x - x.mean()) / max(float(np.ptp(x)), 1e-300)
    powers = np.vander(way, 4)
    return np.asarray(force - powers @ np.linalg.lstsq(powers, force, rcond=None)[0])


def _samples(recordings: Sequence[Recording]) -> _Samples:
    radii = np.unique(np.concatenate([np.unique(r.surface_radius) for r in recordings]))
    if radii.size > 1:
        raise TirelabError(
            f"the recordings were made on {radii.size} surfaces; the laws are compared on one surface at a time"
        )
    step = max(1, sum(len(r) for r in recordings) // SAMPLES_MOST)
    x = np.concatenate([r.deflection[::step] for r in recordings])
    force = np.concatenate([r.force[::step] for r in recordings])
    far, load = (float(np.abs(values).max()) or 1.0 for values in (x, force))
    pressures = [r.pressure[::step] for r in recordings if r.pressure is not None]
    pressure = np.concatenate(pressures) if len(pressures) == len(recordings) else None
    zero = force_begins(x, force, np.zeros_like(x))
    begins = 0.0 if zero is None else zero.begins / far
    each = tuple(r.deflection[::step] / far for r in recordings)
    both_ways = passed_both_ways(recordings)
    return _Samples(x / far, force / load, CM_PER_M * far, load, pressure, begins, each, both_ways)


_Symbols = Sequence[tuple[str, float, str]]
"""Name of each constant, factor from the units of the fit to the shown unit, and that."""


def _fit(name: str, symbols: _Symbols, values: Array, fitted: _Fitted, load: float) -> LawFit:
    """Return a law from its values in the units of the fit; load [N]: that of the force."""
    residual, derivatives = fitted
    n, k = residual.size, values.size
    squares = float(residual @ residual)
    variance = squares / max(n - k, 1)
    # In units of their own: a coefficient of 1e5 beside an exponent would be cut off as if it were not seen at all.
    sizes = np.maximum(np.linalg.norm(derivatives, axis=0), 1e-300)
    seen = derivatives / sizes
    covariance = variance * np.linalg.pinv(seen.T @ seen)
    spread = np.sqrt(np.maximum(np.diag(covariance), 0.0)) / sizes
    spread[sizes * np.maximum(np.abs(values), 1.0) <= UNSEEN * np.sqrt(squares)] = np.inf
    constants = tuple(
        (symbol, float(value * factor), float(abs(factor) * deviation), unit)
        for (symbol, factor, unit), value, deviation in zip(symbols, values, spread, strict=True)
    )
    return LawFit(name, constants, *_left(load * residual, k))


def _left(residual: Array, count: int) -> tuple[float, float]:
    """Return the root mean square of a residual [N], and the criterion of a law of so many constants."""
    mean, n = float(np.mean(residual**2)), residual.size
    return mean**0.5, n * float(np.log(max(mean, 1e-300))) + count * float(np.log(n))


_Fitted = tuple[Array, Array]
"""Residual (n,) and derivatives (n, k) of the law by its values."""


def _lstsq(columns: Sequence[Array], samples: _Samples) -> tuple[Array, _Fitted]:
    matrix = np.stack(columns, axis=1)
    values = np.asarray(np.linalg.lstsq(matrix, samples.force, rcond=None)[0], dtype=np.float64)
    return values, (samples.force - matrix @ values, matrix)


def _constant(s: _Samples) -> LawFit:
    values, fitted = _lstsq([np.ones_like(s.x)], s)
    return _fit("constant", (("F0", s.load, "N"),), values, fitted, s.load)


def _linear(s: _Samples) -> LawFit:
    values, fitted = _lstsq([np.ones_like(s.x), s.x], s)
    return _fit("linear", _powers(s, ("F0", "k")), values, fitted, s.load)


def _polynomial(s: _Samples) -> LawFit:
    values, fitted = _lstsq([s.x**i for i in range(4)], s)
    return _fit("polynomial", _powers(s, ("F0", "k1", "k2", "k3")), values, fitted, s.load)


def _powers(s: _Samples, names: Sequence[str], first: int = 0) -> _Symbols:
    """Return constants of successive powers of the deflection, from the one of the order `first` on."""
    units = ("N", "N/mm", "N/mm^2", "N/mm^3")
    return [(n, s.load / (MM_PER_CM * s.length) ** i, units[i]) for i, n in enumerate(names, first)]


def _piecewise(s: _Samples) -> LawFit:
    few = [n for n in LINES if n == LINES[0] or SAMPLES_OF_LINE * n <= s.x.size]
    best = min((_lines(s, n, None) for n in few), key=lambda own: own[0])
    if s.both_ways:
        # At a turn the two ways meet: lines through all samples follow the way in there, and the middle elsewhere.
        state, all_of_it = _loop_state(s, len(best[1].at) - 1), best[1].rmse
        # A loop that is larger than all that these lines leave is seen if it is most of that, not in a hold alone.
        beside = [_lines(s, n, state) for n in few]
        seen = [own for own in beside if min(2.0 * own[2] ** 2, 0.5 * own[1].rmse ** 2) < all_of_it**2]
        return min((best, *seen), key=lambda own: own[0])[1]
    return best[1]


def _loop_state(s: _Samples, count: int) -> Array:
    """Return the state (n,) of the loop beside which so many lines have the least criterion."""
    span = float(np.ptp(s.x))

    def state(reach: float) -> Array:
        return np.concatenate([loop_state(x, np.exp(reach) * span) for x in s.each])

    def criterion(reach: float) -> float:
        return _lines(s, count, state(reach))[0]

    tried = np.log(REACHES)
    best = int(np.argmin(list(map(criterion, tried.tolist()))))
    near = tried[max(best - 1, 0)], tried[min(best + 1, tried.size - 1)]
    found = minimize_scalar(criterion, bounds=near, method="bounded", options={"xatol": REACH_KNOWN})
    return state(float(found.x))


def _lines(s: _Samples, count: int, state: Array | None) -> tuple[float, LawFit, float]:
    """Return the criterion of lines beside the loop of a state (n,), if given, the lines, and what both leave [N]."""
    knots = _knots(s, count)
    hats, n = _hats(s.x, knots), knots.size
    (values, (residual, matrix)), lines, share = _lstsq(hats, s), np.stack(hats, axis=1), 0.0
    for u in [] if state is None else [state] * PASSES:
        # Gauss and Newton: the last column changes the share b of the loop, whose product with the lines is no column.
        in_proportion = [hat * (1.0 + share * u) for hat in hats]
        values, (residual, matrix) = _lstsq([*in_proportion, u, u * (lines @ values[:n])], s)
        share += float(values[-1])
    digits = 3 if count == LINES[0] else 9  # so that near ones have different symbols
    places = s.length * knots
    units = [(f"F({MM_PER_CM * place:.{digits}g} mm)", s.load, "N") for place in places]
    at = tuple((places / CM_PER_M).tolist())
    loop = (("a", s.load, "N"), ("b", 1.0, "1"))[: values.size - n]
    fit = _fit("piecewise", [*units, *loop], values, (residual, matrix), s.load)
    left, criterion = _left(s.load * (s.force - lines @ values[:n]), n)
    return fit.bic, LawFit(fit.name, fit.constants[:n], left, criterion, at, state is not None), fit.rmse


def _hats(x: Array, knots: Array) -> list[Array]:
    """Return for each knot the function (n,) that is 1 there, 0 at the others, and straight between."""
    return [np.interp(x, knots, hat) for hat in np.eye(knots.size)]


def _knots(s: _Samples, count: int) -> Array:
    """Return at most count + 1 deflections, between each two of which the curve of the mean force is as long, with both
    axes scaled to one: where the force rises in a small part of the way, as metal does, lines are needed there.

    However long a part is held, a place is one: between two knots within a hold the force would be that of two times.
    """
    x = s.x
    lowest, highest = float(x.min()), float(x.max())
    step = max((highest - lowest) / (SAMPLES_OF_LINE * count), 1e-300)
    places, own = np.unique(np.floor((x - lowest) / step), return_inverse=True)
    visited = np.clip(lowest + step * (places + 0.5), lowest, highest)
    force = np.bincount(own, s.force) / np.bincount(own)
    ways = (np.diff(v) / max(float(np.ptp(v)), 1e-300) for v in (visited, force))
    length = np.append(0.0, np.cumsum(np.hypot(*ways)))
    knots = np.interp(np.linspace(0.0, length[-1], count + 1), length, visited)
    knots[[0, -1]] = lowest, highest
    return np.asarray(knots[np.append(True, np.diff(knots) > 0.5 * step)])


def _mf_tyre(s: _Samples) -> LawFit:
    plain = [s.x, s.x**2]
    units = _powers(s, ("q1", "q2"), 1)
    if s.pressure is None or np.ptp(s.pressure) <= 0.0:
        values, fitted = _lstsq(plain, s)
        return _fit("mf_tyre", units, values, fitted, s.load)
    relative = s.pressure / float(s.pressure.mean()) - 1.0

    def law(v: Array) -> Array:
        return np.asarray((v[0] * s.x + v[1] * s.x**2) * (1.0 + v[2] * relative))

    start = np.append(_lstsq(plain, s)[0], 0.5)
    values, fitted = _searched(law, start, s)
    return _fit("mf_tyre", (*units, ("p", 1.0, "1")), values, fitted, s.load)


def _power(s: _Samples) -> LawFit:
    size = np.abs(s.x) + 1e-12

    def law(v: Array) -> Array:
        return np.asarray(v[0] * np.sign(s.x) * size ** v[1])

    symbols, values, fitted = _over_centimetres(s, *_searched(law, _power_start(s, 0.0), s))
    return _fit("power", symbols, values, fitted, s.load)


def _power_preload(s: _Samples) -> LawFit:
    size, sign = np.abs(s.x) + 1e-12, np.sign(s.x)

    def law(v: Array) -> Array:
        return np.asarray(v[2] + v[0] * sign * size ** v[1])

    (preload, stiffness), _ = _lstsq([np.ones_like(s.x), s.x], s)
    symbols, values, fitted = _over_centimetres(s, *_searched(law, np.array([stiffness, 1.0, preload]), s))
    return _fit("power_preload", [*symbols, ("F0", s.load, "N")], values, fitted, s.load)


def _over_centimetres(s: _Samples, values: Array, fitted: _Fitted) -> tuple[_Symbols, Array, _Fitted]:
    """Return A and B of a law A (x / length)^B as those of a law of x, and its values with A in units of itself: the
    square of an A in N/cm^B may be beyond all numbers.
    """
    (scaled, exponent, *others), (residual, slopes) = values.tolist(), fitted
    shift = float(np.clip(-exponent * np.log(s.length), -FARTHEST_LOG, FARTHEST_LOG))
    by_factor = scaled * slopes[:, 0]
    slopes = np.column_stack([by_factor, slopes[:, 1] + np.log(s.length) * by_factor, slopes[:, 2:]])
    symbols = [("A", s.load * scaled * float(np.exp(shift)), "N/cm^B"), ("B", 1.0, "1")]
    return symbols, np.array([1.0, exponent, *others]), (residual, slopes)


def _shifted(s: _Samples, name: str) -> LawFit:
    """Return a law that begins at x0: fitted from where the force is seen to begin, and from its straight line."""
    linear = name == "linear_gap"

    def law(v: Array) -> Array:
        beyond = np.maximum(s.x - v[-1], 0.0)
        return np.asarray(v[0] * (beyond if linear else (beyond + 1e-12) ** v[1]))

    (force, stiffness), _ = _lstsq([np.ones_like(s.x), s.x], s)
    seen = _power_start(s, s.begins)
    starts = [[seen[0], s.begins] if linear else [*seen, s.begins]]
    if stiffness != 0.0:
        crossing = -force / stiffness
        starts.append([stiffness, crossing] if linear else [stiffness, 1.0, crossing])
    found = [_searched(law, np.array(start), s) for start in starts]
    values, fitted = min(found, key=lambda f: float(f[1][0] @ f[1][0]))
    symbols = _powers(s, ("k",), 1)
    if not linear:
        symbols, values, fitted = _over_centimetres(s, values, fitted)
    to_mm = MM_PER_CM * s.length
    fit = _fit(name, [*symbols, ("x0", to_mm, "mm")], values, fitted, s.load)
    *others, (symbol, begins, deviation, unit) = fit.constants
    far = deviation > to_mm * float(np.ptp(s.x))  # it lies anywhere
    return replace(fit, constants=(*others, (symbol, begins, np.inf if far else deviation, unit)))


def _power_start(s: _Samples, begins: float) -> Array:
    """Return A and B through the largest force and that at half its deflection, or a line where one is missing."""
    beyond = np.maximum(s.x - begins, 0.0)
    top = float(beyond.max()) or 1.0
    far, half_way = s.force[beyond > 0.9 * top], s.force[np.abs(beyond - 0.5 * top) < 0.1 * top]
    if not (far.size and half_way.size):
        return np.array([float(_lstsq([np.ones_like(s.x), s.x], s)[0][1]), 1.0])
    high, half = float(np.median(far)), float(np.median(half_way))
    ratio = high / half if half > 0.0 < high else 2.0
    exponent = float(np.clip(np.log(ratio) / np.log(1.9), 0.3, 4.0))
    return np.array([high / (0.95 * top) ** exponent, exponent])


def _searched(law: Callable[[Array], Array], start: Array, s: _Samples) -> tuple[Array, _Fitted]:
    """Return the values of least squares from a start, by SciPy's trust region."""
    from scipy.optimize import least_squares

    found = least_squares(lambda v: law(v) - s.force, start, x_scale=np.maximum(np.abs(start), 0.1))
    return np.asarray(found.x), (s.force - law(found.x), np.asarray(found.jac))
