"""Forces of the bodies that are pressed, each in the form that is the shortest to state."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel

FloatArray = NDArray[np.float64]

COEFFICIENT, EXPONENT = 420.0, 1.28
"""The law of the tire on the flat: force [N] at 1 cm, and the power of the deflection."""


def law(deflection: FloatArray, coefficient: float = COEFFICIENT, exponent: float = EXPONENT) -> FloatArray:
    """Force [N] of the tire without anything else."""
    return np.asarray(coefficient * (100.0 * np.maximum(deflection, 0.0)) ** exponent)


def believed(coefficient: float = COEFFICIENT, exponent: float = EXPONENT) -> TireModel:
    """The same law as a simulation has it."""
    return TireModel(PowerLaw(coefficient, exponent), tested_range=None)


def spring(stiffness: float) -> TireModel:
    """A two-sided part: a straight line of `stiffness` [N/m] through 0."""
    return TireModel(PowerLaw(stiffness / 100.0, 1.0), tested_range=None, two_sided=True)


def friction(deflection: FloatArray, reach: float) -> FloatArray:
    """Friction of the height 1: Bouc and Wen's loop with the power 2, which turns over about `reach` [m]."""
    parts = 8
    z = np.zeros_like(deflection)
    for i, step in enumerate(np.diff(deflection) / reach / parts):
        now = z[i]
        for _ in range(parts):
            now = min(max(now + step * (1.0 - max(np.sign(step) * now, 0.0) ** 2), -1.0), 1.0)
        z[i + 1] = now
    return z


def decaying(force: FloatArray, step: float, time_constant: float) -> FloatArray:
    """Force [N] of a spring and a dashpot in series beside an elastic force; exact for a force that changes evenly."""
    kept = np.exp(-step / time_constant)
    passed = (1.0 - kept) * time_constant / step
    found = np.zeros_like(force)
    for i, rise in enumerate(np.diff(force)):
        found[i + 1] = found[i] * kept + rise * passed
    return found


def played(deflection: FloatArray, half: float) -> FloatArray:
    """Deflection [m] behind a play of twice `half` [m]."""
    found = np.zeros_like(deflection)
    for i in range(1, deflection.size):
        found[i] = min(max(found[i - 1], deflection[i] - half), deflection[i] + half)
    return found


def delayed(force: FloatArray, step: float, time_constant: float) -> FloatArray:
    """Force [N] behind a low pass of the first order, settled at the first sample."""
    kept = np.exp(-step / time_constant)
    found = np.copy(force)
    for i in range(1, force.size):
        found[i] = kept * found[i - 1] + (1.0 - kept) * force[i]
    return found
