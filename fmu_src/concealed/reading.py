"""Rate and acceleration of a motion estimated from the noisy readings of a gauge, without look-ahead."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import factorial

import numpy as np

from .motion import FloatArray, Motion

#: Numbers of readings through which a polynomial is laid, and degrees beyond the derivative's order.
LENGTHS = (*range(2, 12), 14, 17, 20, 24, 29, 35, 42, 50)
DEGREES = (0, 1, 2)


@dataclass(frozen=True, kw_only=True)
class EstimatedMotion(Motion):
    """A motion whose rate [m/s] and acceleration [m/s^2] are estimates from readings."""

    estimated_rate: FloatArray
    estimated_acceleration: FloatArray

    @cached_property
    def rate(self) -> FloatArray:
        """Estimated deflection rate [m/s]."""
        return self.estimated_rate

    @cached_property
    def acceleration(self) -> FloatArray:
        """Estimated acceleration [m/s^2]."""
        return self.estimated_acceleration


def estimated(motion: Motion, readings: FloatArray) -> EstimatedMotion:
    """The motion with the best estimates of rate and acceleration that its `readings` [m] allow.

    Each estimate is the derivative, at the last reading, of a least-squares polynomial through the last ones. Degree
    and number of readings are those with the least error on this recording; only the rig knows the true motion, so
    only the rig can choose them. Between the readings the error is interpolated linearly.
    """
    time = motion.recorded(motion.time)

    def with_error(order: int, true: FloatArray) -> FloatArray:
        at_readings = motion.recorded(true)
        best = nearest(derivatives(readings, motion.sample_step, order), at_readings)
        return true + np.interp(motion.time, time, best - at_readings)

    return EstimatedMotion(
        motion.name,
        motion.time,
        motion.deflection,
        motion.radius,
        motion.stride,
        motion.burst,
        estimated_rate=with_error(1, motion.rate),
        estimated_acceleration=with_error(2, motion.acceleration),
    )


def derivatives(readings: FloatArray, step: float, order: int) -> Iterable[FloatArray]:
    """Derivatives of an order at every reading: one array for each degree and length of the polynomial.

    readings [m] on an even grid of `step` [s]; they are continued before the first one by odd reflection.
    """
    for degree in (order + d for d in DEGREES):
        for length in LENGTHS:
            if degree < length <= readings.size:
                before = 2.0 * readings[0] - readings[length - 1 : 0 : -1]
                weights = _weights(step, order, degree, length)
                # the weights of a derivative sum to zero; without the offset rounding errors stay small
                yield np.convolve(
                    np.concatenate([before, readings]) - readings[0], weights[::-1], mode="valid"
                )


@lru_cache(maxsize=1024)
def _weights(step: float, order: int, degree: int, length: int) -> FloatArray:
    """Weights of the last readings, the oldest first, in a derivative of their least-squares polynomial."""
    ages = step * np.arange(1 - length, 1)
    weights: FloatArray = (
        factorial(order) * np.linalg.pinv(np.vander(ages, degree + 1, increasing=True))[order]
    )
    weights.flags.writeable = False
    return weights


def nearest(candidates: Iterable[FloatArray], true: FloatArray) -> FloatArray:
    """The candidate with the least squared error."""
    return min(candidates, key=lambda s: float(np.sum((s - true) ** 2)))
