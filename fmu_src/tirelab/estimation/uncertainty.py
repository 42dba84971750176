"""How well a fit determines its parameters, the error of the forms included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..regressors.law import LAW
from .fit import Fit
from .free_parameter import COMMON
from .problem import law_surfaces

SHAPE_INDICES = range(2, COMMON)
"""Where the shape stands among the values of a refitted law."""

DETERMINED = 0.5
"""Part of the prior's standard deviation below which the recordings determine a parameter."""


@dataclass(frozen=True)
class Estimate:
    """value and its standard deviation, in the parameter's unit; determined: whether the recordings say more than the
    prior did.
    """

    owner: str
    name: str
    unit: str
    value: float
    deviation: float
    determined: bool


def estimates_of(fit: Fit) -> tuple[Estimate, ...]:
    """Return all fitted parameters; of a refitted law the changes of A and B on each surface.

    Their covariance is that of Laplace's approximation with the variance V of noise and discrepancy, beside the forms'
    errors.
    """
    slopes = fit.jacobian
    if not slopes.shape[1]:
        return ()
    whole = fit.slopes
    covariance = _covariance(whole / np.sqrt(fit.variance))
    spread = np.sqrt(np.diag(covariance))[: slopes.shape[1]]
    found = []
    for p, position, own in zip(fit.problem.parameters, fit.positions, spread, strict=True):
        if p.owner == LAW and p.index not in SHAPE_INDICES:
            continue
        value = p.value(float(position))
        slope = p.spread * (value if p.logarithm else 1.0)
        determined = bool(own < DETERMINED or p.group > 0)
        found.append(Estimate(p.owner, p.label, p.unit, value, float(slope * own), determined))
    return (*_on_surfaces(fit, covariance), *found)


def _covariance(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (S^T S + 1)^-1 from the singular values of S: inverting the sum loses what is small beside the largest."""
    triangle = np.linalg.qr(
        np.concatenate([slopes, np.zeros_like(slopes, shape=(slopes.shape[1],) * 2)]), mode="r"
    )
    _, sizes, ways = np.linalg.svd(triangle)
    return np.asarray(ways.T @ (ways / (1.0 + sizes**2)[:, None]))


def _on_surfaces(fit: Fit, covariance: NDArray[np.float64]) -> list[Estimate]:
    """Return the changes of A and B on each surface: those common to all and its own together."""
    at = {p.index: i for i, p in enumerate(fit.problem.parameters) if p.owner == LAW}
    if not at:
        return []
    dataset = fit.problem.dataset
    surfaces = law_surfaces(dataset)
    found = []
    for number, radius in enumerate(dataset.radii[:surfaces]):
        where = "flat" if np.isinf(radius) else f"{100.0 * radius:.4g} cm"
        where = where if surfaces == len(dataset.radii) else "all surfaces"
        for first, name in ((0, "log factor on A"), (1, "change of B")):
            parts = [i for i in (at.get(first), at.get(COMMON + 2 * number + first)) if i is not None]
            weights = np.array([fit.problem.parameters[i].spread for i in parts])
            value = float(weights @ fit.positions[parts])
            deviation = float(np.sqrt(weights @ covariance[np.ix_(parts, parts)] @ weights))
            found.append(Estimate(LAW, f"{name}, {where}", "1", value, deviation, determined=True))
    return found
