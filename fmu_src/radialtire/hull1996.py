"""Radial force of an off-road bicycle tire on curved ground (Hull, Wang & Moore 1996).

    F = A x^B                                            (2)
    A = C0 - D0 exp(-E0 Rb)   convex, Rb > 0             (3a, 5a)
    A = C1 + D1 exp(+E1 Rb)   concave, Rb < 0            (3b, 5b)
    B = C2 - D2 exp(-E2 Rb)   convex, Rb > 0             (4a, 6a)
    B = C3 + D3 exp(+E3 Rb)   concave, Rb < 0            (4b, 6b)

F [N], x [cm] the deflection, Rb [cm] the surface's radius of curvature. C1 = C0 and C3 = C2: flat ground is the
common limit. Measured on a Specialized Ground Control/S 26 x 1.95 in at 50 psi, on 14 surfaces from 1.27 cm convex
to 38.1 cm concave, up to 3.175 cm of deflection and 2240 N.

Departures from the print, each with its evidence:

- 5a prints `e(-2519*Rb)`. Read as E0 = 0.2519 /cm, the digits as printed with the decimal point that 5b, 6a and 6b
  lost in the same way. SECOND_READING has E0 = 0.02519 /cm, which the article's own figures support: its
  2.3e4 N/m on the 1.27 cm bump is 2.36e4 N/m with 0.02519 (secant at 1.27 cm) and at least 3.2e4 with 0.2519; its
  193 N at Rb = 25.4 cm, x = 2.53 cm, "bounded by 13.5 %", is 13.9 % with 0.02519 and 9.4 % with 0.2519; and the
  contact patch of a 33 cm wheel on a 25.4 cm bump makes it about 0.66 as stiff as on flat ground: 0.677 against 0.999.
- 6a prints `e(-01651*Rb)`: read as E2 = 0.1651 /cm; 5b prints `0.l398`: a letter l for the digit 1.
- 4b prints `C3 + D3(E3*Rb)`: without its `e`, which 6b has.
- "34.7 kPa (50 psi)": 50 psi is 344.7 kPa; the digit 4 was lost.
- Equation 1 gives x in metres; in 2 it is in cm: 22 N of preload is then 1.04 mm, the article's "1 mm".

Reference: M. L. Hull, E. L. Wang, D. F. Moore, "An empirical model for determining the radial force-deflection
behavior of off-road bicycle tires", Cycling Science, Spring 1996.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from .parameter import Parameter, ParameterError

FLAT_RADIUS = 1e5
"""Surfaces of this radius [m] and more, of either sign, count as flat."""

WHEEL_RADIUS = 0.33
"""Unloaded radius [m] of the tested wheel: 26 in with its tire."""

CONVEX_RADIUS_RANGE = (0.0127, 0.584)
"""Smallest and largest convex radius tested [m]."""

CONCAVE_RADIUS_RANGE = (-0.584, -0.381)
"""Largest and smallest concave radius tested [m]."""

DEFLECTION_MAX = 0.03175
"""Largest deflection tested [m]."""

FORCE_MAX = 2240.0
"""Force below which every test was kept [N]."""

PRINTED_READING = 0.2519
"""E0 [1/cm] with the digits as printed."""

SECOND_READING = 0.02519
"""E0 [1/cm] which the article's own figures support."""


FLAT_COEFFICIENT, FLAT_EXPONENT = 550.9, 1.422
"""C0 = C1 [N/cm^B] and C2 = C3 [1]: A and B on flat ground."""

Constants = tuple[float, float, float, float, float, float, float, float, float, float]
"""C0 = C1, D0, E0, D1, E1 of A; C2 = C3, D2, E2, D3, E3 of B; E [1/cm]."""


def coefficients(constants: Constants, surface_radius: float) -> tuple[float, float]:
    """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]; see `Hull1996.coefficients`."""
    C0, D0, E0, D1, E1, C2, D2, E2, D3, E3 = constants
    if abs(surface_radius) >= FLAT_RADIUS:
        return C0, C2
    Rb = 100.0 * surface_radius
    if Rb > 0.0:
        A = C0 - D0 * math.exp(-E0 * Rb)  # 5a
        B = C2 - D2 * math.exp(-E2 * Rb)  # 6a
    else:
        A = C0 + D1 * math.exp(E1 * Rb)  # 5b
        B = C2 + D3 * math.exp(E3 * Rb)  # 6b
    return A, B


@dataclass(frozen=True)
class Hull1996:
    """The article's law with its constants (5a to 6b); raises ParameterError outside their bounds."""

    flat_coefficient: float = FLAT_COEFFICIENT
    convex_coefficient_drop: float = 337.8
    convex_coefficient_decay: float = PRINTED_READING
    concave_coefficient_rise: float = 7822.0
    concave_coefficient_decay: float = 0.1398
    flat_exponent: float = FLAT_EXPONENT
    convex_exponent_drop: float = 0.2469
    convex_exponent_decay: float = 0.1651
    concave_exponent_rise: float = 0.2128
    concave_exponent_decay: float = 0.0289

    name: ClassVar[str] = "hull1996"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("flat_coefficient", "C0, C1", "N/cm^B", flat_coefficient, 1e-3, 1e6, "A on flat ground"),
        Parameter(
            "convex_coefficient_drop",
            "D0",
            "N/cm^B",
            convex_coefficient_drop,
            0.0,
            1e6,
            "loss of A on a sharp edge",
        ),
        Parameter(
            "convex_coefficient_decay",
            "E0",
            "1/cm",
            convex_coefficient_decay,
            0.0,
            100.0,
            "rate at which A recovers with the bump's radius; printed as -2519, 0.02519 is the second reading",
        ),
        Parameter(
            "concave_coefficient_rise",
            "D1",
            "N/cm^B",
            concave_coefficient_rise,
            0.0,
            1e9,
            "gain of A extrapolated to Rb = 0",
        ),
        Parameter(
            "concave_coefficient_decay",
            "E1",
            "1/cm",
            concave_coefficient_decay,
            0.0,
            100.0,
            "rate at which the gain of A fades with the dip's radius",
        ),
        Parameter("flat_exponent", "C2, C3", "1", flat_exponent, 0.1, 10.0, "B on flat ground"),
        Parameter(
            "convex_exponent_drop", "D2", "1", convex_exponent_drop, 0.0, 10.0, "loss of B on a sharp edge"
        ),
        Parameter(
            "convex_exponent_decay",
            "E2",
            "1/cm",
            convex_exponent_decay,
            0.0,
            100.0,
            "rate at which B recovers with the bump's radius",
        ),
        Parameter(
            "concave_exponent_rise",
            "D3",
            "1",
            concave_exponent_rise,
            0.0,
            10.0,
            "gain of B extrapolated to Rb = 0",
        ),
        Parameter(
            "concave_exponent_decay",
            "E3",
            "1/cm",
            concave_exponent_decay,
            0.0,
            100.0,
            "rate at which the gain of B fades with the dip's radius",
        ),
    )

    def __post_init__(self) -> None:
        for parameter in self.parameters:
            parameter.checked(getattr(self, parameter.name))
        if self.convex_coefficient_drop >= self.flat_coefficient:
            raise ParameterError(
                f"convex_coefficient_drop = {self.convex_coefficient_drop:g} is not allowed; it must be less than "
                f"flat_coefficient = {self.flat_coefficient:g}, or A is negative on sharp bumps"
            )
        if self.convex_exponent_drop >= self.flat_exponent:
            raise ParameterError(
                f"convex_exponent_drop = {self.convex_exponent_drop:g} is not allowed; it must be less than "
                f"flat_exponent = {self.flat_exponent:g}, or B is negative on sharp bumps"
            )

    @cached_property
    def _constants(self) -> Constants:
        """The constants in the order of `coefficients`."""
        return (
            self.flat_coefficient,
            self.convex_coefficient_drop,
            self.convex_coefficient_decay,
            self.concave_coefficient_rise,
            self.concave_coefficient_decay,
            self.flat_exponent,
            self.convex_exponent_drop,
            self.convex_exponent_decay,
            self.concave_exponent_rise,
            self.concave_exponent_decay,
        )

    def coefficients(self, surface_radius: float) -> tuple[float, float]:
        """Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m].

        Convex > 0, concave < 0, flat = infinite or of magnitude FLAT_RADIUS and more; 0 and NaN are the caller's
        to refuse.
        """
        return coefficients(self._constants, surface_radius)
