"""The power law F = A x^B and its tangent, with x in cm as the published constants have it.

Laws that take their coefficients from here:

- any tire on one surface: F = A x^B with constant A and B (class `PowerLaw`);
- Wang and Hull's off-road tire, F = A x^k with k = 1.4 averaged over three tires and A = 718.5 "in similar
  units" (x in cm), and Wang and Hull's road tire, linear with 150 000 N/m (A = 1500 N/cm, B = 1); both as
  quoted in Hull, Wang & Moore (1996), "An empirical model for determining the radial force-deflection
  behavior of off-road bicycle tires", Cycling Science, Spring 1996.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from .parameter import Parameter

CM_PER_M = 100.0


def force(deflection: float, coefficient: float, exponent: float) -> float:
    """Return the radial force [N] of a tire compressed by `deflection` [m].

    F = A x^B, x in cm; 0 for a tire that is not loaded (x <= 0).
    coefficient: A [N/cm^B] > 0; exponent: B [1] > 0.
    """
    if deflection <= 0.0:
        return 0.0
    result: float = coefficient * (CM_PER_M * deflection) ** exponent
    return result


def two_sided(deflection: float, coefficient: float, exponent: float) -> float:
    """Return the force [N] of a part that is held at both ends and pulls as it presses: A sign(x) |x|^B, x in cm."""
    if deflection < 0.0:
        return -force(-deflection, coefficient, exponent)
    return force(deflection, coefficient, exponent)


def stiffness(deflection: float, coefficient: float, exponent: float) -> float:
    """Return the tangent dF/dx [N/m] of `force` at `deflection` [m]: A B x^(B-1), 0 where the tire is not loaded."""
    if deflection <= 0.0:
        return 0.0
    result: float = coefficient * exponent * (CM_PER_M * deflection) ** (exponent - 1.0) * CM_PER_M
    return result


def on_surface(coefficient: float, exponent: float) -> Callable[[float], float]:
    """Return `force` with A and B held, as a function of the deflection [m] alone, which is quicker on one surface."""

    def force_at(deflection: float) -> float:
        return coefficient * (CM_PER_M * deflection) ** exponent if deflection > 0.0 else 0.0

    return force_at


@dataclass(frozen=True)
class PowerLaw:
    """F = A x^B with constant A and B on every surface: the law of a tire that was measured on one surface.

    coefficient: A [N/cm^B]; exponent: B [1].
    """

    coefficient: float = 718.5
    exponent: float = 1.4

    name: ClassVar[str] = "power_law"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("coefficient", "A", "N/cm^B", coefficient, 1e-12, 1e18, "force at 1 cm of deflection"),
        Parameter("exponent", "B", "1", exponent, 0.1, 10.0, "exponent of the deflection"),
    )

    def __post_init__(self) -> None:
        for parameter in self.parameters:
            parameter.checked(getattr(self, parameter.name))

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1]; `surface_radius` [m] has no influence."""
        return self.coefficient, self.exponent
