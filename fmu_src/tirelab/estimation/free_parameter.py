"""One number that is fitted, on the axis of its prior: 0 at the prior's centre, 1 one standard deviation beyond."""

from __future__ import annotations

import math
from dataclasses import dataclass

from radialtire import CATALOGUE, Parameter

from ..regressors.draws import centre_and_spread
from ..regressors.law import BEND, EXPONENT, FACTOR, HEIGHT, HEIGHTS, LAW, TWIST
from ..regressors.scales import Scales

AWAKE = 0.3
"""Where an optional form begins that lies at a bound of its parameter, in standard deviations: at the bound itself some
have no slope."""


COMMON = 4 + HEIGHTS
"""Parameters of the law that are common to all surfaces: they come first."""


@dataclass(frozen=True)
class FreeParameter:
    """owner: the effect's name, or LAW; index: of its parameter there; label, unit: for a reader
    centre, spread: of the prior, of the logarithm where `logarithm`
    low, high: bounds on the axis of the prior, minimum, maximum: of the value
    optional: whether the plain form does without it; plain: its value there
    group: number of those whose prior has a scale that is found by the evidence, 0: as declared
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
    def awake(self) -> float:
        """The position at which a fit of the optional forms begins."""
        start = self.position(self.plain)
        if start <= self.low + 1e-9:
            return min(self.low + AWAKE, self.high)
        return max(self.high - AWAKE, self.low) if start >= self.high - 1e-9 else start


def parameters_of_effect(name: str, scales: Scales) -> tuple[FreeParameter, ...]:
    """Return what may be fitted of an effect, in the order of its parameters."""
    return tuple(
        _free(name, i, p, scales)
        for i, p in enumerate(CATALOGUE[name].parameters)
        if p.role != "reading" and p.prior is not None
    )


def parameters_of_law(surfaces: int) -> tuple[FreeParameter, ...]:
    """Return what may be fitted of the law: factor and exponent common to all surfaces, bend, twist and heights of the
    shape, and, with more than one surface, factor and exponent of each beside the common ones.
    """
    shared = math.sqrt(0.5) if surfaces > 1 else 1.0
    spreads = [FACTOR * shared, EXPONENT * shared, BEND, TWIST, *[HEIGHT] * HEIGHTS]
    spreads += [FACTOR * shared, EXPONENT * shared] * (surfaces if surfaces > 1 else 0)
    labels = ["log factor on A", "change of B", "bend", "twist"]
    labels += [f"height {i + 1}" for i in range(HEIGHTS)]
    labels += [f"{w}, surface {i}" for i in range(surfaces) for w in labels[:2]] if surfaces > 1 else []
    groups = [1, 2, 3, 4, *[5] * HEIGHTS, *[6, 7] * surfaces]
    return tuple(
        FreeParameter(
            LAW,
            i,
            label,
            "1",
            0.0,
            spread,
            False,
            -2.0 / spread,
            2.0 / spread,
            -2.0,
            2.0,
            optional=4 <= i < COMMON,
            group=groups[i],
        )
        for i, (label, spread) in enumerate(zip(labels, spreads, strict=True))
    )


def _free(name: str, index: int, p: Parameter, scales: Scales) -> FreeParameter:
    centre, spread, logarithm = centre_and_spread(p, scales)
    low, high = p.minimum, p.maximum
    if logarithm:
        low = math.log(low) if low > 0.0 else centre - 12.0 * spread
        high = math.log(high)
    low, high = (low - centre) / spread, (high - centre) / spread
    return FreeParameter(
        name,
        index,
        p.name,
        p.unit,
        centre,
        spread,
        logarithm,
        low,
        high,
        p.minimum,
        p.maximum,
        p.optional,
        p.start,
    )
