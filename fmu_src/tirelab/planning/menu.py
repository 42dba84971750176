"""The motions that a plan chooses from: every waveform in a few lengths on every surface of the rig."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from scipy.ndimage import median_filter

from ..preprocessing.noise import Noise
from ..preprocessing.noise_floor import NoiseFloor
from ..recordings.description import surface_text
from ..regressors.experiment import Blocks, Experiment
from ..simulation.simulate import simulate
from .rig import Rig
from .waveforms import CORNER, MENU, motion, sample_times

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

LENGTHS = (1 / 16, 1 / 8, 1 / 4)
"""Lengths of a motion, as parts of the rig's time."""

FINENESS = 15
"""Rows in which a whole stroke at the fastest rate of a motion is simulated."""

TURN, AROUND = 3.0, 3 * CORNER + 7
"""The motion turns too fast to be compared where its acceleration exceeds this many times the median of so many samples
around, a third of which a corner takes. An actuator rounds it in its own way, so a plan does not build on it.
"""

ROUNDING = 1e-6
"""A jump of this part of the fastest rate is one of rounding."""

ALLOWED = 1.02
"""A difference of samples exceeds a sine's own rate by rounding only."""

SLOW = "slow triangles"
"""The motion that is driven at another pressure than the first."""

FEWEST = 32
"""Samples of a motion at least."""


@dataclass(frozen=True)
class Drive:
    """One recording to be made: arrays of one length; pressure [Pa] that is held, None: as it is."""

    name: str
    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    pressure: float | None = None

    @property
    def measured(self) -> Mapping[str, FloatArray]:
        """The channels that are held: the pressure, where the rig can hold one."""
        return {} if self.pressure is None else {"pressure": np.full(self.time.size, self.pressure)}

    @property
    def duration(self) -> float:
        """Time [s] that it takes."""
        return float(self.time[-1] - self.time[0]) + float(self.time[1] - self.time[0])

    @property
    def fastest(self) -> float:
        """Largest rate [m/s]."""
        return float(np.abs(np.diff(self.deflection) / np.diff(self.time)).max())

    @property
    def surface(self) -> str:
        """The surface in words."""
        return surface_text(self.surface_radius)


def drive_of(waveform: str, part: float, radius: float, rig: Rig, pressure: float | None = None) -> Drive:
    """Return a motion of MENU that takes a part of the rig's time on a surface [m]."""
    limits = rig.limits(part * rig.time)
    path = motion(MENU[waveform], limits)
    return Drive(waveform, sample_times(limits), path, np.full(path.size, radius), pressure)


def menu(rig: Rig, lengths: Sequence[float] = LENGTHS) -> tuple[Drive, ...]:
    """Return all motions that keep within the limits of the rig: at its first pressure, and slow triangles on the first
    surface at each other one. lengths: as parts of the rig's time
    """
    pressure = rig.pressures[0] if rig.pressures else None
    found = []
    for radius in rig.surfaces:
        for waveform in MENU:
            for part in lengths:
                if part * rig.time / rig.sampling < FEWEST:
                    continue
                drive = drive_of(waveform, part, radius, rig, pressure)
                if drive.fastest <= ALLOWED * rig.speed:
                    found.append(drive)
    sizes = {len(d.time) for d in found}
    others = [drive_of(SLOW, part, rig.surfaces[0], rig, p) for p in rig.pressures[1:] for part in lengths]
    return (*found, *(d for d in others if len(d.time) in sizes and d.fastest <= ALLOWED * rig.speed))


def experiment_of(drive: Drive, tire: TireModel, noise: float) -> Experiment:
    """Return a drive as it would be compared: in rows that follow it, without misfit; noise [N] of a row's mean."""
    rate = np.gradient(drive.deflection, drive.time)
    acceleration = np.gradient(rate, drive.time)
    step = float(drive.time[1] - drive.time[0])
    fastest = max(float(np.abs(rate).max()), 1e-12)
    stroke = max(float(np.ptp(drive.deflection)), 1e-12)
    stride = int(max(1.0, stroke / (FINENESS * fastest * step)))
    away = _away(_corners(acceleration, fastest / step), stride)
    rows = slice(stride // 2, None, stride)
    moved = Drive(
        drive.name, drive.time[rows], drive.deflection[rows], drive.surface_radius[rows], drive.pressure
    )
    return Experiment(
        name=drive.name,
        time=moved.time,
        deflection=moved.deflection,
        rate=rate[rows],
        acceleration=acceleration[rows],
        surface_radius=moved.surface_radius,
        baseline=simulate(tire, moved, _Kinematics(rate[rows], acceleration[rows])),
        misfit=np.zeros(moved.time.size),
        counts=away[rows],
        noise=noise / float(np.sqrt(stride)),
        least_noise=0.0,
        resting=0.0,
        floor=NoiseFloor(noise, 0.0, 0.0, 0.0),
        gauge=0.0,
        blocks=Blocks(stride, np.arange(moved.time.size)),
        interval=step * stride,
        reading=Noise(noise, 1),
        measured=moved.measured,
    )


@dataclass(frozen=True)
class _Kinematics:
    rate: FloatArray
    acceleration: FloatArray


def _corners(acceleration: FloatArray, largest: float) -> BoolArray:
    """Return where the rate jumps; largest [m/s^2]: a jump of the fastest rate in one sample."""
    size = np.abs(acceleration)
    usual = median_filter(size, AROUND, mode="constant")
    return np.asarray(size > TURN * usual + ROUNDING * largest)


def _away(corner: BoolArray, reach: int) -> BoolArray:
    """Return where no corner lies within `reach` samples; everywhere where corners are everywhere."""
    away = np.asarray(np.convolve(corner, np.ones(2 * reach + 1), "same") < 0.5)
    return away if away.mean() > 0.5 else np.ones_like(away)


def peak_force(drives: Sequence[Drive], tire: TireModel) -> float:
    """Return the largest force [N] of the tire over all drives."""
    return max(float(simulate(tire, d).max()) for d in drives)
