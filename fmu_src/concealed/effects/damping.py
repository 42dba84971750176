"""Viscous damping: linear, by a power of the rate, or saturating with the rate."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..motion import FloatArray
from .effect import Conditions, Contact, RateEffect


@dataclass(frozen=True)
class LinearDashpot(RateEffect):
    """F = c v, damping c [N s/m]."""

    name: ClassVar[str] = "viscous_damping"
    unit: ClassVar[str] = "N s/m"
    limit: ClassVar[float] = 6000.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "LinearDashpot":
        """Any damping; the size is set afterwards."""
        return cls(300.0)

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        return self.strength * contact.motion.rate * contact.touching


@dataclass(frozen=True)
class PowerDashpot(RateEffect):
    """F = c v_0 sgn(v) |v/v_0|^n, with the reference rate v_0 [m/s] and the exponent n [1]."""

    reference: float
    exponent: float

    name: ClassVar[str] = "viscous_damping"
    unit: ClassVar[str] = "N s/m"
    limit: ClassVar[float] = 6000.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "PowerDashpot":
        """Exponent between shear thinning and a throttle."""
        return cls(300.0, conditions.typical_rate, rng.uniform(0.75, 1.4))

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        ratio = contact.motion.rate / self.reference
        shape = np.sign(ratio) * np.abs(ratio) ** self.exponent
        return self.strength * self.reference * shape * contact.touching


@dataclass(frozen=True)
class SaturatingDashpot(RateEffect):
    """F = c v / (1 + (v/v_s)^2)^(1/2), linear up to about the rate v_s [m/s]."""

    saturation: float

    name: ClassVar[str] = "viscous_damping"
    unit: ClassVar[str] = "N s/m"
    limit: ClassVar[float] = 6000.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "SaturatingDashpot":
        """Saturating above one and a half to four times the typical rate."""
        return cls(300.0, conditions.typical_rate * rng.uniform(1.5, 4.0))

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        rate = contact.motion.rate
        return self.strength * rate / np.hypot(1.0, rate / self.saturation) * contact.touching
