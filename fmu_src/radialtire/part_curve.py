"""The force of a part over its own deflection, point by point: of one that no power law follows.

    F(x) = straight lines between F_i at x_i,   F_1 below x_1 and F_n above x_n

Detents, a magnet, a snap-through rise and fall with the deflection. F(x) - F(0) is a spring, beside the power law and
acted on as that is: it relaxes, softens and loads what rubs. F(0) is a pretension or the zero of a load cell, as the
part's preload is.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

from .parameter import ParameterError


@dataclass(frozen=True)
class PartCurve:
    """at: rising deflections [m], two or more; force: [N] at each. Raises ParameterError otherwise."""

    at: tuple[float, ...]
    force: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.at) < 2 or len(self.at) != len(self.force):
            raise ParameterError("curve needs two points or more, and a force for each")
        if not all(map(math.isfinite, (*self.at, *self.force))):
            raise ParameterError("curve has a value that is no finite number")
        if any(later <= sooner for sooner, later in zip(self.at, self.at[1:], strict=False)):
            raise ParameterError("curve must have rising deflections")

    def over(self, deflection: float) -> float:
        """Return the force [N] at a deflection [m]."""
        at, force = self.at, self.force
        if deflection <= at[0]:
            return force[0]
        if deflection >= at[-1]:
            return force[-1]
        i = bisect_right(at, deflection)
        part = (deflection - at[i - 1]) / (at[i] - at[i - 1])
        return force[i - 1] + part * (force[i] - force[i - 1])

    def beyond_zero(self, deflection: float) -> float:
        """Return by how much the force [N] at a deflection [m] is more than without one."""
        return self.over(deflection) - self.over(0.0)
