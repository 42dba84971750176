"""A set of effects as a fit: free parameters in, a tire and what it leaves of the recordings out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, Recalibrated, TireModel

from ..regressors.dataset import Dataset, arranged
from ..regressors.draws import at_reading
from ..regressors.law import LAW, MOST_SURFACES, REFERENCE, SHAPE
from .free_parameter import COMMON, FreeParameter, parameters_of_effect, parameters_of_law

FloatArray = NDArray[np.float64]
Values = Mapping[str, tuple[float, ...]]
"""Of each effect the values of all its parameters; of LAW the values of its free ones."""


@dataclass(frozen=True)
class EstimationProblem:
    """names: of the set; parameters: what is fitted; held: values of everything that is not."""

    dataset: Dataset
    names: tuple[str, ...]
    parameters: tuple[FreeParameter, ...]
    held: Values

    @property
    def low(self) -> FloatArray:
        """Lower bounds of the positions."""
        return np.array([p.low for p in self.parameters])

    @property
    def high(self) -> FloatArray:
        """Upper bounds of the positions."""
        return np.array([p.high for p in self.parameters])

    @property
    def groups(self) -> NDArray[np.int_]:
        """Numbers of the law's groups of parameters, 0: of an effect."""
        return np.array([p.group for p in self.parameters], dtype=np.int_)

    def values(self, positions: FloatArray) -> dict[str, tuple[float, ...]]:
        """Return all values at positions on the priors' axes."""
        found = {name: list(self.held[name]) for name in self.names}
        for p, position in zip(self.parameters, positions, strict=True):
            found[p.owner][p.index] = p.value(float(position))
        return {name: tuple(v) for name, v in found.items()}

    def positions(self, values: Values, *, awake: bool = False) -> FloatArray:
        """Return the positions of values; awake: optional forms that are off begin a little beside it."""
        found = []
        for p in self.parameters:
            value = values[p.owner][p.index]
            asleep = awake and p.optional and value == p.plain
            found.append(p.awake if asleep else p.position(value))
        return np.array(found)

    def tire(self, positions: FloatArray) -> TireModel:
        """Return the tire at the positions."""
        return tire_of(self.dataset, self.values(positions))

    def curves(self, positions: FloatArray) -> dict[str, FloatArray]:
        """Return what each effect adds to the others (m,), in units of the noise."""
        values = self.values(positions)
        whole = self.dataset.response(tire_of(self.dataset, values))
        found = {}
        for name in values:
            less = {n: v for n, v in values.items() if n != name}
            found[name] = whole - self.dataset.response(tire_of(self.dataset, less))
        return found

    def residual(self, positions: FloatArray) -> FloatArray:
        """Return what that tire leaves, in units of the noise (m,)."""
        left = self.dataset.misfit - self.dataset.response(self.tire(positions))
        return np.where(np.isfinite(left), left, 1e6)


def problem_of(dataset: Dataset, values: Values, *, plain: bool) -> EstimationProblem:
    """Return the problem of the effects whose values are given; plain: the optional forms stay at these values."""
    free: list[FreeParameter] = []
    for name in values:
        own = (
            parameters_of_law(law_surfaces(dataset))
            if name == LAW
            else parameters_of_effect(name, dataset.scales)
        )
        free += [p for p in own if not (plain and p.optional and values[name][p.index] == p.plain)]
    return EstimationProblem(dataset, tuple(values), tuple(free), values)


def law_surfaces(dataset: Dataset) -> int:
    """Return the number of surfaces on each of which the law is refitted."""
    return len(dataset.radii) if len(dataset.radii) <= MOST_SURFACES else 1


def law_start(dataset: Dataset) -> tuple[float, ...]:
    """Return the law's values of the baseline."""
    return (0.0,) * len(parameters_of_law(law_surfaces(dataset)))


def with_readings(name: str, values: Sequence[float], dataset: Dataset) -> tuple[float, ...]:
    """Return an effect's values with those that follow from the reading."""
    pairs = zip(CATALOGUE[name].parameters, values, strict=True)
    return tuple(at_reading(p, dataset.scales) if p.role == "reading" else v for p, v in pairs)


def tire_of(dataset: Dataset, values: Values) -> TireModel:
    """Return the baseline tire with the effects of these values and, with LAW, its law refitted."""
    effects = [(name, v) for name, v in values.items() if name != LAW]
    tire = dataset.tire
    if LAW in values:
        factor, exponent, *shape = values[LAW][:COMMON]
        own = values[LAW][COMMON:]
        radii = dataset.radii[: law_surfaces(dataset)]
        pairs = [(own[2 * i], own[2 * i + 1]) if own else (0.0, 0.0) for i in range(len(radii))]
        rows = tuple((r, factor + a, exponent + b) for r, (a, b) in zip(radii, pairs, strict=True))
        tire = replace(tire, law=Recalibrated(tire.law, rows))
        if any(shape):
            bend, twist, *heights = shape
            twist = min(max(twist, -1.0), 1.0)
            reference = at_reading(CATALOGUE[SHAPE].parameters[REFERENCE], dataset.scales)
            effects.append((SHAPE, (bend, twist, reference, *heights)))
    return arranged(tire, effects)
