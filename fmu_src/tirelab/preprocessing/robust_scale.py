"""The standard deviation of noise from medians, which few outliers do not move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MEDIAN_TO_SIGMA = 1.4826
"""Standard deviation of a normal law over its median absolute deviation, 1 / 0.67449."""

SPIKE_LIMIT = 4.5
"""Values beyond this many standard deviations are spikes: one in 150 000 of a normal law."""


def robust_sigma(values: NDArray[np.float64]) -> float:
    """Return the standard deviation of `values` about zero, from the median of their sizes; in their unit.

    P. J. Rousseeuw, C. Croux, "Alternatives to the Median Absolute Deviation", J. Am. Stat. Assoc. 88, 1993.
    """
    return MEDIAN_TO_SIGMA * float(np.median(np.abs(values)))
