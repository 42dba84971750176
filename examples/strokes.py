"""Strokes of a damper and of pistons, which pull and push: reading them, their loops, and what pressure does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel
from tirelab.identification.part_tire import LEAST_SPRING
from tirelab.recordings.recording import Recording, read_recording
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]


def signed(path: Path, columns: dict[str, str], units: dict[str, str]) -> Recording:
    """A recording with the signs of its file: for a part that pulls, none can be inferred."""
    kept = {name: column if name == "time" else f"+{column}" for name, column in columns.items()}
    kept |= {name: column for name, column in columns.items() if name == "pressure"}
    return read_recording(path, columns=kept, units=units, radius="flat")


BARS = (1, 3, 5, 7)
"""The pressures [bar] at which the piston was driven."""


def piston_recordings(folder: Path) -> dict[int, Recording]:
    """The recordings of the piston by their pressure [bar]."""
    return {bar: piston_recording(folder / f"O-ring_{bar}bar.csv") for bar in BARS}


def piston_recording(path: Path) -> Recording:
    """The recording of a piston, whatever its seal."""
    columns = {"time": "#1", "deflection": "#5", "pressure": "#6", "force": "#7"}
    units = {"time": "ms", "deflection": "mm", "pressure": "bar", "force": "N"}
    return signed(path, columns, units)


def preloaded(force: float) -> TireModel:
    """A part without a spring that presses with a constant force [N]."""
    return TireModel(PowerLaw(LEAST_SPRING, 1.0), tested_range=None, two_sided=True, preload=force)


def gain_per_bar(part: TireModel, recording: Recording) -> float:
    """By how much the simulated mean force [N] grows from 2 to 6 bar on the motion of a recording, for each bar."""
    means = [
        float(simulate(part, replace(recording, pressure=np.full(len(recording), 1e5 * bar))).mean())
        for bar in (2.0, 6.0)
    ]
    return (means[1] - means[0]) / 4.0


def slope_per_bar(files: list[Recording]) -> float:
    """Slope of force over pressure [N/bar] by least squares; with several files over their means."""
    pairs = [(f.pressure, f.force) for f in files if f.pressure is not None]
    if len(pairs) > 1:
        pairs = [(np.array([p.mean() for p, _ in pairs]), np.array([f.mean() for _, f in pairs]))]
    pressure, force = pairs[0]
    return float(np.polyfit(pressure / 1e5, force, 1)[0])


def half_loop(file: Recording, margin: float) -> float:
    """Half the height of the loop [N], its mean over the stroke without a `margin` (part of the stroke) at each end."""
    rate = smooth_rate(file)
    x = (file.deflection - file.deflection.min()) / np.ptp(file.deflection)
    inside = (x > margin) & (x < 1.0 - margin)
    ways = [file.force[inside & (sign * rate > 3e-3)].mean() for sign in (1.0, -1.0)]
    return float(abs(ways[0] - ways[1]) / 2.0)


def smooth_rate(file: Recording) -> FloatArray:
    """Rate of the deflection [m/s], smoothed over 15 samples of a coarsely digitised gauge."""
    return np.convolve(np.gradient(file.deflection, file.time), np.ones(15) / 15.0, "same")
