"""A force that no physics stands for: what a diagnosis could not explain, learned from recordings over one coordinate.

    F_r(c) = straight lines between F_i at c_i,   c_1 <= c <= c_n

Outside of the range c_1 to c_n in which it was learned it fades to nothing on a straight line, over FADE of the range.
It says nothing of other tires, pressures or motions, and is in a tire only where somebody asked for it.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

from . import power_law
from .curvature_law import CurvatureLaw
from .hull1996 import Hull1996
from .parameter import ParameterError
from .power_law import PowerLaw
from .recalibrated import Recalibrated

COORDINATES = {"deflection": "m", "rate": "m/s", "acceleration": "m/s^2", "force": "N"}
"""What it may be learned over, with units: the measured deflection, its rate and acceleration; the elastic force."""

FADE = 0.1
"""Part of the range over which it fades on either side."""


@dataclass(frozen=True)
class LearnedRemainder:
    """A learned force over one coordinate.

    by: one of COORDINATES; at: rising values of it; force: [N] at each; law: whose elastic force the coordinate "force"
    is, None for the others
    """

    by: str
    at: tuple[float, ...]
    force: tuple[float, ...]
    law: Hull1996 | PowerLaw | CurvatureLaw | Recalibrated | None = None

    def __post_init__(self) -> None:
        if self.by not in COORDINATES:
            raise ParameterError(
                f"learned_remainder over {self.by!r} is not allowed; it is one of {', '.join(COORDINATES)}"
            )
        if len(self.at) < 2 or len(self.at) != len(self.force):
            raise ParameterError("learned_remainder needs two points or more, and a force for each")
        if not all(map(math.isfinite, (*self.at, *self.force))):
            raise ParameterError("learned_remainder has a value that is no finite number")
        if any(later <= sooner for sooner, later in zip(self.at, self.at[1:], strict=False)):
            raise ParameterError("learned_remainder must have rising values of its coordinate")
        if (self.law is None) == (self.by == "force"):
            raise ParameterError(
                "learned_remainder over the force, and that alone, needs the law of that force"
            )

    @property
    def differentiates(self) -> bool:
        """Whether it uses rate or acceleration."""
        return self.by in ("rate", "acceleration")

    def added(self, deflection: float, surface_radius: float, rate: float, acceleration: float) -> float:
        """Return the force [N]: deflection [m], surface radius [m], rate [m/s], acceleration [m/s^2]."""
        if self.law is not None:
            return self.over(power_law.force(deflection, *self.law.coefficients(surface_radius)))
        return self.over({"deflection": deflection, "rate": rate, "acceleration": acceleration}[self.by])

    def over(self, value: float) -> float:
        """Return the force [N] at a value of the coordinate."""
        at, force = self.at, self.force
        width = FADE * (at[-1] - at[0])
        if value < at[0]:
            return force[0] * max(0.0, 1.0 - (at[0] - value) / width)
        if value >= at[-1]:
            return force[-1] * max(0.0, 1.0 - (value - at[-1]) / width)
        i = bisect_right(at, value)
        part = (value - at[i - 1]) / (at[i] - at[i - 1])
        return force[i - 1] + part * (force[i] - force[i - 1])

    def __str__(self) -> str:
        unit = COORDINATES[self.by]
        return (
            f"a learned remainder over the {self.by} (no physics), from {self.at[0]:.4g} to {self.at[-1]:.4g} {unit}; "
            "outside it fades to nothing"
        )
