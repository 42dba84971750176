"""What the estimation hands to the diagnosis: effects, sets that were compared, and fitted models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..simulation.simulate import Sampled, simulate
from .fit import Fit

FloatArray = NDArray[np.float64]

STEP = 1e-3
"""Step of the sensitivities, in standard deviations of a parameter's prior."""


@dataclass(frozen=True)
class Estimate:
    """A parameter's value with its standard deviation and unit; determined: whether the recordings say more of it than
    its prior did.
    """

    value: float
    std: float
    unit: str
    determined: bool = True


@dataclass(frozen=True)
class NamedEffect:
    """An effect that the baseline lacks.

    parameters: what was fitted of it; share: of the misfit's power beyond the noise left where it alone is taken out
    probability: that it is there, over all sets that were fitted; grounds: what a calibrated probability rests on
    """

    name: str
    parameters: Mapping[str, Estimate]
    share: float
    probability: float
    grounds: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Evidence:
    """One set that was fitted: log posterior over that of the chosen one, chi square per sample, sizes of its effects.

    size: root mean square of what each effect adds to the others, over the noise
    """

    names: tuple[str, ...]
    log_evidence: float
    chi_square: float
    size: tuple[float, ...]
    probability: float


@dataclass(frozen=True)
class FittedModel:
    """A set of effects fitted to the recordings in the catalogue's own forms."""

    fit: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects."""
        return self.fit.names

    @property
    def tire(self) -> TireModel:
        """The baseline with exactly these effects."""
        return self.fit.tire

    @property
    def baseline(self) -> TireModel:
        """The tire under the effects."""
        return self.fit.problem.dataset.tire

    @property
    def radii(self) -> tuple[float, ...]:
        """Radii [m] of the recorded surfaces, by their curvature."""
        return tuple(sorted(self.fit.problem.dataset.radii, key=lambda r: 1.0 / r))

    def sensitivities(self, motion: Sampled) -> FloatArray:
        """Return the derivatives (samples, parameters) of the force [N] on a motion, by difference quotients."""
        problem, positions = self.fit.problem, self.fit.positions
        base = simulate(self.tire, motion)
        columns = []
        for i in range(positions.size):
            step = STEP if positions[i] + STEP <= problem.high[i] else -STEP
            moved = positions.copy()
            moved[i] += step
            columns.append((simulate(problem.tire(moved), motion) - base) / step)
        return np.stack(columns, axis=1) if columns else np.zeros((base.size, 0))


@dataclass(frozen=True)
class Refitted:
    """A set of effects fitted once more: its tire, and what it leaves of each recording [N]."""

    tire: TireModel
    residuals: tuple[FloatArray, ...]
