"""Mullins softening: pseudo-elastic damage, and damage that accumulates over the cycles."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.special import erf

from ..motion import BoolArray, FloatArray
from .effect import Conditions, Contact, Effect


@dataclass(frozen=True)
class OgdenRoxburgh(Effect):
    """Softer below the largest stored energy so far: eta = 1 - s erf((W_m - W)/(m + b W_m)).

    W integral of the elastic force [J] at the deflection, W_m its largest value so far; softening s [1],
    energy m [J], share b [1]. The first loading is left as it is.
    Source: Ogden & Roxburgh, Proc. R. Soc. A 455, 2861 (1999); b: Bose, Hurtado & Lapczyk (2004).
    """

    energy: float
    share: float

    name: ClassVar[str] = "mullins_softening"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.4

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "OgdenRoxburgh":
        """Energies of the size of the tire's own."""
        whole = 0.4 * conditions.strongest * conditions.deepest
        return cls(0.08, whole * rng.uniform(0.1, 0.4), rng.uniform(0.1, 0.6))

    def softening(self, contact: Contact) -> FloatArray:
        """Factor on the elastic force."""
        energy = 0.4 * contact.elastic * np.maximum(contact.deflection, 0.0)
        largest = np.maximum.accumulate(energy)
        lost = erf((largest - energy) / (self.energy + self.share * largest))
        return np.asarray(1.0 - self.strength * lost, dtype=np.float64)

    def active(self, contact: Contact) -> BoolArray:
        """Below the largest deflection so far."""
        return contact.deflection < np.maximum.accumulate(contact.deflection) - 1e-6


@dataclass(frozen=True)
class GatheringDamage(Effect):
    """Bonds break over the path below the largest deflection so far: F = F_e (1 - s D (1 - (x/x_max)^q)).

    Damage D = 1 - exp(-w/l), with the path length w [m] below x_max and its scale `way` l [m]; softening s [1], power
    q [1].
    """

    way: float
    power: float

    name: ClassVar[str] = "mullins_softening"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.4

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "GatheringDamage":
        """Accumulated within one or two cycles."""
        return cls(0.08, conditions.deepest * rng.uniform(0.3, 1.5), rng.uniform(2.0, 6.0))

    def softening(self, contact: Contact) -> FloatArray:
        """Factor on the elastic force."""
        x = np.maximum(contact.deflection, 0.0)
        largest = np.maximum(np.maximum.accumulate(x), 1e-9)
        below = np.abs(np.diff(x, prepend=x[0])) * (x < largest)
        damage = -np.expm1(-np.cumsum(below) / self.way)
        return 1.0 - self.strength * damage * (1.0 - (x / largest) ** self.power)

    def active(self, contact: Contact) -> BoolArray:
        """Below the largest deflection so far."""
        return contact.deflection < np.maximum.accumulate(contact.deflection) - 1e-6
