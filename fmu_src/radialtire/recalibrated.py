"""A law whose coefficients were refitted on some surfaces, and interpolated between those.

    A(R) = A0(R) exp(a(R)),   B(R) = B0(R) + b(R)

A0 and B0 are those of the baseline law; a and b are given on the measured surfaces, interpolated linearly over the
curvature 1/R between them, and constant beyond them. A law that is wrong on one surface is wrong in much the same way
on the next one: Hull, Wang & Moore (1996) state errors of up to 13.5 % on convex surfaces, 4.2 % on concave.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
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
            if not (abs(change) <= 5.0 and abs(exponent) <= 5.0):
                raise ParameterError(
                    f"the change of the law at the radius {radius:g} m, {change:g} and {exponent:g}, is not allowed; "
                    "both must lie between -5 and 5"
                )
        ordered = tuple(sorted(self.surfaces, key=lambda s: _curvature(s[0])))
        object.__setattr__(self, "surfaces", ordered)

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]."""
        A, B = self.base.coefficients(surface_radius)
        change, exponent = self.changes(surface_radius)
        return A * math.exp(change), max(B + exponent, 0.05)

    def changes(self, surface_radius: float) -> tuple[float, float]:
        """Return a and b on a surface of radius `surface_radius` [m]."""
        here = _curvature(surface_radius)
        below = self.surfaces[0]
        for above in self.surfaces:
            if here <= _curvature(above[0]):
                width = _curvature(above[0]) - _curvature(below[0])
                part = (here - _curvature(below[0])) / width if width > 0.0 else 1.0
                part = max(part, 0.0)
                return below[1] + part * (above[1] - below[1]), below[2] + part * (above[2] - below[2])
            below = above
        return below[1], below[2]


def _curvature(radius: float) -> float:
    return 0.0 if abs(radius) >= FLAT_RADIUS else 1.0 / radius
