"""F = A x^B with A and B interpolated over the surface's curvature: the law of a tire measured on a few surfaces.

    A(k), B(k) piecewise linear in k = 1/R between the surfaces measured, constant beyond the outermost ones

R is the surface's radius: convex k > 0, flat k = 0, concave k < 0. No form is presumed between the surfaces, and
nothing is extrapolated: two to six surfaces hardly determine more. The power law itself is equation 2 of Hull, Wang &
Moore (1996), Cycling Science, Spring 1996; their own functions of R are the module `hull1996`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

from .hull1996 import FLAT_COEFFICIENT, FLAT_EXPONENT, FLAT_RADIUS
from .parameter import Parameter, ParameterError

SURFACES_MAX = 6
"""Number of surfaces that the law can hold."""


def _parameters() -> tuple[Parameter, ...]:
    found: list[Parameter] = []
    for i in range(1, SURFACES_MAX + 1):
        start = FLAT_COEFFICIENT if i == 1 else 0.0
        unused = "" if i == 1 else "; 0 leaves the surface out"
        lowest = 1e-12 if i == 1 else 0.0
        found += [
            Parameter(f"curvature_{i}", f"k{i}", "1/m", 0.0, -1e4, 1e4, f"1/R of surface {i}, rising with i"),
            Parameter(
                f"coefficient_{i}", f"A{i}", "N/cm^B", start, lowest, 1e18, f"A on surface {i}{unused}"
            ),
            Parameter(f"exponent_{i}", f"B{i}", "1", FLAT_EXPONENT, 0.1, 10.0, f"B on surface {i}"),
        ]
    return tuple(found)


def coefficients(slots: Sequence[float], surface_radius: float) -> tuple[float, float]:
    """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m].

    slots: curvature, A and B of every surface, by rising curvature; one whose A is 0 is left out, but not the first
    """
    curvature = 0.0 if abs(surface_radius) >= FLAT_RADIUS else 1.0 / surface_radius
    k0, A0, B0 = slots[0], slots[1], slots[2]
    if curvature <= k0:
        return A0, B0
    for i in range(1, SURFACES_MAX):
        k1, A1, B1 = slots[3 * i], slots[3 * i + 1], slots[3 * i + 2]
        if A1 > 0.0:
            if curvature <= k1:
                part = (curvature - k0) / (k1 - k0)
                return A0 + part * (A1 - A0), B0 + part * (B1 - B0)
            k0, A0, B0 = k1, A1, B1
    return A0, B0


@dataclass(frozen=True)
class CurvatureLaw:
    """Up to six surfaces, each with its curvature [1/m], A [N/cm^B] and B [1].

    A surface whose coefficient is 0 is left out; the others stand in the order of rising curvature. Raises
    ParameterError where they do not, or where a value is outside its bounds.
    """

    curvature_1: float = 0.0
    coefficient_1: float = FLAT_COEFFICIENT
    exponent_1: float = FLAT_EXPONENT
    curvature_2: float = 0.0
    coefficient_2: float = 0.0
    exponent_2: float = FLAT_EXPONENT
    curvature_3: float = 0.0
    coefficient_3: float = 0.0
    exponent_3: float = FLAT_EXPONENT
    curvature_4: float = 0.0
    coefficient_4: float = 0.0
    exponent_4: float = FLAT_EXPONENT
    curvature_5: float = 0.0
    coefficient_5: float = 0.0
    exponent_5: float = FLAT_EXPONENT
    curvature_6: float = 0.0
    coefficient_6: float = 0.0
    exponent_6: float = FLAT_EXPONENT

    name: ClassVar[str] = "curvature_law"
    parameters: ClassVar[tuple[Parameter, ...]] = _parameters()

    def __post_init__(self) -> None:
        for parameter in self.parameters:
            parameter.checked(getattr(self, parameter.name))
        curvatures = [k for k, _, _ in self.surfaces]
        for lower, upper in pairwise(curvatures):
            if not lower < upper:
                raise ParameterError(
                    f"the surfaces' curvatures must rise, but {upper:g} 1/m follows {lower:g} 1/m; put them in order"
                )

    @classmethod
    def through(cls, surfaces: Sequence[tuple[float, float, float]]) -> CurvatureLaw:
        """Return the law through `surfaces`: curvature [1/m], A [N/cm^B] and B [1] of each, in any order."""
        if not 1 <= len(surfaces) <= SURFACES_MAX:
            raise ParameterError(
                f"{len(surfaces)} surfaces are not allowed; the law holds 1 to {SURFACES_MAX} of them"
            )
        values: dict[str, float] = {}
        for i, (curvature, coefficient, exponent) in enumerate(sorted(surfaces), start=1):
            values |= {
                f"curvature_{i}": curvature,
                f"coefficient_{i}": coefficient,
                f"exponent_{i}": exponent,
            }
        return cls(**values)

    @cached_property
    def surfaces(self) -> tuple[tuple[float, float, float], ...]:
        """Curvature [1/m], A [N/cm^B] and B [1] of every surface that is not left out."""
        slots = self._slots
        return tuple(
            (k, A, B) for k, A, B in zip(slots[0::3], slots[1::3], slots[2::3], strict=True) if A > 0.0
        )

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]: convex > 0, concave < 0."""
        return coefficients(self._slots, surface_radius)

    @cached_property
    def _slots(self) -> tuple[float, ...]:
        """The parameters in their order."""
        return tuple(float(getattr(self, parameter.name)) for parameter in self.parameters)
