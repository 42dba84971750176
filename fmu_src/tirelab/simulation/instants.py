"""What an effect may use at a sample, for all loops: it is compiled once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from radialtire.effect import Instant

FloatArray = NDArray[np.float64]


def instant(history: tuple[FloatArray, ...], i: int, part: tuple[bool, FloatArray]) -> Instant:
    """Return what an effect may use at sample `i`; history and part as in `kernel.respond_loop`."""
    (
        time,
        deflection,
        rates,
        accelerations,
        coefficient,
        exponent,
        elastic,
        curvature,
        pressure,
        temperature,
    ) = history
    return Instant(
        time[i] - time[0],
        time[i] - time[max(i - 1, 0)],
        i == 0,
        deflection[i],
        rates[i],
        accelerations[i],
        coefficient[i],
        exponent[i],
        elastic[i],
        curvature[i],
        pressure[i],
        temperature[i],
        part[0],
        part[1][i],
    )
