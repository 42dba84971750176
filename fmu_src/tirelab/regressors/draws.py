"""Values of an effect's parameters drawn from their declared priors."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from radialtire import Effect, Parameter
from scipy.special import ndtr, ndtri
from scipy.stats import qmc

from .scales import Scales

FloatArray = NDArray[np.float64]

LEAST_MASS = 1e-3
"""Part of a prior that must lie within the parameter's bounds, or the prior says nothing there."""


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
    """Return the value of a parameter that follows from the reading: the centre of its prior, within its bounds."""
    return quantile(parameter, 0.5, scales) if parameter.prior is not None else parameter.start


def drawn(effect: Effect, scales: Scales, count: int) -> tuple[list[list[float]], FloatArray]:
    """Return `count` quasi-random sets of values (Sobol), and a number of 0 to 1 for each that sizes it.

    The first half is of the plain form: what it does without stays at its start. Halves of a Sobol sequence fill the
    priors evenly; every other one of its sets would not.
    """
    names = effect.parameters
    shares = qmc.Sobol(len(names) + 1, seed=1).random(count)
    shares = np.clip(shares, 1e-3, 1.0 - 1e-3)
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
