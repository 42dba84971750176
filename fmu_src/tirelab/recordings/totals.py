"""A force that is the sum of others: two load cells below a plate, and the column of both."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from .channels import UNIT_OF, unit_of_column
from .formats import Header, RecordingError, Table, Wanted
from .formats.table import listed, quoted
from .matching import recognised
from .other_columns import counts_rows, is_measured
from .units import measures

FloatArray = NDArray[np.float64]

FEWEST, MOST = 3, 8
"""How many forces a table has at least, and at most, for a sum to be looked for."""

LOOKED_AT = 1000
"""Rows on which a sum is tried before all are reckoned."""

MOST_DIGITS = 9
"""Decimals from which on numbers are not rounded, so far as their sum goes."""

EXACTLY = 5e-5
"""Part of the largest force by which a sum of numbers of five or six digits may differ from it."""

LARGER = 10.0
"""Each addend goes its own way by so many times what rounding can do; else it would not show in the sum."""


@dataclass(frozen=True)
class Total:
    """The column that is the sum of others, and these."""

    column: int
    addends: tuple[int, ...]

    def note(self, headers: Sequence[Header]) -> str:
        """Return what is said of it."""
        parts = listed([quoted(headers[i].text) for i in self.addends])
        return f"force taken from {quoted(headers[self.column].text)}: it is the sum of {parts}"


def total_force(table: Table) -> Total | None:
    """Return the force of a table that is the sum of two or more others in its unit, None without one, or of several.

    Where no column states a unit of force, these others are called forces: `F1`, `F2` beside `F_total`. All rows are
    read, of a table with three such columns or more alone.
    """
    headers = table.headers
    units = {
        i: unit_of_column(header, "force") for i, header in enumerate(headers) if is_measured(header.name)
    }
    forces = [i for i, unit in units.items() if unit and measures(unit, UNIT_OF["force"])]
    named = forces
    if not forces:
        forces = [i for i, unit in units.items() if unit is None and not counts_rows(headers[i].name)]
        named = [i for i in forces if "force" in recognised([headers[i]], {})]
    if not FEWEST <= len(forces) <= MOST or len(named) < 2 or len({units[i] for i in forces}) > 1:
        return None
    try:
        read = table.read([Wanted(i, "force") for i in forces]).values
    except RecordingError:
        return None
    known = np.all(np.isfinite(read), axis=0)
    total = sum_among({i: column[known] for i, column in zip(forces, read, strict=True)})
    return total if total is not None and set(total.addends) <= set(named) else None


def sum_among(columns: Mapping[int, FloatArray]) -> Total | None:
    """Return the one column that is the sum of others within rounding: of as many as there are."""
    moving = {i: column for i, column in columns.items() if column.size and np.ptp(column) > 0.0}
    step = 1 + next((column.size for column in moving.values()), 0) // LOOKED_AT
    some = {i: column[::step] for i, column in moving.items()}
    for count in range(len(moving) - 1, 1, -1):
        found = [
            Total(i, addends)
            for i in moving
            for addends in combinations([j for j in moving if j != i], count)
            if _is_sum(some[i], [some[j] for j in addends])
            and _is_sum(moving[i], [moving[j] for j in addends])
        ]
        if found:
            return found[0] if len({total.column for total in found}) == 1 else None
    return None


def _is_sum(total: FloatArray, addends: Sequence[FloatArray]) -> bool:
    """Return whether numbers are the sum of others, each of them rounded to its own last digit."""
    off = float(np.max(np.abs(total - np.sum(addends, axis=0))))
    allowed = 0.5 * sum(_last_digit(column) for column in (total, *addends))
    allowed += EXACTLY * float(np.max(np.abs(total)))
    return off <= allowed and all(_goes_its_own_way(column, total) > LARGER * allowed for column in addends)


def _goes_its_own_way(column: FloatArray, total: FloatArray) -> float:
    """Return how far a column moves beside what is proportional to another one: 2 F and F are no parts of 3 F."""
    return float(np.ptp(column - total * float(np.dot(column, total) / np.dot(total, total))))


def _last_digit(column: FloatArray) -> float:
    """Return the size of the last decimal that any of the numbers has; 0 where they are not rounded."""
    for digits in range(MOST_DIGITS):
        if np.array_equal(np.round(column, digits), column):
            return float(10.0**-digits)
    return 0.0
