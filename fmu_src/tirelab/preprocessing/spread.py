"""The standard deviation of noise from the bulk of its values: outliers do not count."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm

MEDIAN_TO_SIGMA = 1.4826
"""Standard deviation of a normal law over its median absolute deviation, 1 / 0.67449."""


def robust_sigma(values: NDArray[np.float64]) -> float:
    """Return the standard deviation of `values` about zero, from the median of their sizes; in their unit.

    P. J. Rousseeuw, C. Croux, "Alternatives to the Median Absolute Deviation", J. Am. Stat. Assoc. 88, 1993.
    """
    return MEDIAN_TO_SIGMA * float(np.median(np.abs(values)))


TRIMMED = 3.0
"""Standard deviations beyond which values are left out; the result is corrected for the 0.3 % of a normal law there."""

FIRST_QUANTILE = 0.8
"""Quantile of the absolute values from which the trimming starts: the median of coarse steps is often 0."""


def trimmed_sigma(values: NDArray[np.float64]) -> float:
    """Return the standard deviation of `values` about zero, from those within three of it; in their unit.

    The variance of this estimate is about half of that from the median. It also holds for rounded values, whose median
    is 0 or a whole step.
    """
    sizes = np.abs(values)
    sigma = float(np.quantile(sizes, FIRST_QUANTILE) / norm.ppf(0.5 + 0.5 * FIRST_QUANTILE))
    within = norm.cdf(TRIMMED) - norm.cdf(-TRIMMED)
    kept = 1.0 - 2.0 * TRIMMED * norm.pdf(TRIMMED) / within
    for _ in range(100):
        near = sizes[sizes <= TRIMMED * sigma]
        again = float(np.sqrt(np.mean(near**2) / kept))
        if abs(again - sigma) <= 1e-6 * sigma:
            break
        sigma = again
    return sigma
