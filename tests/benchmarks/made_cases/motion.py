"""Motions of a press or a shaker, and what the ground does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, filtfilt

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """Time [s], deflection [m], its rate [m/s] and its acceleration [m/s^2] at each sample."""

    time: FloatArray
    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray

    @property
    def step(self) -> float:
        """Time between samples [s]."""
        return float(self.time[1] - self.time[0])

    def thinned(self, every: int) -> Motion:
        """Return one sample of `every`."""
        return Motion(
            *(a[::every] for a in (self.time, self.deflection, self.rate, self.acceleration)),
        )


def triangle(top: float, speed: float, cycles: int, step: float, hold: float = 0.0) -> Motion:
    """From 0 to `top` [m] and back at one speed [m/s], with a hold [s] at the top of each cycle."""
    way = top / speed
    corners, depths = [0.0], [0.0]
    for _ in range(cycles):
        for duration, depth in ((way, top), (hold, top), (way, 0.0)):
            if duration > 0.0:
                corners.append(corners[-1] + duration)
                depths.append(depth)
    time = np.arange(0.0, corners[-1], step)
    slopes = np.diff(depths) / np.diff(corners)
    rate = np.append(slopes, 0.0)[np.searchsorted(corners, time, "right") - 1]
    return Motion(time, np.interp(time, corners, depths), rate, np.zeros_like(time))


def ramp(top: float, speed: float, step: float) -> Motion:
    """From 0 to `top` [m] once, and not back."""
    time = np.arange(0.0, top / speed, step)
    return Motion(time, speed * time, np.full_like(time, speed), np.zeros_like(time))


def sine(mean: float, amplitude: float, frequency: float, cycles: int, step: float) -> Motion:
    """About `mean` [m], begun at the least deflection; frequency [Hz]."""
    time = np.arange(0.0, cycles / frequency, step)
    turning = 2.0 * np.pi * frequency
    swing = amplitude * np.cos(turning * time)
    return Motion(time, mean - swing, amplitude * turning * np.sin(turning * time), turning * turning * swing)


def rough_ground(
    mean: float, spread: float, duration: float, step: float, rng: np.random.Generator
) -> Motion:
    """Noise of 0.2 to 4 Hz about `mean`, standard deviation `spread` [m], cut where it would leave the ground."""
    time = np.arange(0.0, duration, step)
    b, a = butter(2, [0.2, 4.0], "band", fs=1.0 / step)
    noise = filtfilt(b, a, rng.standard_normal(time.size))
    deflection = np.clip(mean + spread * noise / noise.std(), 0.001, None)
    rate = np.gradient(deflection, time)
    return Motion(time, deflection, rate, np.gradient(rate, time))
