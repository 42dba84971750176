"""Recordings for tests, made with numpy alone: the article's flat tire, driven in a few ways."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tirelab.recordings.recording import Recording
from tirelab.recordings.writing import write_recording

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Drive:
    """A recording: arrays of one length, in SI."""

    name: str
    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    force: FloatArray


def flat_force(deflection: FloatArray) -> FloatArray:
    """Return 550.9 x^1.422, x in cm: equations 2, 5a and 6a on flat ground."""
    return np.asarray(550.9 * np.maximum(100.0 * deflection, 0.0) ** 1.422)


def ride(seed: int, samples: int = 6000, step: float = 0.005) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return time [s], deflection [m] of eight sines between 0.1 and 4 Hz about 12 mm, and its rate [m/s]."""
    rng = np.random.default_rng(seed)
    time = np.arange(samples) * step
    frequencies = np.geomspace(0.1, 4.0, 8)
    phases = rng.uniform(0.0, 2.0 * np.pi, 8)
    waves = 2.0 * np.pi * frequencies * time[:, None] + phases
    amplitude = 0.0022 / np.sqrt(1.0 + frequencies)
    deflection = 0.0115 + (amplitude * np.sin(waves)).sum(axis=1)
    rate = (amplitude * 2.0 * np.pi * frequencies * np.cos(waves)).sum(axis=1)
    return time, deflection, rate


def triangle(samples: int = 1200, step: float = 0.02, period: float = 4.0) -> tuple[FloatArray, FloatArray]:
    """Return time [s] and deflection [m] of a triangle to 23 mm at one constant rate."""
    time = np.arange(samples) * step
    return time, 0.023 * (1.0 - np.abs(1.0 - 2.0 * (time / period % 1.0)))


def read(
    name: str, time: FloatArray, deflection: FloatArray, force: FloatArray, seed: int, noise: float = 5.0
) -> Drive:
    """Return a recording on flat ground with white noise of `noise` [N] on the force and 5 um on the deflection."""
    rng = np.random.default_rng(seed)
    shown = deflection + 5e-6 * rng.standard_normal(time.size)
    return Drive(
        name, time, shown, np.full(time.size, np.inf), force + noise * rng.standard_normal(time.size)
    )


def damped(seed: int, damping: float = 500.0, samples: int = 6000) -> Drive:
    """A ride on a tire with viscous damping [N s/m], under 5 N of noise."""
    time, deflection, rate = ride(seed, samples=samples)
    return read(f"ride {seed}", time, deflection, flat_force(deflection) + damping * rate, seed)


def saved(drive: Drive, file: Path) -> Path:
    """Write a drive as a recording file."""
    write_recording(
        Recording(file.stem, drive.time, drive.deflection, drive.surface_radius, drive.force), file
    )
    return file


def long_ride(samples: int) -> tuple[list[Recording], list[FloatArray], list[FloatArray]]:
    """Return a recording of a linear tire at 1 kHz, with its force before and after a damper: what a report draws."""
    rng = np.random.default_rng(3)
    time = np.arange(samples) * 1e-3
    x = 0.012 * (1.0 - np.cos(3.0 * time + 0.7 * np.sin(0.11 * time)))
    before = 9e4 * x
    after = before + 200.0 * np.gradient(x, time)
    force = after + rng.normal(0.0, 5.0, samples)
    return [Recording("long", time, x, np.full(samples, np.inf), force)], [before], [after]
