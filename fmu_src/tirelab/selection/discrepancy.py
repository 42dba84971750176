"""What a set of effects may leave of a recording beyond the noise, and what that costs.

A form that is not quite right leaves something smooth: over n blocks it has about e effective samples (e << n). In
units
of the noise each of them has the variance V = 1 + n tau^2 / e, with tau the root mean square of the discrepancy. What
the set leaves beyond the noise lies in these e samples, so with a residual of the sum of squares q

    2 ln p(V) = -(q - (n - e)) / V - e ln V,

highest at V = (q - (n - e)) / e: a set is priced by e ln(what it leaves). V is a number of every set, found by the
marginal likelihood. Below the floor no remainder is taken for a discrepancy of the form: a declared part of the misfit.

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
"""Effective samples of a discrepancy."""

GRID = 40
"""Variances that are tried."""


@dataclass(frozen=True)
class Discrepancy:
    """samples: n; effective: e; lowest: V at the floor, highest: V of the whole misfit."""

    samples: int
    effective: float
    lowest: float
    highest: float

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
        lowest = self.lowest + form_error**2 * self.samples / self.effective
        return replace(self, lowest=lowest, highest=max(self.highest, 2.0 * lowest))

    def grid(self) -> FloatArray:
        """Variances V to try, from the lowest to the highest."""
        return np.geomspace(self.lowest, self.highest, GRID)

    def profile(self, power: float) -> tuple[float, float]:
        """Return the log likelihood of a sum of squares left at its best V, and that V."""
        best = (power - (self.samples - self.effective)) / self.effective
        variance = min(max(best, self.lowest), self.highest)
        return self.likelihood(power, variance), variance

    def size(self, variance: float) -> float:
        """Return tau in units of the noise."""
        return math.sqrt(max(variance - 1.0, 0.0) * self.effective / self.samples)


def discrepancy_of(misfit: FloatArray, floor: float) -> Discrepancy:
    """Return the discrepancy's law for a misfit (n,) in units of the noise, and the part of it that is the floor."""
    n = misfit.size
    power = float(misfit @ misfit)
    effective = min(EFFECTIVE, n / 3.0)
    lowest = 1.0 + floor**2 * max(power - n, 0.0) / effective
    return Discrepancy(n, effective, lowest, max(2.0 * power / effective, 2.0 * lowest))


def usual_form_error() -> float:
    """Return the root mean square of all form errors: what a set may miss of a misfit before its effects are known."""
    return float(np.sqrt(np.mean([effect.form_error**2 for effect in CATALOGUE.values()])))
