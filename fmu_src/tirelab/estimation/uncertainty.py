"""How well a fit determines its parameters, the error of the forms included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fit import Fit

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
    """Return all fitted parameters.

    Their covariance is that of Laplace's approximation with the variance V of noise and discrepancy.
    """
    slopes = fit.jacobian
    information = slopes.T @ slopes / fit.variance + np.eye(slopes.shape[1])
    spread = np.sqrt(np.diag(np.linalg.inv(information))) if slopes.shape[1] else np.zeros(0)
    found = []
    for p, position, own in zip(fit.problem.parameters, fit.positions, spread, strict=True):
        value = p.value(float(position))
        slope = p.spread * (value if p.logarithm else 1.0)
        found.append(
            Estimate(
                p.owner, p.label, p.unit, value, float(slope * own), bool(own < DETERMINED or p.group > 0)
            )
        )
    return tuple(found)
