"""A and B of one surface by least squares of the force, loading and unloading weighted alike.

    minimise  sum w (F - A x^B)^2

A is eliminated: at a given B its best value is linear, so only B is searched (variable projection). Everything that a
step needs of the samples is in one 3 x 3 matrix of inner products, which is gathered in a single pass through them, in
chunks that stay in the processor's cache; the samples are never copied.

References: Hull, Wang & Moore, Cycling Science, Spring 1996, section Methods (lowest RMSE for each radius); G. Golub &
V. Pereyra, "Separable nonlinear least squares: the variable projection method", Inverse Problems 19 (2003) R1.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..errors import TirelabError
from .surfaces import Piece, Surface

CHUNK = 16384
"""Samples taken together: three rows of them fit into the second-level cache."""

EXPONENT_BOUNDS = (0.1, 10.0)
"""Exponents looked at; the bounds of the tire file's power law."""

EXPONENT_STARTS = np.geomspace(0.2, 5.0, 40)

THINNED = 500
"""Samples of each recording on which the starts are compared."""

STEPS = 100
"""Most steps of the exponent."""

PRECISION, PRECISION_LEAST = 1e-12, 1e-6
"""Step of the exponent after which there is no other, and the largest last step of a fit that has come to its end."""


def inner_products(surface: Surface, coefficient: float, exponent: float) -> NDArray[np.float64]:
    """Return the weighted inner products (3, 3) of x^B, x^B ln x and the error F - A x^B over all samples."""
    total = np.zeros((3, 3))
    rows, weighted = np.empty((3, CHUNK)), np.empty((3, CHUNK))
    for piece in surface.pieces:
        for chunk in chunks(piece):
            x = piece.log_deflection[chunk]
            m, w = rows[:, : x.size], weighted[:, : x.size]
            np.multiply(x, exponent, out=m[0])
            np.exp(m[0], out=m[0])
            np.multiply(m[0], x, out=m[1])
            np.multiply(m[0], -coefficient, out=m[2])
            m[2] += piece.force[chunk]
            np.multiply(m, surface.weights[piece.branch[chunk]], out=w)
            total += w @ m.T
    return total


def chunks(piece: Piece) -> Iterator[slice]:
    """Yield the slices of CHUNK samples that make up `piece`."""
    for first in range(0, piece.force.size, CHUNK):
        yield slice(first, first + CHUNK)


def fit_power(surface: Surface) -> tuple[float, float]:
    """Return A [N/cm^B] and B [1] of least RMSE; raises TirelabError where no power law fits."""
    exponent = _start(surface)
    coefficient, best, step = 0.0, np.inf, 0.0
    for _ in range(STEPS):
        (pp, pl, pr), (_, ll, lr), (_, _, rr) = inner_products(surface, coefficient, exponent)
        squares = rr - pr * pr / pp
        if squares > best * (1.0 + 1e-9) and abs(step) > 1e-8:
            step *= 0.5
            exponent -= step
            continue
        best = squares
        coefficient += pr / pp
        curvature = coefficient * (ll - pl * pl / pp)
        if not curvature > 0.0:
            step = np.inf
            break
        step = (lr - pl * pr / pp) / curvature
        if abs(step) < PRECISION:
            break
        limited = float(np.clip(exponent + step, *EXPONENT_BOUNDS))
        if limited == exponent:
            break
        step, exponent = limited - exponent, limited
        coefficient -= step * coefficient * pl / pp
    if abs(step) < PRECISION_LEAST and coefficient > 0.0:
        return float(coefficient), float(exponent)
    raise TirelabError(
        f"{surface.where}: the force does not grow as a power of the deflection between {EXPONENT_BOUNDS[0]:g} and "
        f"{EXPONENT_BOUNDS[1]:g}; check which columns are deflection and force, and their zeros; for a spring, a "
        "damper or a bush, --part compare finds its law"
    )


def _start(surface: Surface) -> float:
    """Return the best of EXPONENT_STARTS on thinned samples: no logarithm of a noisy force is taken."""
    fits = np.zeros((2, EXPONENT_STARTS.size))
    for piece in surface.pieces:
        thin = slice(None, None, max(1, piece.force.size // THINNED))
        weight = surface.weights[piece.branch[thin]]
        power = np.exp(np.outer(EXPONENT_STARTS, piece.log_deflection[thin]))
        fits[0] += power**2 @ weight
        fits[1] += power @ (weight * piece.force[thin])
    return float(EXPONENT_STARTS[int(np.argmax(fits[1] / np.sqrt(fits[0])))])
