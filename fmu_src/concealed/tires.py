"""Tires of the rig: power laws that deviate from the article's, and a contact patch of their own."""

import math
from collections.abc import Sequence
from dataclasses import Field, dataclass
from functools import lru_cache
from typing import Any, ClassVar, Protocol

import numpy as np
from scipy.interpolate import PPoly, make_interp_spline

from . import article
from .motion import FloatArray

#: Inflation pressure (gauge) of the article's test, 50 psi [Pa]; outside of the tire, 1 atm [Pa].
INFLATION = 344.7e3
AMBIENT = 101.3e3
#: Deepest deflection for which a tire is tabulated [m].
TABULATED_DEPTH = 0.045


@dataclass(frozen=True)
class Surface:
    """F = A x^B on one surface: radius [m], a [N/cm^b], b [1]."""

    radius: float
    a: float
    b: float

    def force(self, deflection: FloatArray) -> FloatArray:
        """Radial force [N] at a deflection [m]."""
        return self.a * np.maximum(100.0 * deflection, 0.0) ** self.b


@dataclass(frozen=True)
class PowerTire:
    """F = A(R) x^B(R), with A and B interpolated over the curvature 1/R between listed surfaces.

    Pressure multiplies the whole force: a bicycle tire has next to no stiffness without it (the article).
    """

    surfaces: tuple[Surface, ...]

    def at(self, radius: float) -> Surface:
        """The law on a surface, listed or between listed ones."""
        listed = {s.radius: s for s in self.surfaces}
        if radius in listed:
            return listed[radius]
        order = sorted(self.surfaces, key=lambda s: 1.0 / s.radius)
        bends = [1.0 / s.radius for s in order]
        a = np.interp(1.0 / radius, bends, [s.a for s in order])
        b = np.interp(1.0 / radius, bends, [s.b for s in order])
        return Surface(radius, float(a), float(b))

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Elastic radial force [N]."""
        result = np.zeros_like(deflection)
        for r in distinct(radius):
            here = radius == r
            result[here] = self.at(r).force(deflection[here])
        return result * pressure_ratio


@dataclass(frozen=True)
class ContactPatchTire:
    """Pressure times contact area, plus a casing that is bent and stretched.

    At the arc length s from the middle of the contact the surface stands h(s) = x - s^2 k / 2 deep in the
    wheel, with the relative curvature k = 1/a + 1/(R + c) (convex) or 1/a - 1/(|R| + c) (concave); the casing
    flattens there over the width w(h) = w_max (1 - exp(-q h / w_max)). Hence
    F = p integral w(h(s)) ds + m (1 + l k_flat / k) x^2.
    wheel a [m], conformity c [m] (the casing bridges sharp bumps), width w_max [m], flattening q [1],
    pressure p [Pa], casing m [N/m^2], wrap l [1].
    Source: parabolic contact of two curved bodies; the exponent 3/2 at small x is that of the thin toroid,
    Renart & Roura-Grabulosa, Am. J. Phys. 87, 102 (2019).
    """

    pressure: float
    wheel: float
    conformity: float
    width: float
    flattening: float
    casing: float
    wrap: float

    def curvature(self, radius: float) -> float:
        """Relative curvature of wheel and surface [1/m]."""
        own = 1.0 / self.wheel
        if math.isinf(radius):
            return own
        return own + math.copysign(1.0 / (abs(radius) + self.conformity), radius)

    def parts(self, deflection: FloatArray, radius: float) -> tuple[FloatArray, FloatArray]:
        """Pneumatic and casing force [N] on one surface."""
        curvature = self.curvature(radius)
        deep = np.maximum(deflection, 0.0)
        half = np.sqrt(2.0 * deep / curvature)
        nodes, weights = np.polynomial.legendre.leggauss(24)
        depth = deep[:, None] * (1.0 - (0.5 * (nodes + 1.0)) ** 2)
        widths = -self.width * np.expm1(-self.flattening * depth / self.width)
        area = half * (widths @ weights)
        stretch = self.casing * (1.0 + self.wrap / (self.wheel * curvature)) * deep**2
        return self.pressure * area, stretch

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Elastic radial force [N]; the pressure acts on the pneumatic part alone."""
        result = np.zeros_like(deflection)
        root = np.sqrt(np.clip(deflection, 0.0, TABULATED_DEPTH))
        for r in distinct(radius):
            here = radius == r
            pneumatic, casing = _tables(self, r)
            result[here] = pressure_ratio[here] * pneumatic(root[here]) + casing(root[here])
        return result


class Tire(Protocol):
    """An elastic tire: a frozen dataclass with a force."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def force(self, deflection: FloatArray, radius: FloatArray, pressure_ratio: FloatArray) -> FloatArray:
        """Radial force [N] at a deflection [m], surface's radius [m], and pressure over inflation pressure [1]."""
        ...


def distinct(radius: FloatArray) -> set[float]:
    """The surfaces [m] in a column of radii, found at the regions where it changes."""
    changed = radius[1:] != radius[:-1]
    return {float(r) for r in (*radius[:1], *radius[1:][changed])}


@lru_cache(maxsize=256)
def _tables(tire: ContactPatchTire, radius: float) -> tuple[PPoly, PPoly]:
    """Both parts as splines over sqrt(x), in which they are smooth down to x = 0."""
    root = np.linspace(0.0, math.sqrt(TABULATED_DEPTH), 161)
    return tuple(
        PPoly.from_spline(make_interp_spline(root, part, k=3)) for part in tire.parts(root**2, radius)
    )


def article_tire() -> PowerTire:
    """The article's tire on the article's surfaces."""
    return PowerTire(tuple(Surface(r, *article.coefficients(r)) for r in article.ARTICLE_SURFACES))


def deviating_tire(rng: np.random.Generator) -> PowerTire:
    """A tire near the article's: A and B off by some percent, surface by surface.

    A common deviation (another tire or pressure) plus one that wanders from surface to surface (the article's
    curves miss its own points by up to 13.5 %).
    """
    common_a, common_b = rng.uniform(0.03, 0.10) * rng.choice((-1.0, 1.0)), rng.normal(0.0, 0.012)
    spread_a, spread_b = rng.uniform(0.01, 0.04), rng.uniform(0.003, 0.015)
    surfaces = []
    for radius in article.ARTICLE_SURFACES:
        a, b = article.coefficients(radius)
        a *= 1.0 + common_a + rng.normal(0.0, spread_a)
        b *= 1.0 + common_b + rng.normal(0.0, spread_b)
        surfaces.append(Surface(radius, a, b))
    return PowerTire(tuple(surfaces))


def contact_patch_tire(rng: np.random.Generator) -> ContactPatchTire:
    """A contact-patch tire whose force on the flat at 2.5 cm is between 1.2 and 2.5 kN."""
    target = rng.uniform(1200.0, 2500.0)
    rough = ContactPatchTire(
        pressure=INFLATION,
        wheel=rng.uniform(0.325, 0.345),
        conformity=rng.uniform(0.05, 0.15),
        width=rng.choice((rng.uniform(0.05, 0.08), rng.uniform(0.12, 0.40))),
        flattening=rng.uniform(1.4, 2.0),
        casing=rng.uniform(0.02, 0.15) * target / 0.025**2,
        wrap=rng.uniform(0.0, 0.15),
    )
    pneumatic, casing = rough.parts(np.array([0.025]), math.inf)
    pressure = INFLATION * (target - float(casing[0])) / float(pneumatic[0])
    return ContactPatchTire(
        pressure, rough.wheel, rough.conformity, rough.width, rough.flattening, rough.casing, rough.wrap
    )


def best_power_law(tire: Tire, radius: float, deepest: float) -> Surface:
    """The power law that a user would have identified: least RMSE of the force from 0 to `deepest` [m].

    B lies between 1 and 2.
    """
    deflection = np.linspace(0.0, deepest, 61)[1:]
    force = tire.force(deflection, np.full_like(deflection, radius), np.ones_like(deflection))
    return Surface(radius, *best_power(100.0 * deflection, force, 1.0, 2.0))


def best_power(x: FloatArray, force: FloatArray, low: float, high: float) -> tuple[float, float]:
    """a and b of the power law a x^b that is closest to forces, by least squares; b lies between low and high.

    For a given b the best a is linear; b is found by golden section.
    """

    def miss(b: float) -> tuple[float, float]:
        shape = x**b
        a = float(shape @ force / (shape @ shape))
        return float(np.sum((force - a * shape) ** 2)), a

    ratio = (math.sqrt(5.0) - 1.0) / 2.0
    while high - low > 1e-7:
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if miss(left)[0] < miss(right)[0]:
            high = right
        else:
            low = left
    b = 0.5 * (low + high)
    return miss(b)[1], b


def fitted_table(tire: Tire, deepest: Sequence[float], radii: Sequence[float]) -> PowerTire:
    """Best power law on every surface, over the range of deflection that is used there."""
    return PowerTire(tuple(best_power_law(tire, r, deep) for r, deep in zip(radii, deepest, strict=True)))
