"""The motion that the actuator makes, on a grid finer than the recording's."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
AnyArray = TypeVar("AnyArray", FloatArray, BoolArray)

#: Steps of the fine grid are at most this long [s] where the number of samples allows it.
FINEST_STEP = 0.01
MOST_FINE_SAMPLES = 16_000
MOST_STRIDE = 16


@dataclass(frozen=True)
class Motion:
    """A true, noise-free motion of the actuator against one surface after the other.

    time [s], deflection [m] as a perfect gauge would read it, radius [m] of the surface (convex > 0); all of
    one shape on an even grid. `stride`: every stride-th sample is recorded. `burst`: a span of time [s] in
    which alone the motion is fast, if there is one. `blurred`: samples at which no analysis of the readings can know
    the rate, where that was looked into (see `equivalence`).
    """

    name: str
    time: FloatArray
    deflection: FloatArray
    radius: FloatArray
    stride: int = 1
    burst: tuple[float, float] | None = None
    blurred: BoolArray | None = None

    @property
    def step(self) -> float:
        """Step of the fine grid [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def duration(self) -> float:
        """From the first to the last sample [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def sample_step(self) -> float:
        """Step of the recording [s]."""
        return self.step * self.stride

    @cached_property
    def rate(self) -> FloatArray:
        """Deflection rate [m/s], from a cubic spline through the clean motion."""
        spline = make_interp_spline(self.time, self.deflection, k=3)
        return np.asarray(spline.derivative()(self.time), dtype=np.float64)

    @cached_property
    def acceleration(self) -> FloatArray:
        """Acceleration of the actuator [m/s^2], from a quintic spline through the clean motion."""
        spline = make_interp_spline(self.time, self.deflection, k=5)
        return np.asarray(spline.derivative(2)(self.time), dtype=np.float64)

    @cached_property
    def surfaces(self) -> tuple[float, ...]:
        """Distinct radii [m] in the order of their curvature, from concave to convex."""
        return tuple(sorted({float(r) for r in np.unique(self.radius)}, key=lambda r: 1.0 / r))

    def recorded(self, values: AnyArray) -> AnyArray:
        """The recorded samples of something known on the fine grid."""
        return values[:: self.stride]


def even_grid(samples: int, step: float) -> FloatArray:
    """Times 0, h, 2 h, ... [s] on an even grid of step h [s]."""
    return np.arange(samples, dtype=np.float64) * step


def stride_for(sample_step: float, samples: int) -> int:
    """How many fine steps make one sample: enough to resolve corners and short memories, not more."""
    wanted = math.ceil(sample_step / FINEST_STEP - 1e-9)
    return max(1, min(wanted, MOST_STRIDE, MOST_FINE_SAMPLES // samples))


def rounded(path: FloatArray, step: float, blend: float) -> FloatArray:
    """A path with its corners rounded by two running means of the given length.

    A servo-hydraulic actuator cannot turn on the spot: each mean of length `blend` [s] bounds the next higher
    derivative, so that the acceleration stays continuous. The ends are held.
    """
    width = round(blend / step)
    if width < 2:
        return path
    box = np.full(width, 1.0 / width)
    for lead in (width // 2, width - 1 - width // 2):
        padded = np.concatenate([np.full(lead, path[0]), path, np.full(width - 1 - lead, path[-1])])
        path = np.convolve(padded, box, mode="valid")
    return path
