"""A refitted law as people know it: A and B on each surface before and after, and the curve of their difference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from radialtire import FLAT_RADIUS, TireModel

from ..estimation.findings import Estimate
from ..preprocessing.dataset import Recorded
from ..preprocessing.kinematics import FloatArray
from ..simulation.simulate import simulate
from .binning import MOST_SURFACES
from .discriminating_test import Test

POINTS = 60
"""Points of a curve of difference."""


@dataclass(frozen=True)
class LawChange:
    """The law F = A x^B on one surface before and after the correction.

    radius [m]; before, after: A [N/cm^B] and B [1]; std: standard deviations of those after, None where not known
    deflection [m], difference [N]: the corrected law's force less the baseline's, with the law's bend, as far as the
    surface was pressed
    """

    radius: float
    before: tuple[float, float]
    after: tuple[float, float]
    std: tuple[float, float] | None
    deflection: FloatArray
    difference: FloatArray

    def to_dict(self) -> dict[str, object]:
        """Return the entry of `law` in diagnosis.json."""
        keys = ("A", "B")
        told = {
            key: {
                "before": self.before[i],
                "after": self.after[i],
                "std": None if self.std is None else self.std[i],
            }
            for i, key in enumerate(keys)
        }
        return {"radius": self.radius if np.isfinite(self.radius) else "inf", **told}


def law_changes(
    baseline: TireModel,
    corrected: TireModel,
    estimates: Mapping[str, Estimate],
    recordings: Sequence[Recorded],
) -> tuple[LawChange, ...]:
    """Return the change on every recorded surface, from concave to convex.

    estimates: the fitted changes of ln A and of B by their labels, for the deviations
    """
    deepest: dict[float, float] = {}
    for r in recordings:
        for radius in np.unique(r.surface_radius):
            own = float(np.inf) if abs(radius) >= FLAT_RADIUS else float(radius)
            there = float(r.deflection[r.surface_radius == radius].max())
            deepest[own] = max(deepest.get(own, 0.0), there)
    radii = sorted(deepest, key=lambda radius: 1.0 / radius)
    if len(radii) > MOST_SURFACES:
        radii = [radii[i] for i in np.linspace(0, len(radii) - 1, MOST_SURFACES).round().astype(int)]
    return tuple(_change(radius, deepest[radius], (baseline, corrected), estimates) for radius in radii)


def _change(
    radius: float, deepest: float, tires: tuple[TireModel, TireModel], estimates: Mapping[str, Estimate]
) -> LawChange:
    x = np.linspace(0.0, max(deepest, 1e-12), POINTS)
    motion = Test("ramp", np.arange(POINTS, dtype=float), x, np.full(POINTS, radius))
    before, after = (_bare(tire) for tire in tires)
    a, b = before.law.coefficients(radius), after.law.coefficients(radius)
    difference = simulate(after, motion) - simulate(before, motion)
    return LawChange(radius, a, b, _deviations(radius, b[0], estimates), x, difference)


def _bare(tire: TireModel) -> TireModel:
    """Return the law of a tire with the effects that are part of it."""
    return replace(tire, effects=tuple(pair for pair in tire.effects if "law" in pair[0].traits))


def _deviations(
    radius: float, coefficient: float, estimates: Mapping[str, Estimate]
) -> tuple[float, float] | None:
    """Return the deviations of A and B: that of ln A is that of A over A."""
    own = "flat" if np.isinf(radius) else f"{100.0 * radius:.4g} cm"
    for where in (own, "all surfaces"):
        factor, exponent = estimates.get(f"log factor on A, {where}"), estimates.get(f"change of B, {where}")
        if factor is not None and exponent is not None:
            return coefficient * factor.std, exponent.std
    return None
