"""A law of straight lines along the curve of a part, or through the middle of its loop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from .both_ways import loop_state
from .law_fit import MM_PER_CM, Array, LawFit, Samples, fit_of, left_of, solved
from .surfaces import CM_PER_M

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


@dataclass(frozen=True)
class _Lines:
    """Straight lines alone, in `fit`, and the criterion and the error [N] of them together with a loop, if there is."""

    fit: LawFit
    criterion: float
    left: float

    def show_a_loop_beside(self, left: float) -> bool:
        """Whether the loop is seen by samples of both ways, and not in a hold alone: it is most of what lines without
        one leave, `left` [N], or else not larger than that.
        """
        return 2.0 * self.left**2 < left**2 or 0.5 * self.fit.rmse**2 < left**2


def piecewise(s: Samples) -> LawFit:
    """Return the straight lines of the least criterion: through all samples, or through the middle of a loop."""
    few = [n for n in LINES if n == LINES[0] or SAMPLES_OF_LINE * n <= s.x.size]
    found = [_lines(s, n, None) for n in few]
    best = min(found, key=lambda lines: lines.criterion)
    if s.both_ways:
        # At a turn the two ways meet: lines through all samples follow the way in there, and the middle elsewhere.
        state = _loop_state(s, len(best.fit.at) - 1)
        beside = (_lines(s, n, state) for n in few)
        found = [best, *(lines for lines in beside if lines.show_a_loop_beside(best.fit.rmse))]
    return min(found, key=lambda lines: lines.criterion).fit


def _loop_state(s: Samples, count: int) -> Array:
    """Return the state (n,) of the loop beside which so many lines have the least criterion."""
    span = float(np.ptp(s.x))

    def state(reach: float) -> Array:
        return np.concatenate([loop_state(x, np.exp(reach) * span) for x in s.each])

    def criterion(reach: float) -> float:
        return _lines(s, count, state(reach)).criterion

    tried = np.log(REACHES)
    best = int(np.argmin([criterion(reach) for reach in tried.tolist()]))
    near = tried[max(best - 1, 0)], tried[min(best + 1, tried.size - 1)]
    found = minimize_scalar(criterion, bounds=near, method="bounded", options={"xatol": REACH_KNOWN})
    return state(float(found.x))


def _lines(s: Samples, count: int, state: Array | None) -> _Lines:
    """Return straight lines, beside the loop of a state (n,) if one is given."""
    knots = _knots(s, count)
    hats, n = _hats(s.x, knots), knots.size
    values, (residual, matrix) = solved(hats, s)
    lines, share = np.stack(hats, axis=1), 0.0
    for u in [] if state is None else [state] * PASSES:
        # Gauss and Newton: the last column changes the share b of the loop, whose product with the lines is no column.
        in_proportion = [hat * (1.0 + share * u) for hat in hats]
        values, (residual, matrix) = solved([*in_proportion, u, u * (lines @ values[:n])], s)
        share += float(values[-1])
    digits = 3 if count == LINES[0] else 9  # so that near ones have different symbols
    places = s.length * knots
    units = [(f"F({MM_PER_CM * place:.{digits}g} mm)", s.load, "N") for place in places]
    at = tuple((places / CM_PER_M).tolist())
    loop = (("a", s.load, "N"), ("b", 1.0, "1"))[: values.size - n]
    both = fit_of("piecewise", [*units, *loop], values, (residual, matrix), s.load)
    left, criterion = left_of(s.load * (s.force - lines @ values[:n]), n)
    fit = LawFit(both.name, both.constants[:n], left, criterion, at, state is not None)
    return _Lines(fit, both.bic, both.rmse)


def _hats(x: Array, knots: Array) -> list[Array]:
    """Return for each knot the function (n,) that is 1 there, 0 at the others, and straight between."""
    return [np.interp(x, knots, hat) for hat in np.eye(knots.size)]


def _knots(s: Samples, count: int) -> Array:
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
