"""Bottoming: the tire meets the rim, gradually."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..motion import BoolArray, FloatArray, Motion
from .effect import Conditions, Contact, Effect, Region


@dataclass(frozen=True)
class _Rim(Effect):
    """A stiff stop beyond an onset x_b, soft within a distance s [m]; `strength` k [N/m] is its stiffness."""

    onset: float
    soft: float

    name: ClassVar[str] = "bottoming"
    unit: ClassVar[str] = "N/m"
    limit: ClassVar[float] = 4e6
    elastic_only: ClassVar[bool] = True

    def active(self, contact: Contact) -> BoolArray:
        """Beyond the onset."""
        return contact.deflection > self.onset

    def regions(self, motion: Motion) -> list[Region]:
        """From the onset on."""
        return [Region("deflection", self.onset, None, "m")]


@dataclass(frozen=True)
class QuadraticRim(_Rim):
    """F = k (x - x_b)^2 / (2 s) up to x_b + s, from there a spring k: stiffness grows linearly over s."""

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "QuadraticRim":
        """Reached by a few percent up to a fifth of the samples."""
        return cls(1e5, rim_onset(rng, conditions), conditions.deepest * rng.uniform(0.01, 0.04))

    def parallel(self, contact: Contact) -> FloatArray:
        """Force of the stop [N]."""
        deep = np.maximum(contact.deflection - self.onset, 0.0)
        soft = np.minimum(deep, self.soft)
        share: FloatArray = 0.5 * soft**2 / self.soft + (deep - soft)
        return self.strength * share


@dataclass(frozen=True)
class SoftplusRim(_Rim):
    """F = k s ln(1 + exp((x - x_b)/s)) less that at x = 0."""

    @classmethod
    def drawn(cls, rng: np.random.Generator, conditions: Conditions) -> "SoftplusRim":
        """Reached by a few percent up to a fifth of the samples."""
        return cls(1e5, rim_onset(rng, conditions), conditions.deepest * rng.uniform(0.005, 0.02))

    def parallel(self, contact: Contact) -> FloatArray:
        """Force of the stop [N]."""
        at_zero = np.logaddexp(0.0, -self.onset / self.soft)
        bent = np.logaddexp(0.0, (contact.deflection - self.onset) / self.soft)
        return np.asarray(self.strength * self.soft * (bent - at_zero), dtype=np.float64)


def rim_onset(rng: np.random.Generator, conditions: Conditions) -> float:
    """A deflection [m] that 3 to 20 % of the samples exceed, at most 97 % of the deepest."""
    return min(conditions.deflection_quantile(1.0 - rng.uniform(0.03, 0.2)), 0.97 * conditions.deepest)
