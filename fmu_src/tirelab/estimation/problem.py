"""A set of effects as an estimation problem: from the values of its free parameters to a tire and its residual.

The position of a free parameter is measured on the axis of its prior: 0 at the centre of the prior, 1 one standard
deviation above it. The discrepancy that the form of a fitted effect may cause is its own response, modulated smoothly:

    discrepancy = sum_e c_e f_e scale_e sum_j z_j phi_j,   z_j ~ N(0, 1)

c_e: response of effect e as fitted; f_e: its form error, declared from measurements; phi_j: smooth functions of
deflection, direction, path since the last reversal, speed, time and surface, of mean square 1 together. A second effect
that would only correct the form of the first explains nothing that these functions do not. The discrepancy of the law
is the law times functions of the deflection, on each surface. Each `scale` maximises the evidence under a half-Cauchy
prior (A. Gelman, Bayesian Analysis 1 (2006) 515), since real forms may differ more from the catalogue's than those that
were measured; the form error is at most the whole effect.

M. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63, 425 (2001); J. Brynjarsdottir, A. O'Hagan, Inverse Problems 30 (2014).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, Parameter, Recalibrated, TireModel
from radialtire.recalibrated import changed_at

from ..preprocessing.motion import branches
from ..preprocessing.samples import MOST_SURFACES
from ..regressors.dataset import Dataset, Scales, arranged
from ..regressors.draws import at_reading, centre_and_spread
from ..regressors.signature import (
    BEND,
    CURVE,
    EXPONENT,
    FACTOR,
    HEIGHTS,
    KINK,
    LAW,
    PRELOAD,
    RAMPS,
    SHAPE,
    TWIST,
    form_error,
    gap_of,
    gap_spread,
    kink_spread,
    preload_spread,
    reference_of,
    size_of,
    span_of,
)

FloatArray = NDArray[np.float64]


START_OFFSET = 0.3
"""Distance, in standard deviations, from its bound at which the fit of an optional parameter starts: at the bound
itself the slope of some is zero."""

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
    return tuple(
        _free(name, i, p, scales)
        for i, p in enumerate(CATALOGUE[name].parameters)
        if p.role != "reading" and p.prior is not None
    )


def parameters_of_law(
    surfaces: int, preload: float = 0.0, gap: float = 0.0, kink: float = KINK
) -> tuple[FreeParameter, ...]:
    """Return the free parameters of the law: factor and exponent common to all surfaces, bend, twist and kinks of the
    shape, with more than one surface a further factor and exponent for each, and for a part its preload or its gap.

    preload [N], gap [m], kink [1 or N]: standard deviations of their changes; a tire has neither preload nor gap
    """
    shared = math.sqrt(0.5) if surfaces > 1 else 1.0
    spreads = [FACTOR * shared, EXPONENT * shared, BEND, TWIST, *[kink] * KINKS]
    spreads += [FACTOR * shared, EXPONENT * shared] * (surfaces if surfaces > 1 else 0)
    labels = ["log factor on A", "change of B", "bend", "twist"]
    labels += [f"{'slope change' if preload else 'kink'} {i + 1}" for i in range(KINKS)]
    labels += [f"{w}, surface {i}" for i in range(surfaces) for w in labels[:2]] if surfaces > 1 else []
    groups = [1, 2, 3, 4, *[5] * KINKS, *[6, 7] * surfaces][: len(spreads)]
    units = ["N" if group == 5 and preload else "1" for group in groups]
    bounds = [2.0 * kink / KINK if group == 5 else 2.0 for group in groups]
    shape = tuple(
        FreeParameter(
            *(LAW, i, label, unit, 0.0, spread, False, -most / spread, most / spread, -most, most),
            optional=4 <= i < COMMON,
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
        low = math.log(low) if low > 0.0 else centre - 12.0 * spread
        high = math.log(high)
    low, high = (low - centre) / spread, (high - centre) / spread
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
        be many times the usual one anyway.
        """
        signed = np.array([p.signed for p in self.parameters], dtype=bool)
        return np.where(signed, np.maximum(np.abs(positions), 1.0), 1.0)

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


def _parameters_of_law(dataset: Dataset) -> tuple[FreeParameter, ...]:
    return parameters_of_law(
        law_surfaces(dataset), preload_spread(dataset), gap_spread(dataset), kink_spread(dataset)
    )


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


DEFLECTION_HATS, SIGNED_HATS = HEIGHTS // 2 + 1, HEIGHTS // 4 + 1
"""Numbers of hat functions of the deflection (a hat at every second height of a law's shape), and of those of the
deflection times the sign of the direction and of the path since the last reversal."""


def smooth_functions(dataset: Dataset) -> FloatArray:
    """Return the functions phi (m, k) of the module's docstring at the counted blocks, of mean square 1 together."""
    many, x = dataset.experiments, dataset.deflection
    rate = dataset.gathered([e.rate for e in many])
    time = dataset.gathered([(e.time - e.time[0]) / max(e.time[-1] - e.time[0], 1e-300) for e in many])
    radius = dataset.gathered([e.surface_radius for e in many])
    depth = (x - x.min()) / max(float(np.ptp(x)), 1e-300)
    speed = np.log(np.maximum(np.abs(rate) / dataset.scales.rate, 1e-2))
    since_turn = dataset.gathered([_since_turn(e.deflection, e.gauge) for e in many]) / max(
        float(np.ptp(x)), 1e-300
    )
    groups = [_hats(depth, DEFLECTION_HATS), np.sign(rate)[:, None] * _hats(depth, SIGNED_HATS)]
    groups += [
        _hats(np.sqrt(np.minimum(since_turn, 1.0)), SIGNED_HATS),
        _polynomial(time),
        _polynomial(speed),
    ]
    if 1 < len(dataset.radii) <= DEFLECTION_HATS:
        groups.append(np.column_stack([(radius == r).astype(float) for r in dataset.radii]))
    parts = [g / np.sqrt(max(float(np.mean(np.sum(g**2, axis=1))), 1e-300)) for g in groups]
    return np.asarray(np.concatenate(parts, axis=1) / np.sqrt(len(parts)))


def form_errors(
    curves: Mapping[str, FloatArray], dataset: Dataset, functions: FloatArray
) -> dict[str, FloatArray]:
    """Return for each effect the columns (m, k) of its discrepancy at scale 1, in units of the noise.

    curves (m,): response that each effect adds to the others
    """
    return {
        name: form_error(name, dataset.tire) * size_of(curve) * _of_law(dataset)
        if name == LAW
        else form_error(name) * curve[:, None] * functions
        for name, curve in curves.items()
    }


def _of_law(dataset: Dataset) -> FloatArray:
    """Return the law times hats over the deflection, common to all surfaces and on each, of mean square 1 together."""
    many, x = dataset.experiments, dataset.deflection
    radius = dataset.gathered([e.surface_radius for e in many])
    force = dataset.stacked([e.baseline for e in many])
    hats = force[:, None] * _hats((x - x.min()) / max(float(np.ptp(x)), 1e-300), DEFLECTION_HATS)
    columns = [hats]
    if 1 < len(dataset.radii) <= DEFLECTION_HATS:
        columns += [hats * (radius == r)[:, None] for r in dataset.radii]
    whole = np.concatenate(columns, axis=1)
    return np.asarray(whole / np.sqrt(max(float(np.mean(np.sum(whole**2, axis=1))), 1e-300)))


def _since_turn(deflection: FloatArray, noise: float) -> FloatArray:
    """Return the distance (n,) [m] from the last reversal; noise [m]: of the deflection."""
    direction, _ = branches(deflection, noise)
    begin = np.append(0, np.flatnonzero(np.diff(direction)) + 1)
    turn = begin[np.searchsorted(begin, np.arange(deflection.size), side="right") - 1]
    return np.asarray(np.abs(deflection - deflection[turn]))


def _hats(place: FloatArray, count: int) -> FloatArray:
    knots = np.linspace(0.0, 1.0, count)
    return np.column_stack([np.interp(place, knots, row) for row in np.eye(count)])


def _polynomial(values: FloatArray) -> FloatArray:
    """Return first and second power, each of mean 0 and mean square 1; one column of zeros where all values are
    equal.
    """
    spread = float(np.std(values))
    if spread < 1e-9:
        return np.zeros((values.size, 1))
    first = (values - values.mean()) / spread
    second = first**2 - 1.0
    return np.column_stack([first, second / max(float(np.std(second)), 1e-300)])
