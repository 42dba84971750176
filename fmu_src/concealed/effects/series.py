"""Series compliance: a wheel that yields, slightly stiffening."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..motion import FloatArray
from .effect import Conditions, Effect


@dataclass(frozen=True)
class YieldingWheel(Effect):
    """The wheel in series with the tire: F = k d (1 + d/d_h), so d = (sqrt(1 + 4 F/(k d_h)) - 1) d_h / 2.

    `strength` is the compliance 1/k [m/N]; hardening length d_h [m]. 2e6 N/m for a 32-spoke wheel, 1.5 to
    2.5e6 in later tests (Hopkins & Principe 1990, quoted in the article); a soft fixture adds to it.
    """

    hardening: float

    name: ClassVar[str] = "series_compliance"
    unit: ClassVar[str] = "m/N"
    limit: ClassVar[float] = 1.0 / 2.5e5
    elastic_only: ClassVar[bool] = True

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "YieldingWheel":
        """A wheel that stiffens by some percent over its travel."""
        return cls(1.0 / 1e6, rng.uniform(0.01, 0.04))

    def shortening(self, force: FloatArray) -> FloatArray:
        """Deflection of the wheel [m]."""
        load = self.strength * np.maximum(force, 0.0)
        return 0.5 * self.hardening * (np.sqrt(1.0 + 4.0 * load / self.hardening) - 1.0)
