"""Even times that a file holds rounded: whole milliseconds where samples are 3.33 ms apart, or times of five digits.

Between rounded times a motion seems to go faster and slower from sample to sample, which no gauge's noise explains.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from .samples import COARSE

FloatArray = NDArray[np.float64]

EVEN = 1e-3
"""Part of the shortest step by which the steps of even times may differ: a motion is then read as if they did not."""

FEWEST = 10
"""Fewest times that show whether they are even: each but two of them could refute it."""

LOST = 1e-3
"""Step of single precision [s] from which times that all are the same are likely to have lost theirs by it."""

DIGITS = 16
"""Decimal digits of a double."""

MOST_CUTS = 50
"""Most times that a line is fitted anew to all times which the last one missed most; a handful is usual."""


def evened(written: FloatArray, number: NDArray[np.intp]) -> FloatArray | None:
    """Return the even times that were rounded to those written, in their unit; None where there are none, or where
    they are even as written.

    number: of the row that each was read from, from which times may be missing

    Rounded to q, even times have steps of two lengths, q apart. Each time then is within half its own last digit of one
    line over the number: a clock that is not even leaves it, unless it does so by less than that digit.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        each = np.diff(written) / np.maximum(np.abs(np.diff(number)), 1)
        step = float(each.min()) if each.size else 0.0
        unit = float(np.ptp(np.diff(written))) if np.ptp(each) > EVEN * step else 0.0
    if written.size < FEWEST or not (step > 0.0 and 0.0 < unit < np.inf):
        return None
    rounding = _last_digits(written, unit)
    rows = np.abs(number - number[0])
    for numbers in (rows,) if rows[-1] == rows.size - 1 else (rows, np.arange(rows.size)):
        line = _line_within(written, 0.5 * rounding, numbers / numbers[-1])
        if line is not None:
            return np.asarray(line - (line[0] - written[0]))
    return None


def lost_in_single(written: FloatArray, size: float) -> float:
    """Return the step [s] between numbers of single precision as large as the times written, where these stand still
    for want of smaller ones; 0 where they do not.

    size [s]: of the unit in which the times are written
    """
    with np.errstate(over="ignore", invalid="ignore"):
        steps, single = np.diff(written), written.astype(np.float32)
    if not np.count_nonzero(steps == 0.0) > COARSE * steps.size:
        return 0.0
    if not np.array_equal(single, written):
        return 0.0
    least, most = (float(np.spacing(np.abs(end(single)))) for end in (np.min, np.max))
    moved = steps[steps > 0.0]
    lost = least <= float(moved.min()) <= most if moved.size else most * size >= LOST
    return most * size if lost else 0.0


def _last_digits(written: FloatArray, most: float) -> FloatArray:
    """Return the unit (n,) of the last decimal digit of each time: the largest power of ten of which it is a multiple,
    `most` at most, a power or not.
    """
    found = np.full(written.size, np.inf)
    error = 4.0 * np.spacing(float(np.abs(written).max()))
    top = int(np.floor(np.log10(most) + 1e-6))
    for power in range(top, top - DIGITS, -1):
        size = 10.0**power
        whole = np.abs(written - np.rint(written / size) * size) <= error
        found = np.where(np.isinf(found) & whole, size, found)
        if np.isfinite(found).all():
            break
    return np.asarray(np.minimum(found, most))


def _line_within(written: FloatArray, most: FloatArray, place: FloatArray) -> FloatArray | None:
    """Return the line (n,) over `place`, 0 to 1, that is nowhere farther than `most` (n,) from what is written, and as
    near as possible in units of it; None without one.
    """
    slope, begin = np.polyfit(place, written, 1)
    line: FloatArray = slope * place + begin
    cuts: list[int] = []
    unit = float(most.max())
    for _ in range(MOST_CUTS):
        far = np.abs(written - line) / most
        worst = [int(np.argmax(far * side)) for side in (written > line, written < line)]
        if all(i in cuts for i in worst):
            break
        cuts += worst
        ones, at = np.ones(len(cuts)), place[cuts]
        own, off = most[cuts] / unit, (written - (slope * place + begin))[cuts] / unit
        above, below = np.column_stack([ones, at, -own]), np.column_stack([-ones, -at, -own])
        found = linprog(
            [0.0, 0.0, 1.0], np.concatenate([above, below]), np.append(off, -off), bounds=(None, None)
        )
        if found.status != 0 or found.x[2] > 1.0 + 1e-6:
            return None
        line = (slope + unit * found.x[1]) * place + begin + unit * found.x[0]
    return line if float((np.abs(written - line) / most).max()) <= 1.0 + 1e-6 else None
