"""Least squares for the laws of a part: the samples, a law fitted to them, and what it leaves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import TirelabError
from ..recordings.plausibility import force_begins
from ..recordings.recording import Recording
from .both_ways import passed_both_ways
from .surfaces import CM_PER_M

Array = NDArray[np.float64]

MM_PER_CM = 10.0

Symbols = Sequence[tuple[str, float, str]]
"""Name of each constant, factor from the units of the fit to the shown unit, and that."""

Fitted = tuple[Array, Array]
"""Residual (n,) and derivatives (n, k) of the law by its values."""

SAMPLES_MOST = 20_000
"""Most samples that are fitted, evenly spaced."""

ROUNDING = float(np.finfo(float).eps)

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
class Samples:
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


def samples_of(recordings: Sequence[Recording]) -> Samples:
    """Return at most SAMPLES_MOST samples of recordings of one part; raises TirelabError where the surface changes."""
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
    return Samples(x / far, force / load, CM_PER_M * far, load, pressure, begins, each, both_ways)


def fit_of(name: str, symbols: Symbols, values: Array, fitted: Fitted, load: float) -> LawFit:
    """Return a law from its values in the units of the fit; load [N]: that of the force."""
    residual, derivatives = fitted
    n, k = residual.size, values.size
    squares = float(residual @ residual)
    # In units of their own: a coefficient of 1e5 beside an exponent would be cut off as if it were not seen at all.
    sizes = np.maximum(np.linalg.norm(derivatives, axis=0), 1e-300)
    _, seen, ways = np.linalg.svd(derivatives / sizes, full_matrices=False)
    told = seen > n * ROUNDING * seen.max(initial=0.0)
    scale = np.sqrt(squares / max(n - k, 1))
    spread = scale * np.linalg.norm(ways[told] / seen[told, None], axis=0) / sizes
    # A direction in which the force does not change leaves the constants that lie in it anywhere.
    spread[np.any(np.abs(ways[~told]) > np.sqrt(ROUNDING), axis=0)] = np.inf
    spread[sizes * np.maximum(np.abs(values), 1.0) <= UNSEEN * np.sqrt(squares)] = np.inf
    constants = tuple(
        (symbol, float(value * factor), float(abs(factor) * deviation), unit)
        for (symbol, factor, unit), value, deviation in zip(symbols, values, spread, strict=True)
    )
    return LawFit(name, constants, *left_of(load * residual, k))


def left_of(residual: Array, count: int) -> tuple[float, float]:
    """Return the root mean square of a residual [N], and the criterion of a law of so many constants."""
    mean, n = float(np.mean(residual**2)), residual.size
    return mean**0.5, n * float(np.log(max(mean, 1e-300))) + count * float(np.log(n))


def solved(columns: Sequence[Array], samples: Samples) -> tuple[Array, Fitted]:
    """Return the coefficients (k,) of least squares of columns (n,), and what they leave."""
    matrix = np.stack(columns, axis=1)
    values = np.asarray(np.linalg.lstsq(matrix, samples.force, rcond=None)[0], dtype=np.float64)
    return values, (samples.force - matrix @ values, matrix)


def powers(s: Samples, names: Sequence[str], first: int = 0) -> Symbols:
    """Return constants of successive powers of the deflection, from the one of the order `first` on."""
    units = ("N", "N/mm", "N/mm^2", "N/mm^3")
    return [(n, s.load / (MM_PER_CM * s.length) ** i, units[i]) for i, n in enumerate(names, first)]


def searched(law: Callable[[Array], Array], start: Array, s: Samples) -> tuple[Array, Fitted]:
    """Return the values of least squares from a start, by SciPy's trust region."""
    from scipy.optimize import least_squares

    found = least_squares(lambda v: law(v) - s.force, start, x_scale=np.maximum(np.abs(start), 0.1))
    return np.asarray(found.x), (s.force - law(found.x), np.asarray(found.jac))
