"""Whether a law leaves more than the noise of the readings: then something else acts in the recordings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.spread import robust_sigma
from .surfaces import Surface

MISFIT = 1.5
"""A law misfits where it leaves this many times the noise of the readings: their error is known to a few percent."""

THIRD = 20.0**0.5
"""Root of the sum of squares of the weights 1, -3, 3, -1: the deviation of a third difference of white noise."""

SAMPLES_LEAST = 50
"""With fewer samples of a recording the noise is not taken from it."""


def reading_noise(surfaces: Sequence[Surface], pairs: NDArray[np.float64]) -> float:
    """Return the noise of the readings [N], root mean square over the recordings; NaN where they are too short.

    Third differences of successive errors F - A x^B leave noise alone: what the law misses changes little from one
    sample to the next. The noise of the deflection, passed on by the stiffness, is in it. pairs: A, B of each surface
    """
    squares, samples = 0.0, 0
    for surface, (coefficient, exponent) in zip(surfaces, pairs.tolist(), strict=True):
        for piece in surface.pieces:
            if piece.force.size < SAMPLES_LEAST:
                continue
            error = piece.force - coefficient * np.exp(exponent * piece.log_deflection)
            level = robust_sigma(np.diff(error, 3)) / THIRD
            squares += piece.force.size * level**2
            samples += piece.force.size
    return float(np.sqrt(squares / samples)) if samples else float("nan")


def misfit_sentence(rmse: float, noise: float, command: str, law: str = "the law", refused: str = "") -> str:
    """Return the sentence for a law that leaves more than the noise, both [N], "" where it does not.

    command: that looks for what is missing; law: what it is called; refused: why that command takes no such recordings
    """
    if not noise > 0.0 or rmse < MISFIT * noise:
        return ""
    step = f"but no diagnosis can say what: {refused}" if refused else f"try `{command}`"
    mark = ", " if refused else ": "
    return f"{law} leaves {rmse:.2g} N beside {noise:.2g} N of noise, so something else acts here{mark}{step}"
