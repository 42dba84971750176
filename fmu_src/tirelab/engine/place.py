"""A recording at a point of the search: what deflection the tire has, and what elastic force and tangent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..preprocessing.dataset import LEAST_CM
from ..preprocessing.kinematics import BoolArray, FloatArray, IndexArray
from .scene import Record, Scene

Value = TypeVar("Value", np.float64, np.bool_)


@dataclass(frozen=True)
class Point:
    """Where the columns are taken.

    shape (surfaces, 4): coefficients of log(force/law) in powers of the logarithm of the deflection
    offset [m]; compliance [m/N]; lag [s] and the order of its low-pass, 0 for a pure delay
    lifted: for each recording, where the tire has lost the ground: it cannot pull, so that nothing acts there
    beside [N]: for each recording, what the set adds to the elastic force before the reading reaches its ceiling
    """

    shape: FloatArray
    offset: float = 0.0
    compliance: float = 0.0
    lag: float = 0.0
    stages: int = 0
    lifted: tuple[BoolArray, ...] | None = None
    beside: tuple[FloatArray, ...] | None = None


@dataclass(frozen=True)
class Place:
    """One recording at a point: deflection of the tire, elastic force [N], its tangents, and the scales.

    before_reading [N]: the force that the load cell would read if it had no ceiling
    """

    record: Record
    scene: Scene
    deflection: FloatArray
    elastic: FloatArray
    stiffness: FloatArray
    logarithm: FloatArray
    before_reading: FloatArray
    rows: IndexArray | None = None

    def taken(self, column: FloatArray) -> FloatArray:
        """Return what of a column is wanted: its `rows`, or all of it."""
        return column if self.rows is None else column[self.rows]


POWERS = 4


def logarithm_of(deflection: FloatArray, deepest: float) -> FloatArray:
    """Return log(x / x_half) with x_half half the largest deflection, held below LEAST_CM."""
    return np.log(np.maximum(100.0 * deflection, LEAST_CM) / (50.0 * deepest))


def place_at(record: Record, scene: Scene, point: Point) -> Place:
    """Return the recording at the point: x = x_read + offset - compliance * force, force = law * exp(shape)."""
    x = record.motion.deflection + point.offset

    def elastic(deflection: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        logarithm = logarithm_of(deflection, scene.deepest)
        coefficients = record.surface @ point.shape
        exponent = np.zeros_like(deflection)
        slope = np.zeros_like(deflection)
        for power in range(POWERS):
            exponent += coefficients[:, power] * logarithm**power
            if power:
                slope += power * coefficients[:, power] * logarithm ** (power - 1)
        factor = np.exp(np.clip(exponent, -3.0, 3.0))
        force = record.elastic(deflection) * factor
        loaded = np.maximum(deflection, 1e-2 * LEAST_CM)
        stiffness = np.where(
            deflection > 0.0, record.stiffness(deflection) * factor + force * slope / loaded, 0.0
        )
        return force, stiffness, logarithm

    deflection = x
    if point.compliance != 0.0:
        for _ in range(6):
            force, stiffness, _ = elastic(deflection)
            gap = deflection + point.compliance * force - x
            deflection = deflection - gap / np.maximum(1.0 + point.compliance * stiffness, 0.2)
    force, stiffness, logarithm = elastic(deflection)
    if point.compliance != 0.0:
        stiffness = stiffness / np.maximum(1.0 + point.compliance * stiffness, 0.2)
    whole = force
    if point.beside is not None:
        whole = force + nearest(record, point.beside[record.number])
    return Place(record, scene, deflection, force, stiffness, logarithm, whole)


def nearest(record: Record, values: NDArray[Value]) -> NDArray[Value]:
    """Return at every sample of a recording what is known at its thin ones."""
    if values.size == record.time.size:
        return values
    every = max(int(record.rows[1] - record.rows[0]), 1)
    return values[np.minimum(np.arange(record.time.size) // every, values.size - 1)]
