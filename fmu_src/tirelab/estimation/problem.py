"""A set of effects as an estimation problem: from the values of its free parameters to a tire and its residual.

The position of a free parameter is measured on the axis of its prior: 0 at the centre of the prior, 1 one standard
deviation above it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, Parameter, Recalibrated, TireModel
from radialtire.recalibrated import changed_at

from ..preprocessing.samples import MOST_SURFACES
from ..regressors.dataset import Dataset, Scales, arranged
from ..regressors.draws import at_reading, centre_and_spread
from ..regressors.signature import (
    BEND,
    CURVE,
    EXPONENT,
    FACTOR,
    KINK,
    LAW,
    PRELOAD,
    RAMPS,
    SHAPE,
    TWIST,
    gap_of,
    gap_spread,
    kink_spread,
    preload_spread,
    reference_of,
    span_of,
)

FloatArray = NDArray[np.float64]


START_OFFSET = 0.3
"""Distance, in standard deviations, from its bound at which the fit of an optional parameter starts: at the bound
itself the slope of some is zero."""

MOST_UNUSUAL = 3.0
"""Distance, in standard deviations of its prior, up to which a form may lie: its whole range, as the priors' sources
state them. A long recording can pay for any form, and what asks for a more unusual one is another effect's."""

MOST_OF_FACTOR = math.log(1000.0)
"""Largest logarithm of a factor on the believed law: a thousand, as between newtons and kilonewtons. A spring that is
believed and is not there has to go; what is left of it another effect would take away."""

FARTHEST = 12.0
"""Distance, in standard deviations of its prior, down to which the logarithm of a value goes that may be 0: of a normal
law less than 1e-32 lies beyond it."""

KINKS = RAMPS.shape[1]
"""Number of kinks of a refitted law."""

COMMON = 4 + KINKS
"""Number of parameters of the law that are common to all surfaces; they come first."""


@dataclass(frozen=True)
class FreeParameter:
    """owner: the effect's name, or LAW; index: of its parameter there; label, unit: for a reader
    centre, spread: of the prior; of the prior of the logarithm if `logarithm`
    low, high: bounds of the position; minimum, maximum: bounds of the value
    optional: whether the plain form of the effect keeps it at the value `plain`
    group: number of the group whose prior's scale is found by the evidence; 0: the prior is as declared
    signed: whether it is a strength of either sign, which may lie far outside the spread of its prior (see `widths`)
    dispensable: whether it is one of several strengths of its effect, of which some may be next to nothing
    """

    owner: str
    index: int
    label: str
    unit: str
    centre: float
    spread: float
    logarithm: bool
    low: float
    high: float
    minimum: float
    maximum: float
    optional: bool = False
    plain: float = 0.0
    group: int = 0
    signed: bool = False
    dispensable: bool = False

    def value(self, position: float) -> float:
        """Return the value at a position on the prior's axis, within the bounds."""
        inside = self.centre + self.spread * min(max(position, self.low), self.high)
        value = math.exp(inside) if self.logarithm else inside
        return min(max(value, self.minimum), self.maximum)

    def position(self, value: float) -> float:
        """Return the position of a value, within the bounds."""
        inside = math.log(max(value, 1e-300)) if self.logarithm else value
        return min(max((inside - self.centre) / self.spread, self.low), self.high)

    @property
    def start(self) -> float:
        """The position from which a fit of an optional parameter starts: its plain value, moved off a bound."""
        start = self.position(self.plain)
        if start <= self.low + 1e-9:
            return min(self.low + START_OFFSET, self.high)
        return max(self.high - START_OFFSET, self.low) if start >= self.high - 1e-9 else start


def parameters_of_effect(name: str, scales: Scales) -> tuple[FreeParameter, ...]:
    """Return the free parameters of an effect, in the order of its parameters."""
    free = tuple(
        _free(name, i, p, scales)
        for i, p in enumerate(CATALOGUE[name].parameters)
        if p.role != "reading" and p.prior is not None
    )
    strengths = [p for p in free if p.logarithm and CATALOGUE[name].parameters[p.index].role == "strength"]
    return tuple(replace(p, dispensable=p in strengths and len(strengths) > 1) for p in free)


def parameters_of_law(
    surfaces: int, preload: float = 0.0, gap: float = 0.0, kink: float = KINK, *, part: bool = False
) -> tuple[FreeParameter, ...]:
    """Return the free parameters of the law: factor and exponent common to all surfaces, bend, twist and kinks of the
    shape, with more than one surface a further factor and exponent for each, and for a part its preload or its gap.

    preload [N], gap [m], kink [1 or N]: standard deviations of their changes; a tire has neither preload nor gap
    part: whether it is that of a part, whose bend and twist are no more unusual than its factor and exponent
    """
    shared = math.sqrt(0.5) if surfaces > 1 else 1.0
    spreads = [FACTOR * shared, EXPONENT * shared, BEND, TWIST, *[kink] * KINKS]
    spreads += [FACTOR * shared, EXPONENT * shared] * (surfaces if surfaces > 1 else 0)
    labels = ["log factor on A", "change of B", "bend", "twist"]
    labels += [f"{'slope change' if preload else 'kink'} {i + 1}" for i in range(KINKS)]
    labels += [f"{w}, surface {i}" for i in range(surfaces) for w in labels[:2]] if surfaces > 1 else []
    groups = [1, 2, 3, 4, *[5] * KINKS, *[6, 7] * surfaces][: len(spreads)]
    units = ["N" if group == 5 and preload else "1" for group in groups]
    most_of = {1: MOST_OF_FACTOR, 5: 2.0 * kink / KINK, 6: MOST_OF_FACTOR}
    bounds = [most_of.get(group, 2.0) for group in groups]
    shape = tuple(
        FreeParameter(
            *(LAW, i, label, unit, 0.0, spread, False, -most / spread, most / spread, -most, most),
            optional=(4 if part else 2) <= i < COMMON,
            group=groups[i],
        )
        for i, (label, unit, spread, most) in enumerate(zip(labels, units, spreads, bounds, strict=True))
    )
    constants = ("preload", "N", preload, 2.0 / PRELOAD, 8), ("gap", "m", gap, 2.0 / FACTOR, 9)
    return (
        *shape,
        *(
            FreeParameter(
                *(LAW, len(shape), label, unit, 0.0, spread, False, -far, far, -far * spread, far * spread),
                group=group,
            )
            for label, unit, spread, far, group in constants
            if spread > 0.0
        ),
    )


def _free(name: str, index: int, p: Parameter, scales: Scales) -> FreeParameter:
    centre, spread, logarithm = centre_and_spread(p, scales)
    low, high = p.minimum, p.maximum
    if logarithm:
        low = math.log(low) if low > 0.0 else centre - FARTHEST * spread
        high = math.log(high)
    low, high = (low - centre) / spread, (high - centre) / spread
    if p.role == "form":
        start = math.log(max(p.start, 1e-300)) if logarithm else p.start
        plain = (start - centre) / spread if p.optional else 0.0
        low, high = max(low, min(-MOST_UNUSUAL, plain)), min(high, max(MOST_UNUSUAL, plain))
    return FreeParameter(
        *(name, index, p.name, p.unit, centre, spread, logarithm, low, high),
        *(p.minimum, p.maximum, p.optional, p.start),
        signed=p.role == "strength" and not logarithm and centre == 0.0,
    )


Values = Mapping[str, tuple[float, ...]]
"""For each effect the values of all its parameters; for LAW those of its free ones."""


@dataclass(frozen=True)
class EstimationProblem:
    """names: effects of the set; parameters: those that are fitted; held: values of all others."""

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

    def widths(self, positions: FloatArray) -> FloatArray:
        """Return the standard deviations of the priors, on their axes, at these positions (k,).

        They are 1, except for a strength of either sign: there max(|position|, 1), which makes the position likeliest.
        A scale of its own gives this prior the tails of a Cauchy law. Other strengths have a normal logarithm and may
        be many times the usual one anyway. Of several strengths of one effect the largest makes it: a friction is
        constant, in proportion to the load, or both. The others have such a scale below the centre of their priors.
        """
        pairs = list(zip(self.parameters, positions, strict=True))
        most: dict[str, float] = {}
        for p, position in pairs:
            if p.dispensable:
                most[p.owner] = max(most.get(p.owner, -math.inf), position)
        free = [p.signed or (p.dispensable and z < min(most[p.owner], 0.0)) for p, z in pairs]
        return np.where(np.array(free, dtype=bool), np.maximum(np.abs(positions), 1.0), 1.0)

    @property
    def shaped(self) -> bool:
        """Whether the refitted law of a tire has another shape than the one that was measured.

        F = A x^B was measured of tires (Hull, Wang and Moore, 1996); the shape of a part's law is not known.
        """
        return not self.dataset.tire.is_part and any(p.owner == LAW and p.optional for p in self.parameters)

    @property
    def hypotheses(self) -> frozenset[str]:
        """Names of its effects, another shape of a tire's law being one more, as unusual as an effect."""
        return frozenset((*self.names, SHAPE) if self.shaped else self.names)

    def values(self, positions: FloatArray) -> dict[str, tuple[float, ...]]:
        """Return all values at positions on the priors' axes."""
        found = {name: list(self.held[name]) for name in self.names}
        for p, position in zip(self.parameters, positions, strict=True):
            found[p.owner][p.index] = p.value(float(position))
        return {name: tuple(v) for name, v in found.items()}

    def positions(self, values: Values, *, off_bounds: bool = False) -> FloatArray:
        """Return the positions (k,) of values; off_bounds: those of optional parameters at their plain value are moved
        off a bound (see `FreeParameter.start`).
        """
        found = []
        for p in self.parameters:
            value = values[p.owner][p.index]
            moved = off_bounds and p.optional and value == p.plain
            found.append(p.start if moved else p.position(value))
        return np.array(found)

    def tire(self, positions: FloatArray) -> TireModel:
        """Return the tire at the positions."""
        return tire_of(self.dataset, self.values(positions))

    def curves(self, positions: FloatArray) -> dict[str, FloatArray]:
        """Return the response (m,) that each effect adds to the others, in units of the noise."""
        values = self.values(positions)
        whole = self.dataset.response(tire_of(self.dataset, values))
        found = {}
        for name in values:
            less = {n: v for n, v in values.items() if n != name}
            found[name] = whole - self.dataset.response(tire_of(self.dataset, less))
        return found

    def residual(self, positions: FloatArray) -> FloatArray:
        """Return the residual (m,) of the tire at the positions, in units of the noise."""
        left = self.dataset.misfit - self.dataset.response(self.tire(positions))
        return np.where(np.isfinite(left), left, 1e6)


def problem_of(dataset: Dataset, values: Values, *, plain: bool) -> EstimationProblem:
    """Return the problem of the effects whose values are given; plain: optional parameters at their plain value
    stay.
    """
    free: list[FreeParameter] = []
    for name in values:
        own = _parameters_of_law(dataset) if name == LAW else parameters_of_effect(name, dataset.scales)
        free += [p for p in own if not (plain and p.optional and values[name][p.index] == p.plain)]
    return EstimationProblem(dataset, tuple(values), tuple(free), values)


def law_surfaces(dataset: Dataset) -> int:
    """Return the number of surfaces on each of which the law is refitted."""
    return len(dataset.radii) if len(dataset.radii) <= MOST_SURFACES else 1


def law_start(dataset: Dataset) -> tuple[float, ...]:
    """Return the values at which a refitted law is that of the baseline."""
    return (0.0,) * len(_parameters_of_law(dataset))


def unshaped(law: Sequence[float]) -> tuple[float, ...]:
    """Return the values of a refitted law with the shape of a tire's."""
    return (*law[:2], *[0.0] * (COMMON - 2), *law[COMMON:])


def _parameters_of_law(dataset: Dataset) -> tuple[FreeParameter, ...]:
    spreads = preload_spread(dataset), gap_spread(dataset), kink_spread(dataset)
    return parameters_of_law(law_surfaces(dataset), *spreads, part=dataset.tire.is_part)


def with_readings(name: str, values: Sequence[float], dataset: Dataset) -> tuple[float, ...]:
    """Return an effect's values with those that follow from the reading."""
    pairs = zip(CATALOGUE[name].parameters, values, strict=True)
    return tuple(at_reading(p, dataset.scales) if p.role == "reading" else v for p, v in pairs)


def tire_of(dataset: Dataset, values: Values) -> TireModel:
    """Return the baseline tire with the effects of these values and, with LAW, its law refitted."""
    effects = [(name, v) for name, v in values.items() if name != LAW]
    tire = dataset.tire
    if LAW not in values:
        return arranged(tire, effects)
    factor, exponent, *shape = values[LAW][:COMMON]
    own = values[LAW][COMMON:]
    preload = tire.preload
    if tire.two_sided:
        preload, own = preload + own[-1], own[:-1]
    if gap := gap_of(tire):
        effects.append((gap[0].name, (gap[1][0] - own[-1],)))
        own = own[:-1]
    radii = dataset.radii[: law_surfaces(dataset)]
    pairs = [(own[2 * i], own[2 * i + 1]) if own else (0.0, 0.0) for i in range(len(radii))]
    at = reference_of(dataset)
    rows = [(r, *changed_at(at, factor + a, exponent + b)) for r, (a, b) in zip(radii, pairs, strict=True)]
    if any(shape):
        bend, twist, *kinks = shape
        twist = min(max(twist, -1.0), 1.0)
        if tire.two_sided and any(kinks):
            effects.append((CURVE, (*span_of(dataset), *_heights(CURVE, kinks))))
            kinks = [0.0] * KINKS
        if bend or twist or any(kinks):
            effects.append((SHAPE, (bend, twist, at, *_heights(SHAPE, kinks))))
    return arranged(tire, effects, law=Recalibrated(tire.law, tuple(rows)), preload=preload)


def _heights(shape: str, kinks: Sequence[float]) -> list[float]:
    """Return the heights of a law's shape from its kinks, within their bounds."""
    last = CATALOGUE[shape].parameters[-1]
    return [min(max(float(h), last.minimum), last.maximum) for h in RAMPS @ kinks]
