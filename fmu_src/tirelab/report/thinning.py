"""Long series brought down to what a picture can show, so that a million samples draw as fast as a thousand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

COLUMNS = 800
"""Columns of a picture [pixels]: more than twice what a phone shows, about what a desktop does."""

LINE_COLUMNS = 400
"""Columns and rows of the grid on which a line that comes by again is not drawn again."""

LONGEST_LINE = 4000
"""Points of a line at most; a longer one is drawn as dots."""

SPARSE, MIDDLING = 1500, 20_000
"""Fewer samples than these are drawn as dots of 5, or of 3 pixels; more as single pixels."""

Limits = tuple[float, float]


def envelope(x: FloatArray, y: FloatArray, columns: int = COLUMNS) -> tuple[FloatArray, FloatArray]:
    """Return a line of at most 2 `columns` points that covers the same pixels as y over rising x.

    Every column of pixels keeps the smallest and the largest of its samples.
    """
    if x.size <= 2 * columns:
        return x, y
    column = ((x - x[0]) * (columns / (x[-1] - x[0]))).astype(np.intp)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(starts[1:], x.size) - 1
    extremes = np.stack([np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)], axis=1)
    return np.stack([x[starts], x[ends]], axis=1).ravel(), extremes.ravel()


def trail(x: FloatArray, y: FloatArray, across: Limits, up: Limits) -> tuple[FloatArray, FloatArray]:
    """Return the path (x, y) with every piece between two pixels once, and NaN where the pen is lifted."""
    cell = _pixels(x, across, LINE_COLUMNS) * 4 * LINE_COLUMNS + _pixels(y, up, LINE_COLUMNS)
    kept = np.flatnonzero(np.diff(cell, prepend=-1))
    if kept[-1] != x.size - 1:
        kept = np.append(kept, x.size - 1)
    cell = cell[kept]
    pieces = np.minimum(cell[1:], cell[:-1]) * (4 * LINE_COLUMNS) ** 2 + np.maximum(cell[1:], cell[:-1])
    first = np.zeros(pieces.size, dtype=bool)
    first[np.unique(pieces, return_index=True)[1]] = True
    used = np.append(first, False) | np.append(False, first)
    lifted = used & np.append(~first, False)  # a point that no drawn piece leaves
    order = np.repeat(np.flatnonzero(used), 1 + lifted[used])
    pen_up = np.append(np.diff(order) == 0, False)
    pen_up = np.append(False, pen_up[:-1])
    path = np.stack([x[kept][order], y[kept][order]])
    path[:, pen_up] = np.nan
    return path[0], path[1]


def occupancy(
    x: FloatArray, y: FloatArray, across: Limits, up: Limits, shape: tuple[int, int], wide: int = 0
) -> NDArray[np.uint8]:
    """Return which pixels (rows, columns) of a picture the points fall on, 0 to 255, the first row lowest.

    wide: pixels by which a dot is wider than the number of points asks for
    """
    # here, since it takes half a second that a picture of lines does not need
    from scipy.ndimage import maximum_filter

    rows, columns = shape
    across_at, up_at = _pixels(x, across, columns), _pixels(y, up, rows)
    inside = (across_at >= 0) & (across_at < columns) & (up_at >= 0) & (up_at < rows)
    hits = np.bincount(up_at[inside] * columns + across_at[inside], minlength=rows * columns)
    hit = hits.reshape(rows, columns) > 0
    width = wide + (5 if x.size <= SPARSE else 3 if x.size <= MIDDLING else 1)
    hit = maximum_filter(hit, size=width)
    return np.where(hit, 255, 0).astype(np.uint8)


def _pixels(values: FloatArray, limits: Limits, count: int) -> NDArray[np.intp]:
    low, high = limits
    scaled = (values - low) * (count / (high - low))
    # Far outside is as good as just outside, and does not overflow.
    return np.floor(np.clip(scaled, -1.0, count + 1.0)).astype(np.intp)
