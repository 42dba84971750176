"""Readings that a logger writes into several rows, because the gauge gives new ones more seldom than rows are written.

The rows between hold the last reading while the other gauge goes on: beside a moving deflection they are a force of
next to no noise that lags, and the wrong physics. A gauge that reads in coarse steps repeats its readings too, but goes
on by one step; a drive that rests between steps holds its deflection, but the force jumps with it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

FEWEST = 20
"""New readings at least."""

ALIKE, MOST_ALIKE, STEPS = 0.02, 0.5, 2
"""Changes that differ by less than the first part of the usual one are alike. More than the second part of the changes
of a gauge that reads in coarse steps are so many different ones: one step, or two."""

REGULAR = 0.9
"""Part of the readings that are held for the usual number of rows, or a multiple of it, within one row."""

JUMPS = 2.0
"""What moves this many times as far at a change of the other as between two changes moves with it."""


def held_readings(deflection: FloatArray, force: FloatArray) -> tuple[str, int, IntArray]:
    """Return the channel that is held, the usual number of rows of one reading, and the rows (k,) that only repeat it;
    "", 1 and none where both are read in every row. deflection, force: (n,)

    Where both are held, it is the one that is read more seldom.
    """
    channels = {"deflection": (deflection, force), "force": (force, deflection)}
    found = {name: _rows_of_reading(*pair) for name, pair in channels.items()}
    name = max(found, key=found.__getitem__)
    rows = found[name]
    return (
        (name, rows, _repeats(channels[name][0], rows)) if rows > 1 else ("", 1, np.empty(0, dtype=np.intp))
    )


def _rows_of_reading(own: FloatArray, other: FloatArray) -> int:
    """Return the usual number of rows for which a channel holds a reading, 1 where it holds none."""
    new = np.flatnonzero(own[1:] != own[:-1]) + 1
    if new.size < FEWEST or 2 * new.size > own.size:
        return 1
    lengths = np.diff(new)
    rows = int(np.median(lengths))
    if rows < 2 or np.mean(np.abs(lengths - rows * _readings(lengths, rows)) <= 1) < REGULAR:
        return 1
    with np.errstate(all="ignore"):  # a damaged number may be any
        changes = np.abs(own[new] - own[new - 1])
        sizes = np.sort(np.unique(np.rint(changes / (ALIKE * np.median(changes))), return_counts=True)[1])
        moved = np.abs(np.diff(other))
        between = np.delete(moved, new - 1)
        along = np.mean(moved[new - 1]) > JUMPS * np.mean(between)
    return 1 if along or np.sum(sizes[-STEPS:]) > MOST_ALIKE * new.size else rows


def _repeats(values: FloatArray, rows: int) -> IntArray:
    """Return the rows that repeat a reading; one that is held for several times the usual number was read as often."""
    begin = np.concatenate([[0], np.flatnonzero(values[1:] != values[:-1]) + 1])
    lengths = np.diff(np.append(begin, values.size))
    place = np.arange(values.size) - np.repeat(begin, lengths)
    last = np.repeat(rows * (_readings(lengths, rows) - 1), lengths)
    return np.flatnonzero((place % rows != 0) | (place > last))


def _readings(lengths: IntArray, rows: int) -> IntArray:
    """Return how many readings of so many rows there are in runs of these lengths, one at least."""
    return np.maximum(np.rint(lengths / rows).astype(np.intp), 1)
