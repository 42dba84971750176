"""What a set of effects may leave of a recording beyond the noise, and what that costs.

A form that is not quite right leaves something smooth: over n blocks it has about e effective samples (e << n). In
units
of the noise each of them has the variance V = 1 + n tau^2 / e, with tau the root mean square of the discrepancy. What
the set leaves beyond the noise lies in these e samples, so with a residual of the sum of squares q

    2 ln p(V) = -(q - (n - e)) / V - e ln V,

highest at V = (q - (n - e)) / e: a set is priced by e ln(what it leaves). V is a number of every set, found by the
marginal likelihood. Below the floor, which follows from the measured errors of the forms, one remainder is like another
and says nothing for a set; but forms may also be exact, and a set that leaves a remainder like the noise where the
floor is far above it has them: wrong forms do not meet there by chance.

M. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63, 425 (2001); J. Brynjarsdottir, A. O'Hagan, Inverse Problems 30 (2014).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE

FloatArray = NDArray[np.float64]

EFFECTIVE = 30.0
"""Effective samples of a discrepancy. What is left of recorded dampers has 30 to 60 by its autocorrelation, of pistons
100 to 200; more than 30 let many a set win over a simpler one."""

LIKE_NOISE = 1.0
"""Root mean square of a remainder like the noise, in units of it: forms that leave no more are taken for exact."""

GRID = 40
"""Variances that are tried."""


@dataclass(frozen=True)
class Discrepancy:
    """samples: n; effective: e; lowest: V at the floor, highest: V of the whole misfit
    exact: V of a remainder like the noise; below a higher floor it is allowed all the same.
    """

    samples: int
    effective: float
    lowest: float
    highest: float
    exact: float = math.inf

    def beside(self, variance: FloatArray) -> FloatArray:
        """Return what the log likelihood holds beside -q / 2V, for several V."""
        e = self.effective
        return np.asarray(0.5 * (self.samples - e) / variance - 0.5 * e * np.log(variance))

    def likelihood(self, power: float, variance: float) -> float:
        """Return the log likelihood of a sum of squares left at one V."""
        e = self.effective
        return -0.5 * (power - (self.samples - e)) / variance - 0.5 * e * math.log(variance)

    def above(self, form_error: float) -> Discrepancy:
        """Return the discrepancy of a set whose forms may always miss this much, a root mean square in units of the
        noise.
        """
        lowest = self.lowest + self._of(form_error)
        return replace(self, lowest=lowest, highest=max(self.highest, 2.0 * lowest))

    def blurred(self, error: float) -> Discrepancy:
        """Return the discrepancy where the reading adds this much whatever the forms are, in units of the noise."""
        return replace(self.above(error), exact=self.exact + self._of(error))

    def grid(self) -> FloatArray:
        """Variances V to try: from the lowest to the highest, and what is below them."""
        grid = np.geomspace(self.lowest, self.highest, GRID)
        return np.append(grid, self.exact) if self.exact < self.lowest else grid

    def profile(self, power: float) -> tuple[float, float]:
        """Return the log likelihood of a sum of squares left at its best V, and that V."""
        best = (power - (self.samples - self.effective)) / self.effective
        tried = {min(max(best, self.lowest), self.highest), min(self.exact, self.lowest)}
        return max((self.likelihood(power, variance), variance) for variance in tried)

    def size(self, variance: float) -> float:
        """Return tau in units of the noise."""
        return math.sqrt(max(variance - 1.0, 0.0) * self.effective / self.samples)

    def _of(self, error: float) -> float:
        """Return what a root mean square in units of the noise adds to V."""
        return error**2 * self.samples / self.effective


def discrepancy_of(misfit: FloatArray, floor: float) -> Discrepancy:
    """Return the discrepancy's law for a misfit (n,) in units of the noise, and the part of it that is the floor."""
    n = misfit.size
    power = float(misfit @ misfit)
    effective = min(EFFECTIVE, n / 3.0)
    lowest = 1.0 + floor**2 * max(power - n, 0.0) / effective
    highest = max(2.0 * power / effective, 2.0 * lowest)
    return Discrepancy(n, effective, lowest, highest, 1.0 + LIKE_NOISE**2 * n / effective)


def usual_form_error() -> float:
    """Return the root mean square of all form errors: what a set may miss of a misfit before its effects are known."""
    return float(np.sqrt(np.mean([effect.form_error**2 for effect in CATALOGUE.values()])))
