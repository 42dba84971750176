"""Values of parameters, drawn from their priors on the scales of the recordings."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from radialtire import Effect, Parameter
from scipy.special import ndtr, ndtri
from scipy.stats import qmc

from .dataset import Scales

FloatArray = NDArray[np.float64]


LEAST_MASS = 1e-3
"""Part of a prior within the parameter's bounds below which the value is taken at the nearer bound; and beyond the
first and the last draw."""

LEAST_DRAWN, MOST_OF_LOAD = 0.1, 0.3
"""Smallest size of the drawn responses, as a part of the misfit; the largest is the whole misfit, or this part of the
load. The shape of a nonlinear response depends on its size."""

SIZED, OVERSIZED = 2.5, 30.0
"""Factor to within which a strength is adjusted for a wanted size, and that beyond which a response is not drawn."""


def centre_and_spread(parameter: Parameter, scales: Scales) -> tuple[float, float, bool]:
    """Return centre and spread of a parameter's prior on these recordings, and whether they are of its logarithm."""
    prior = parameter.prior
    if prior is None:
        raise ValueError(f"{parameter.name} declares no prior")
    unit = scales.of(prior.scale)
    if prior.shape == "log":
        return math.log(prior.centre * unit), prior.spread, True
    return prior.centre * unit, prior.spread * unit, False


def quantile(parameter: Parameter, share: float, scales: Scales) -> float:
    """Return the value below which a `share` of the parameter's prior lies, the prior cut off at its bounds."""
    centre, spread, logarithm = centre_and_spread(parameter, scales)
    low, high = parameter.minimum, parameter.maximum
    if logarithm:
        low, high = math.log(max(low, 1e-300)), math.log(high)
    below, above = ndtr((low - centre) / spread), ndtr((high - centre) / spread)
    if above - below < LEAST_MASS:
        value = min(max(centre, low), high)
    else:
        value = centre + spread * float(ndtri(below + share * (above - below)))
    value = math.exp(value) if logarithm else value
    return min(max(value, parameter.minimum), parameter.maximum)


def at_reading(parameter: Parameter, scales: Scales) -> float:
    """Return the value of a parameter of the reading, such as its noise: the centre of its prior, within its bounds."""
    return quantile(parameter, 0.5, scales) if parameter.prior is not None else parameter.start


def drawn(effect: Effect, scales: Scales, count: int) -> tuple[list[list[float]], FloatArray]:
    """Return `count` quasi-random sets of values (Sobol), and for each a number from 0 to 1 that sets its size.

    In the first half, the plain form, the optional parameters keep their start values. Each half of a Sobol sequence
    fills the priors evenly; every second set of it would not.
    """
    names = effect.parameters
    shares = qmc.Sobol(len(names) + 1, seed=1).random(count)
    shares = np.clip(shares, LEAST_MASS, 1.0 - LEAST_MASS)
    sets = [
        [_one(p, float(row[i]), scales, plain=k < count // 2) for i, p in enumerate(names)]
        for k, row in enumerate(shares)
    ]
    return sets, shares[:, -1]


def _one(parameter: Parameter, share: float, scales: Scales, *, plain: bool) -> float:
    if parameter.role == "reading":
        return at_reading(parameter, scales)
    if parameter.prior is None or (parameter.optional and plain):
        return parameter.start
    return quantile(parameter, share, scales)


def strength_of(effect: Effect, values: Sequence[float]) -> float:
    """Return the first strength among an effect's values, 1 where it has none."""
    return next((v for p, v in zip(effect.parameters, values, strict=True) if p.role == "strength"), 1.0)


def strengthened(effect: Effect, values: Sequence[float], factor: float) -> list[float]:
    """Return the values with every strength, and every parameter that adds to one, times a factor, within bounds."""
    units = {p.unit for p in effect.parameters if p.role == "strength"}
    found = []
    for p, value in zip(effect.parameters, values, strict=True):
        strong = p.role == "strength" or (p.neutral is not None and p.unit in units and p.role != "limit")
        found.append(float(min(max(value * factor, p.minimum), p.maximum)) if strong else value)
    return found
