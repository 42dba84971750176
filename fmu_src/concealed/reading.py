"""What a gauge tells of a motion: its rate and acceleration, from noisy readings and without look-ahead."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np

from concealed.motion import FloatArray, Motion

#: Numbers of readings through which a polynomial is laid, and degrees beyond the derivative's order.
LENGTHS = (*range(2, 12), 14, 17, 20, 24, 29, 35, 42, 50)
DEGREES = (0, 1, 2)


@dataclass(frozen=True, kw_only=True)
class Told(Motion):
    """A motion of which rate [m/s] and acceleration [m/s^2] are those that the readings tell."""

    told_rate: FloatArray
    told_acceleration: FloatArray

    @cached_property
    def rate(self) -> FloatArray:
        """Deflection rate [m/s] as it was told."""
        return self.told_rate

    @cached_property
    def acceleration(self) -> FloatArray:
        """Acceleration [m/s^2] as it was told."""
        return self.told_acceleration


def told(motion: Motion, shown: FloatArray) -> Told:
    """The motion with the rate and the acceleration that its readings `shown` [m] tell at best.

    Each is the derivative, at the last reading, of the least-squares polynomial through the last ones; degree and
    number of readings are those that come nearest to the truth on this very recording, which only the rig can
    know. Between the readings the error goes straight on.
    """
    time = motion.recorded(motion.time)

    def with_error(order: int, true: FloatArray) -> FloatArray:
        at_readings = motion.recorded(true)
        best = nearest(derivatives(shown, motion.sample_step, order), at_readings)
        return true + np.interp(motion.time, time, best - at_readings)

    return Told(
        motion.name,
        motion.time,
        motion.deflection,
        motion.radius,
        motion.stride,
        motion.burst,
        told_rate=with_error(1, motion.rate),
        told_acceleration=with_error(2, motion.acceleration),
    )


def derivatives(shown: FloatArray, step: float, order: int) -> Iterable[FloatArray]:
    """Derivatives of an order at every reading: one series for each degree and length of the polynomial.

    shown [m] on an even grid of `step` [s]; before the first reading it came the way it went on (odd about it).
    """
    for degree in (order + d for d in DEGREES):
        for length in LENGTHS:
            if degree < length <= shown.size:
                ages = step * np.arange(1 - length, 1)
                weights = (
                    factorial(order) * np.linalg.pinv(np.vander(ages, degree + 1, increasing=True))[order]
                )
                before = 2.0 * shown[0] - shown[length - 1 : 0 : -1]
                # the weights of a derivative add up to nothing: away from zero rounding would be heard
                yield np.convolve(np.concatenate([before, shown]) - shown[0], weights[::-1], mode="valid")


def nearest(series: Iterable[FloatArray], true: FloatArray) -> FloatArray:
    """The series with the least squared error."""
    return min(series, key=lambda s: float(np.sum((s - true) ** 2)))
