"""The forms that A(R) and B(R) may take, as functions of the logarithms of their constants.

Every constant of every form is positive, so its logarithm is what is searched: no step leads out of the allowed, and an
uncertainty is a factor up as well as down. A form answers for all surfaces at once: A and B (n, 2), their derivatives
(n, 2, k) by the k logarithms, and the law that the constants make.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from radialtire import Hull1996, Parameter, PowerLaw
from radialtire.curvature_law import CurvatureLaw
from radialtire.model import Law

from .surfaces import CM_PER_M, Surface

Array = NDArray[np.float64]

EDGE = np.log(1e-6), np.log(1.0 - 1e-4)
"""Bounds of ln(D/C) on convex ground: below the first D counts as 0, above the second A or B would be 0 on an edge."""

RISE_LOWEST = np.log(1e-9)
"""Lowest ln D on concave ground: there D counts as 0."""

DECAY = np.log(1e-6), np.log(100.0)
"""Bounds of ln E, E in 1/cm."""


class Form(Protocol):
    """A(R) and B(R) of a given set of surfaces."""

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The constants, as the law names them."""
        ...

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest logarithms (k,)."""
        ...

    def coefficients(self, logs: Array) -> Array:
        """Return A and B of every surface (n, 2)."""
        ...

    def derivatives(self, logs: Array) -> Array:
        """Return the derivatives of A and B by the logarithms (n, 2, k)."""
        ...

    def combination(self) -> Array:
        """Return the matrix (k, k) that makes the logarithms of the constants from what is searched."""
        ...

    def law(self, logs: Array) -> Law:
        """Return the law with these constants."""
        ...


@dataclass(frozen=True)
class ConstantForm:
    """The same A and B on every surface."""

    count: int

    parameters = PowerLaw.parameters

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Those of the power law."""
        return _bounds(self.parameters)

    def coefficients(self, logs: Array) -> Array:
        """Return A and B, repeated."""
        return np.tile(np.exp(logs), (self.count, 1))

    def derivatives(self, logs: Array) -> Array:
        """Return the derivatives of A and B, repeated."""
        return np.tile(np.diag(np.exp(logs)), (self.count, 1, 1))

    def combination(self) -> Array:
        """Return the identity."""
        return np.eye(2)

    def law(self, logs: Array) -> PowerLaw:
        """Return the power law."""
        A, B = np.exp(logs).tolist()
        return PowerLaw(A, B)


@dataclass(frozen=True)
class CurvatureForm:
    """A and B of each surface by itself, as many as CurvatureLaw holds; curvatures [1/m]."""

    curvatures: tuple[float, ...]

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """A and B of every surface, numbered as the law numbers them: by rising curvature."""
        known = {p.name: p for p in CurvatureLaw.parameters}
        rank = {k: i for i, k in enumerate(sorted(self.curvatures), start=1)}
        return tuple(
            known[f"{word}_{rank[k]}"] for k in self.curvatures for word in ("coefficient", "exponent")
        )

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Those of the power law, for each surface."""
        lower, upper = _bounds(PowerLaw.parameters)
        return np.tile(lower, len(self.curvatures)), np.tile(upper, len(self.curvatures))

    def coefficients(self, logs: Array) -> Array:
        """Return A and B of every surface."""
        found: Array = np.exp(logs).reshape(-1, 2)
        return found

    def derivatives(self, logs: Array) -> Array:
        """Return the derivatives: each A and B depends on its own logarithm alone."""
        found: Array = np.diag(np.exp(logs)).reshape(-1, 2, logs.size)
        return found

    def combination(self) -> Array:
        """Return the identity."""
        return np.eye(2 * len(self.curvatures))

    def law(self, logs: Array) -> CurvatureLaw:
        """Return the law over curvature."""
        pairs = self.coefficients(logs).tolist()
        return CurvatureLaw.through([(k, A, B) for k, (A, B) in zip(self.curvatures, pairs, strict=True)])


@dataclass(frozen=True)
class HullForm:
    """Equations 3 and 4 of Hull, Wang & Moore (1996) with their flat limits shared; radii [m] of the surfaces.

    Searched are, for A and then for B, ln C, ln(D/C) and ln E of the convex side, ln D and ln E of the concave side;
    a side without surfaces has D = 0 and is not searched.
    """

    radii: tuple[float, ...]

    @property
    def sides(self) -> tuple[bool, bool]:
        """Whether there are convex and concave surfaces."""
        return any(0.0 < r < np.inf for r in self.radii), any(r < 0.0 for r in self.radii)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The constants C, D, E of A, then those of B."""
        of_side = (True, self.sides[0], self.sides[0], self.sides[1], self.sides[1])
        return tuple(p for p, here in zip(Hull1996.parameters, 2 * of_side, strict=True) if here)

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Those of C and of the concave D's highest as in the law; EDGE, RISE_LOWEST and DECAY."""
        found: list[tuple[float, float]] = []
        for flat, _, _, rise, _ in (Hull1996.parameters[:5], Hull1996.parameters[5:]):
            found.append((np.log(flat.minimum), np.log(flat.maximum)))
            found += [EDGE, DECAY] * self.sides[0]
            found += [(RISE_LOWEST, np.log(rise.maximum)), DECAY] * self.sides[1]
        lower, upper = np.array(found).T
        return lower, upper

    def coefficients(self, logs: Array) -> Array:
        """Return A and B of every surface, equations 3 and 4."""
        return np.stack([self.one(half)[0] for half in np.split(logs, 2)], axis=1)

    def derivatives(self, logs: Array) -> Array:
        """Return the derivatives of equations 3 and 4."""
        k = logs.size // 2
        found = np.zeros((len(self.radii), 2, 2 * k))
        for i, half in enumerate(np.split(logs, 2)):
            found[:, i, i * k : (i + 1) * k] = self.one(half)[1]
        return found

    def one(self, logs: Array) -> tuple[Array, Array]:
        """Return A, or B, of every surface (n,) and its derivatives (n, k) by its half of the logarithms."""
        radius = CM_PER_M * np.array(self.radii)
        convex, concave = (radius > 0.0) & np.isfinite(radius), radius < 0.0
        C = np.exp(logs[0])
        value = np.full(radius.size, C)
        derivatives = np.zeros((radius.size, logs.size))
        derivatives[:, 0] = C
        if self.sides[0]:
            share, E = np.exp(logs[1:3])
            drop = C * share * np.exp(-E * radius[convex])
            value[convex] -= drop
            derivatives[convex, 0] -= drop
            derivatives[convex, 1] = -drop
            derivatives[convex, 2] = drop * E * radius[convex]
        if self.sides[1]:
            D, E = np.exp(logs[-2:])
            rise = D * np.exp(E * radius[concave])
            value[concave] += rise
            derivatives[concave, -2] = rise
            derivatives[concave, -1] = rise * E * radius[concave]
        return value, derivatives

    def combination(self) -> Array:
        """Return the matrix by which ln D of the convex side is ln(D/C) + ln C."""
        k = len(self.parameters)
        found = np.eye(k)
        if self.sides[0]:
            found[1, 0] = found[k // 2 + 1, k // 2] = 1.0
        return found

    def law(self, logs: Array) -> Hull1996:
        """Return the article's law; a side that has no surfaces, or where D is at the bottom of its bounds, is flat."""
        lower, _ = self.bounds
        values = np.exp(self.combination() @ logs)
        found = {p.name: float(v) for p, v in zip(self.parameters, values, strict=True)}
        for p, log, lowest in zip(self.parameters, logs, lower, strict=True):
            if p.name.endswith(("_drop", "_rise")) and log <= lowest + 1e-6:
                found[p.name] = 0.0
        flat = {p.name: 0.0 for p in Hull1996.parameters if p.name.endswith(("_drop", "_rise"))}
        return Hull1996(**(flat | found))


def form_of(surfaces: Sequence[Surface], law: str) -> Form:
    """Return the form of the law named `law` for `surfaces`."""
    if law == Hull1996.name:
        return HullForm(tuple(s.radius for s in surfaces))
    if law == CurvatureLaw.name:
        return CurvatureForm(tuple(s.curvature for s in surfaces))
    return ConstantForm(len(surfaces))


def _bounds(parameters: tuple[Parameter, ...]) -> tuple[Array, Array]:
    lower, upper = np.log([(p.minimum, p.maximum) for p in parameters]).T
    return lower, upper
