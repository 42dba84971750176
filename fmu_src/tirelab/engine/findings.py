"""What the engine hands to the diagnosis: effects, alternatives, evidence and the fitted tires."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from radialtire import TireModel

from ..preprocessing.kinematics import FloatArray
from ..simulation.simulate import Sampled, simulate
from .refit import Knob, assemble


@dataclass(frozen=True)
class Estimate:
    """A parameter's value with its standard deviation and unit."""

    value: float
    std: float
    unit: str


@dataclass(frozen=True)
class NamedEffect:
    """An effect that the baseline lacks: its parameters, and its share of the squared misfit."""

    name: str
    parameters: Mapping[str, Estimate]
    share: float


@dataclass(frozen=True)
class Alternative:
    """Another set of effects that the recordings cannot rule out: log evidence below the verdict's, and why."""

    names: tuple[str, ...]
    log_odds: float
    reason: str


@dataclass(frozen=True)
class Evidence:
    """One set that was compared: log evidence over that of the verdict, chi square per sample, sizes of its effects.

    size, partial: root mean square of each effect's contribution, and of what no other effect of the set can stand
    for, over the noise
    """

    names: tuple[str, ...]
    log_evidence: float
    chi_square: float
    size: tuple[float, ...]
    partial: tuple[float, ...]


@dataclass(frozen=True)
class FittedModel:
    """A set of effects fitted to the recordings: its tire, and how its force moves with its free parameters.

    baseline: the tire under it; parameters, values: what was fitted; radii [m]: surfaces on which its law is free
    """

    names: tuple[str, ...]
    tire: TireModel
    baseline: TireModel
    parameters: tuple[Knob, ...]
    values: FloatArray
    radii: tuple[float, ...]

    def sensitivities(self, motion: Sampled) -> FloatArray:
        """Return the derivatives (samples, parameters) of the force [N] on a motion, by difference quotients."""
        base = simulate(self._tire(self.values), motion)
        columns = []
        for i, parameter in enumerate(self.parameters):
            step = 1e-3 * parameter.scale
            moved = self.values.copy()
            moved[i] += step if self.values[i] + step <= parameter.high else -step
            columns.append((simulate(self._tire(moved), motion) - base) / step)
        return np.stack(columns, axis=1) if columns else np.zeros((base.size, 0))

    def _tire(self, values: FloatArray) -> TireModel:
        return assemble(self.baseline, self.parameters, values, self.radii)


@dataclass(frozen=True)
class Refitted:
    """A set of effects fitted once more: its tire, and what it leaves of each recording [N]."""

    tire: TireModel
    residuals: tuple[FloatArray, ...]
