"""Whether a point or comma that was read as decimal stands between thousands: 998, 1.002 and 1.006 are then 1006."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

THOUSAND = 1000.0

NEAR = 2.0
"""Ratio of neighbours, either way, below which one follows the other: between the two readings it is a thousand."""


def thousands_doubt(written: FloatArray) -> tuple[int, str] | None:
    """Return the first number of a column (n,) that may be a thousand times larger, and a sentence; None without doubt.

    A mark between thousands has three digits behind it, and numbers below a thousand have none. So the doubt needs
    whole numbers below a thousand, all others from 1 to a thousand in steps of a thousandth, and more neighbours, one
    of either kind, that follow each other if the mark is one between thousands than if it is decimal.
    """
    size = np.abs(written)
    whole = written == np.rint(written)
    if whole.all() or not whole.any() or not float(size[whole].max()) < THOUSAND:
        return None
    marked = size[~whole]
    if not (float(marked.min()) > 1.0 and float(marked.max()) < THOUSAND):
        return None
    if float(np.abs(THOUSAND * marked - np.rint(THOUSAND * marked)).max()) > 1e-6 * THOUSAND:
        return None
    changes = np.flatnonzero(whole[1:] != whole[:-1])
    pairs = np.stack([size[changes], size[changes + 1]])
    low, high = np.where(whole[changes], pairs, pairs[::-1])
    decimal, between = (_near(low, factor * high) for factor in (1.0, THOUSAND))
    if between.sum() <= decimal.sum():
        return None
    beside = changes[np.argmax(between)]
    first = int(beside) + int(whole[beside])
    other = int(beside) + int(not whole[beside])
    return first, (
        f"{written[first]:g} stands beside {written[other]:g}: is its mark one between thousands? Then write all "
        "numbers without it"
    )


def _near(one: FloatArray, other: FloatArray) -> NDArray[np.bool_]:
    return np.asarray((one < NEAR * other) & (other < NEAR * one))
