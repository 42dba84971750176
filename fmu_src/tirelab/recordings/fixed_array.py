"""Arrays that stay as they were when a recording checked them: read-only, in memory that nobody writes to."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def fixed(values: ArrayLike) -> FloatArray:
    """Return a read-only array of values; those that can be written to, here or where they come from, are copied."""
    array: FloatArray = np.asarray(values, dtype=np.float64)
    converted = array is not values and array.base is None  # then NumPy made a copy
    view: FloatArray = fix(array if converted or _is_fixed(array) else array.copy()).view()
    return view


def fix(array: FloatArray) -> FloatArray:
    """Return an array of the caller's own, which nobody else writes to, made read-only with the memory it is in."""
    array.flags.writeable = False
    if isinstance(array.base, np.ndarray):
        array.base.flags.writeable = False
    return array


def _is_fixed(array: FloatArray) -> bool:
    """Whether an array is read-only, and the one that it is a part of too."""
    whole = array if array.base is None else array.base
    return not array.flags.writeable and isinstance(whole, np.ndarray) and not whole.flags.writeable
