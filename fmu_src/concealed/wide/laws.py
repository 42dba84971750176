"""Elastic laws that are no power of the deflection: a polynomial, an exponential, two slopes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..motion import FloatArray
from ..tires import PowerTire, Tire, distinct

#: Deflection [m] at which every law has the force of the article's law.
MATCHED = 0.02


@dataclass(frozen=True)
class PolynomialTire:
    """F = c (x + q x^2 + k x^3), x in units of 2 cm; as strong on every surface as `like` at 2 cm."""

    like: PowerTire
    quadratic: float
    cubic: float

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Elastic radial force [N]."""
        ratio = np.maximum(deflection, 0.0) / MATCHED
        shape = ratio * (1.0 + ratio * (self.quadratic + ratio * self.cubic))
        return shape / (1.0 + self.quadratic + self.cubic) * _matched(self.like, radius) * pressure_ratio


@dataclass(frozen=True)
class ExponentialTire:
    """F = c (exp(x/l) - 1), stiffening length l [m]; as strong on every surface as `like` at 2 cm."""

    like: PowerTire
    length: float

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Elastic radial force [N]."""
        shape = np.expm1(np.maximum(deflection, 0.0) / self.length) / np.expm1(MATCHED / self.length)
        return np.asarray(shape * _matched(self.like, radius) * pressure_ratio)


@dataclass(frozen=True)
class TwoSlopeTire:
    """Two straight lines: stiffness 1 up to the knee x_k [m], `second` above it, rounded over 1 mm."""

    like: PowerTire
    knee: float
    second: float

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Elastic radial force [N]."""
        shape = self._shape(np.maximum(deflection, 0.0)) / self._shape(np.array([MATCHED]))[0]
        return np.asarray(shape * _matched(self.like, radius) * pressure_ratio)

    def _shape(self, x: FloatArray) -> FloatArray:
        soft = 1e-3
        bend = np.logaddexp(0.0, (x - self.knee) / soft) - np.logaddexp(0.0, -self.knee / soft)
        return np.asarray(x + (self.second - 1.0) * soft * bend)


@dataclass(frozen=True)
class BentTire:
    """A tire whose law is bent on each surface: F exp(a + b ln x + c (ln x)^2), x in cm.

    The rig fits it where a set of effects holds another law than the baseline's.
    """

    tire: Tire
    radii: tuple[float, ...]
    bends: tuple[tuple[float, float, float], ...]

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Elastic radial force [N]."""
        force = self.tire.force(deflection, radius, pressure_ratio)
        log = np.log(np.maximum(100.0 * deflection, 1e-3))
        for r, (level, exponent, curvature) in zip(self.radii, self.bends, strict=True):
            here = radius == r
            force[here] *= np.exp(level + log[here] * (exponent + curvature * log[here]))
        return force


def drawn_law(rng: np.random.Generator, like: PowerTire) -> Tire:
    """Draw a law that is no power of x."""
    laws: Sequence[Callable[[], Tire]] = (
        lambda: PolynomialTire(like, rng.uniform(0.3, 2.0), rng.uniform(-0.1, 0.6)),
        lambda: ExponentialTire(like, MATCHED * rng.uniform(0.5, 1.5)),
        lambda: TwoSlopeTire(like, MATCHED * rng.uniform(0.25, 0.6), rng.uniform(1.5, 2.5)),
    )
    return laws[int(rng.integers(len(laws)))]()


def _matched(like: PowerTire, radius: FloatArray) -> FloatArray:
    matched = np.zeros_like(radius)
    for r in distinct(radius):
        matched[radius == r] = like.at(r).force(np.array([MATCHED]))[0]
    return matched
