"""Whether a recording is so long, or its samples so close, that its clock likely counts in another unit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from .origin import Origin

FloatArray = NDArray[np.float64]

CLOCKS = (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9))
"""Units of clocks with their size [s]."""

DAYS, DAY = "d", 86_400.0
"""The unit in which a spreadsheet keeps times, and its size [s]."""

YEAR_2001, YEAR_2096 = 1e9, 4e9
"""Seconds since 1970 [s]; a recording is not that long."""

YEAR = 3.15576e7
"""A recording is not longer [s]."""

FINEST = 5e-6
"""No test machine samples more often [s]; a tenth of a second in days is less."""


def likely_clock(time: FloatArray) -> str:
    """Return the unit of a clock: of one since 1970 by the date, else by its steps and its length."""
    first = float(time[np.isfinite(time)][0]) if np.isfinite(time).any() else 0.0
    dated = [unit for unit, size in CLOCKS if YEAR_2001 <= first * size <= YEAR_2096]
    if dated:
        return dated[0]
    with np.errstate(over="ignore", invalid="ignore"):
        step, length = float(np.nanmedian(np.diff(time))), float(np.nanmax(time) - np.nanmin(time))
    if 0.0 < step < FINEST:
        return DAYS
    likely = [unit for unit, size in CLOCKS[1:] if step >= 1e-3 / size and length > 3.6 / size]
    return likely[-1] if likely else "s"


def packed_clock(time: FloatArray) -> str:
    """Return a sentence where numbers are hours, minutes and seconds in one, 140559.9 and 140600.0, "" where not."""
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.diff(time)
        turns = np.flatnonzero(
            (time[:-1] % 100.0 >= 59.0) & (time[1:] % 100.0 < 1.0) & (steps > 40.0) & (steps < 42.0)
        )
        late = np.any((time % 100.0 >= 60.0) | (time % 10_000.0 >= 6000.0))
        if not turns.size or late or turns.size < np.count_nonzero(steps > 40.0):
            return ""
    at = int(turns[0])
    return (
        f"the time goes from {plain(time[at], 9)} to {plain(time[at + 1], 9)}, and to no seconds from 60 on: if these "
        "are hours, minutes and seconds in one number, write them as 14:05:59.9"
    )


def clock_doubt(origin: Origin, time: FloatArray, unit: str, size: float) -> str:
    """Return a sentence where times [s] read in a unit of that size [s] are those of no test, "" where they may be."""
    with np.errstate(over="ignore", invalid="ignore"):
        length, step, written = float(time[-1] - time[0]), float(np.median(np.diff(time))), time / size
    if YEAR < length < np.inf:
        said = f"the recording lasts {plain(length / YEAR, 3)} years"
    elif 0.0 < step < FINEST:
        said = f"the samples are {step:.3g} s apart"
    else:
        return packed_clock(written)
    alike = [name for name, _ in CLOCKS if name == unit.lower() != unit]
    other = alike[0] if alike else likely_clock(written)
    factor = {**dict(CLOCKS), DAYS: DAY}[other] / size
    if factor == 1.0:
        return f"{said}; check its unit ({unit})"
    would = f"{plain(step * factor, 3)} s apart over {plain(length * factor, 3)} s"
    return f"{said}; in {other} they would be {would}: {origin.units(time=other)}"
