"""A law whose coefficients were refitted on some surfaces, and interpolated between those.

    A(R) = A0(R) exp(a(R)),   B(R) = B0(R) + b(R)

A0 and B0 are those of the baseline law; a and b are given on the measured surfaces, interpolated linearly over the
curvature 1/R between them, and constant beyond them. A law that is wrong on one surface is wrong in much the same way
on the next one: Hull, Wang & Moore (1996) state errors of up to 13.5 % on convex surfaces, 4.2 % on concave.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Protocol

from .hull1996 import FLAT_RADIUS, Hull1996
from .parameter import Parameter, ParameterError


class BaseLaw(Protocol):
    """A law with coefficients of its own."""

    name: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]."""
        ...


@dataclass(frozen=True)
class Recalibrated:
    """The law `base` with its coefficients changed on measured surfaces.

    surfaces: of each one its radius [m] (convex > 0, concave < 0, flat = inf), a [1] and b [1]; radii distinct, at
    least one. Raises ParameterError otherwise.
    """

    base: BaseLaw = Hull1996()
    surfaces: tuple[tuple[float, float, float], ...] = ((float("inf"), 0.0, 0.0),)

    name: ClassVar[str] = "recalibrated"
    parameters: ClassVar[tuple[Parameter, ...]] = ()

    def __post_init__(self) -> None:
        bends = [_curvature(radius) for radius, _, _ in self.surfaces]
        if not bends or len(set(bends)) < len(bends):
            raise ParameterError("a recalibrated law needs one entry for each of one or more surfaces")
        for radius, change, exponent in self.surfaces:
            if not (abs(change) <= 100.0 and abs(exponent) <= 5.0):
                raise ParameterError(
                    f"the change of the law at the radius {radius:g} m, {change:g} and {exponent:g}, is not allowed; "
                    "they must lie between -100 and 100, and between -5 and 5"
                )
        ordered = tuple(sorted(self.surfaces, key=lambda s: _curvature(s[0])))
        object.__setattr__(self, "surfaces", ordered)

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]."""
        A, B = self.base.coefficients(surface_radius)
        return changed(A, B, self.changes(surface_radius))

    def changes(self, surface_radius: float) -> tuple[float, float]:
        """Return a and b on a surface of radius `surface_radius` [m]."""
        return changes(self._table, 0, len(self.surfaces), surface_radius)

    @cached_property
    def _table(self) -> tuple[float, ...]:
        """Radius, a and b of every surface, by rising curvature."""
        return tuple(number for surface in self.surfaces for number in surface)


def changed(A: float, B: float, by: tuple[float, float]) -> tuple[float, float]:
    """Return A exp(a) and B + b, but no exponent below 0.05."""
    a, b = by
    return A * math.exp(a), max(B + b, 0.05)


def changed_at(deflection: float, factor: float, exponent: float) -> tuple[float, float]:
    """Return a and b of a law whose force at a `deflection` [m] is multiplied by exp(factor), and B changed by b."""
    return factor - exponent * math.log(100.0 * deflection), exponent


def changes(q: Sequence[float], at: int, count: int, surface_radius: float) -> tuple[float, float]:
    """Return a and b on a surface of radius `surface_radius` [m].

    q: from its index `at` on radius, a and b of `count` surfaces, by rising curvature
    """
    here = _curvature(surface_radius)
    below, a0, b0 = _curvature(q[at]), q[at + 1], q[at + 2]
    for i in range(count):
        above, a1, b1 = _curvature(q[at + 3 * i]), q[at + 3 * i + 1], q[at + 3 * i + 2]
        if here <= above:
            width = above - below
            part = (here - below) / width if width > 0.0 else 1.0
            part = max(part, 0.0)
            return a0 + part * (a1 - a0), b0 + part * (b1 - b0)
        below, a0, b0 = above, a1, b1
    return a0, b0


def _curvature(radius: float) -> float:
    return 0.0 if abs(radius) >= FLAT_RADIUS else 1.0 / radius
