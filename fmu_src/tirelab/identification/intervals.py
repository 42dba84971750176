"""The profile of each constant: how far it can be moved before the fit becomes significantly worse.

    chi2(q) = sum over surfaces d_i' V_i^-1 d_i,   d_i = (A, B)_i of the form - (A, B)_i of the surface itself

One constant is held, all others are refitted, and the ends of its interval are where chi2 has risen by 9, three
standard uncertainties. An end that is never reached says that the surfaces do not determine the constant on that side;
the symmetric uncertainty of the joint fit cannot say so.

The least chi2 also shows whether the form follows the surfaces within their noise. Where it exceeds its degrees of
freedom, the form does not, and all uncertainties are widened by the root of the ratio (R. T. Birge, "The calculation
of errors by the method of least squares", Physical Review 40 (1932) 207).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares

from .forms import Form
from .noise import PowerFit

Array = NDArray[np.float64]

UNCERTAINTIES = 3.0
"""Number of standard uncertainties that an interval spans to either side."""

SPAN = np.log(1e3)
"""How far from its estimate a constant is moved: a factor of a thousand."""

EVALUATIONS_MOST = 100
"""Evaluations after which the refit of a constant far from its estimate is stopped."""

PRECISION = 1e-3
"""Precision of an interval's ends, relative to its half-width."""


@dataclass(frozen=True)
class Profile:
    """The form held against the A and B of the surfaces.

    intervals: lowest and highest logarithm of each constant (k, 2), infinite where no end was reached
    chi_square: at its least; freedom: its degrees of freedom
    """

    intervals: Array
    chi_square: float
    freedom: int

    @property
    def widening(self) -> float:
        """Factor on uncertainties (Birge ratio) where the form does not follow the surfaces within their noise."""
        return max(1.0, self.chi_square / self.freedom) ** 0.5 if self.freedom else 1.0


@dataclass(frozen=True)
class _Misfit:
    """chi2 as a function of what the form searches.

    roots: inverse triangular roots of the surfaces' covariances (n, 2, 2); pairs: their A and B (n, 2)
    scale: steps in which the logarithms are measured (k,)
    """

    form: Form
    roots: Array
    pairs: Array
    scale: Array

    def errors(self, logs: Array) -> Array:
        """Return the errors (2 n,) whose sum of squares is chi2."""
        found: Array = (
            self.roots @ (self.form.coefficients(self._inside(logs)) - self.pairs)[:, :, None]
        ).ravel()
        return found

    def derivatives(self, logs: Array) -> Array:
        """Return their derivatives (2 n, k)."""
        found: Array = (self.roots @ self.form.derivatives(self._inside(logs))).reshape(-1, logs.size)
        return found

    def least(self, logs: Array) -> tuple[float, Array]:
        """Return chi2 at its least, and where that is, starting from `logs`."""
        return self._solved(self.errors, logs, self.derivatives, self.scale)

    def least_at(self, k: int, value: float, start: Array) -> tuple[float, Array]:
        """Return chi2 at its least where the logarithm of constant k is `value`, and the other logarithms there."""
        row = self.form.combination()[k]
        others = np.arange(row.size) != k

        def whole(part: Array) -> Array:
            logs = np.empty(row.size)
            logs[others] = part
            logs[k] = value - row[others] @ part
            return logs

        def derivatives(part: Array) -> Array:
            full = self.derivatives(whole(part))
            found: Array = full[:, others] - np.outer(full[:, k], row[others])
            return found

        return self._solved(lambda part: self.errors(whole(part)), start, derivatives, self.scale[others])

    def _solved(
        self,
        errors: Callable[[Array], Array],
        start: Array,
        derivatives: Callable[[Array], Array],
        scale: Array,
    ) -> tuple[float, Array]:
        fit = least_squares(
            errors,
            start,
            derivatives,
            method="lm",
            x_scale=scale,
            ftol=1e-7,
            xtol=1e-7,
            max_nfev=EVALUATIONS_MOST,
        )
        return 2.0 * float(fit.cost), fit.x

    def _inside(self, logs: Array) -> Array:
        lower, upper = self.form.bounds
        found: Array = np.clip(logs, lower, upper)
        return found


def profile(
    form: Form,
    fits: Sequence[PowerFit],
    logs: Array,
    uncertainties: Array,
    progress: Callable[[], None] = lambda: None,
) -> Profile:
    """Return the profiles of all constants around the joint fit.

    logs: what the form searches (k,); uncertainties: of the logarithms of the constants (k,)
    """
    misfit = _Misfit(
        form,
        roots=np.stack([np.linalg.inv(np.linalg.cholesky(fit.covariance)) for fit in fits]),
        pairs=np.array([(fit.coefficient, fit.exponent) for fit in fits]),
        scale=np.where(np.isfinite(uncertainties) & (uncertainties > 0.0), uncertainties, 1.0),
    )
    least, best = misfit.least(logs)
    found = Profile(np.empty((logs.size, 2)), least, 2 * len(fits) - logs.size)
    height = least + (UNCERTAINTIES * found.widening) ** 2
    for k, centre in enumerate((form.combination() @ best).tolist()):
        first = UNCERTAINTIES * found.widening * misfit.scale[k]
        for side, sign in enumerate((-1.0, 1.0)):
            found.intervals[k, side] = centre + sign * _reach(
                partial(_height_at, misfit, k, centre, sign), np.delete(best, k), least, height, first
            )
        progress()
    return found


def _height_at(
    misfit: _Misfit, k: int, centre: float, sign: float, step: float, start: Array
) -> tuple[float, Array]:
    return misfit.least_at(k, centre + sign * step, start)


def _reach(
    height_at: Callable[[float, Array], tuple[float, Array]],
    start: Array,
    least: float,
    height: float,
    first: float,
) -> float:
    """Return the step from the constant's logarithm at which chi2 reaches `height`, or infinity.

    first: tried first; height_at: (step, start of the others) -> chi2 and the others there
    """
    near, step = 0.0, min(max(first, 1e-12), SPAN / 2.0)
    here, there = height_at(step, start)
    while here < height:
        if step >= SPAN:
            return np.inf
        near, step, start = step, min(2.0 * step, SPAN), there
        here, there = height_at(step, start)

    def above(at: float) -> float:
        """Return how far the root of chi2's rise, which is nearly straight, is above what is sought."""
        return float(max(height_at(at, start)[0] - least, 0.0) ** 0.5 - (height - least) ** 0.5)

    end: float = brentq(above, near, step, xtol=PRECISION * step)
    return end
