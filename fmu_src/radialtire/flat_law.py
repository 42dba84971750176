"""Any law on one flat row of numbers, as the native FMU has it.

    q = [which law, its parameters (LAW_VALUES places), number of tables, (number of surfaces, radius, a, b, ...), ...]

A table changes the law below it as `recalibrated` says. The functions are those of the laws themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from . import curvature_law, hull1996, recalibrated
from .curvature_law import CurvatureLaw
from .hull1996 import Hull1996
from .power_law import PowerLaw
from .recalibrated import Recalibrated

if TYPE_CHECKING:
    from .model import Law

HULL1996, POWER_LAW, CURVATURE_LAW = 0.0, 1.0, 2.0
"""First number of q."""

LAW_VALUES = 18
"""Places for the parameters of a law: the most that one has."""

TABLES = 1 + LAW_VALUES
"""Index of the number of tables."""


def coefficients(q: Sequence[float], surface_radius: float) -> tuple[float, float]:
    """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]."""
    if q[0] == HULL1996:
        law = hull1996.coefficients(tuple(q[1:11]), surface_radius)  # type: ignore[arg-type]
    elif q[0] == POWER_LAW:
        law = q[1], q[2]
    else:
        law = curvature_law.coefficients(tuple(q[1:19]), surface_radius)
    at = TABLES + 1
    for _ in range(int(q[TABLES])):
        count = int(q[at])
        law = recalibrated.changed(law[0], law[1], recalibrated.changes(q, at + 1, count, surface_radius))
        at += 1 + 3 * count
    return law


def laid_out(law: Law) -> list[float]:
    """Return the row of a law; its parameters begin at index 1. Raises TypeError for a law without a row."""
    tables: list[float] = []
    number = 0
    while isinstance(law, Recalibrated):
        rows = [float(value) for surface in law.surfaces for value in surface]
        tables = [float(len(law.surfaces)), *rows, *tables]
        number += 1
        law = law.base
    kinds = {Hull1996: HULL1996, PowerLaw: POWER_LAW, CurvatureLaw: CURVATURE_LAW}
    if type(law) not in kinds:
        raise TypeError(f"the law {law.name} has no flat row")
    values = [float(getattr(law, parameter.name)) for parameter in law.parameters]
    return [kinds[type(law)], *values, *[0.0] * (LAW_VALUES - len(values)), float(number), *tables]
