"""A drift that is even, or over after a while, as that of a cell, an amplifier or a gauge that warms up."""

import math

EVEN = 1e-9
"""k t up to which (1 - exp(-k t)) / k is t, to the last digits."""


def drift_time(time: float, settling: float) -> float:
    """Return (1 - exp(-k t)) / k [s]: the time that a drift would take at its first rate.

    Parameters: time t >= 0 [s], settling k >= 0 [1/s]. Exact limit t for k = 0.
    """
    settled = settling * time
    if settled <= EVEN:
        return time
    return -time * math.expm1(-settled) / settled
