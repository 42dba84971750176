"""The noise floor of a recording, source by source.

    amplifier: noise of the force's reading; one that steps by q errs by q / sqrt(12) at least, as a gauge does
    gauge:     noise of the deflection's reading times the stiffness
    steps:     a gauge that steps by q leaves stiffness x q / sqrt(12) (B. Widrow, Stat. theory of quantization, 1996)

What is left by the best tire cannot be less than all of them together, counted on the recorded samples.

A filter before the converter smooths the noise of a force: neighbours err alike. How many do so shows in differences
over growing lags, which rise until the lag is the noise's memory and then stay, where a smooth misfit rises on
(variogram: G. Matheron, Economic Geology 58 (1963) 1246-1266; third differences in place of first ones). What comes
again at the same deflection is no noise, however quick it is: a ripple of the tread (analysis of variance of visits).
Nor is what comes again on the same way from a turn: the knee of a loop, which a linear model follows in part.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.signal import savgol_filter
from scipy.stats import f

from ..preprocessing.robust_scale import trimmed_sigma

FloatArray = NDArray[np.float64]

SHARE_OF_STEP = 1.0 / float(np.sqrt(12.0))
"""Root mean square error of a reading that is rounded to steps, in steps."""

STAYS = float(np.sqrt(2.0) ** 0.5)
"""Growth of the differences for a doubled lag below which they stay: half the exponent of a random walk, the roughest
noise that has a memory."""

FEWEST_LAGS = 20
"""Lags that a recording holds at least: noise that is independent a lag apart has its scale known to a sixth then."""

FEWEST_CELLS = 8
"""Cells, and visits beyond the first of each, from which on visits are compared: two degrees of freedom."""

AGAIN = 0.01
"""Level of the test that what is quick comes again at the same deflection."""


@dataclass(frozen=True)
class NoiseFloor:
    """amplifier, gauge, steps [N]: root mean squares at the recorded samples; step [m] of the gauge, 0: none seen."""

    amplifier: float
    gauge: float
    steps: float
    step: float

    @property
    def level(self) -> float:
        """All of it [N]."""
        return float(np.sqrt(self.amplifier**2 + self.gauge**2 + self.steps**2))


@dataclass(frozen=True)
class Noise:
    """level: standard deviation of a sample; memory: samples from one to the next that errs independently."""

    level: float
    memory: int


def white_level(residual: FloatArray, lag: int = 1) -> float:
    """Return the standard deviation of what differs between samples `lag` apart, from third differences."""
    if residual.size < 3 * lag + 5:
        return float(np.std(residual))
    ends = residual[3 * lag :] - residual[: -3 * lag]
    inner = residual[2 * lag : -lag] - residual[lag : -2 * lag]
    return trimmed_sigma(ends - 3.0 * inner) / float(np.sqrt(20.0))


def noise_of(residual: FloatArray, smooth: float, deflection: FloatArray) -> Noise:
    """Return the noise of a residual, white or with a memory.

    smooth: samples over which what is no noise is smooth, so that its differences rise on; deflection [m]: beside them
    """
    levels = [white_level(residual)]
    # Twice as far a smooth misfit still rises: a level that does not is a noise's.
    while 2 ** len(levels) <= 2.0 * smooth and residual.size >= FEWEST_LAGS * 2 ** len(levels):
        levels.append(white_level(residual, 2 ** len(levels)))
    rises = [after >= STAYS * before for before, after in itertools.pairwise(levels)]
    # One doubling without a rise may be chance between two rises: a level holds over a factor of four.
    last = max((i + 1 for i, pair in enumerate(itertools.pairwise(rises)) if not any(pair)), default=0)
    risen = [i for i in range(last) if rises[i]]
    if not risen or _comes_again(residual, deflection, 2 ** (risen[-1] + 1)):
        return Noise(levels[0], 1)
    return Noise(levels[last], 2 ** (risen[-1] + 1))


def _comes_again(residual: FloatArray, deflection: FloatArray, memory: int) -> bool:
    """Return whether what is quicker than a few memories is alike at every visit of the same deflection, whatever the
    direction or in each of them, or as far from the last turn.
    """
    quick = residual - savgol_filter(residual, 6 * memory + 1, 3)
    way = float(np.median(np.abs(deflection[memory:] - deflection[:-memory])))
    width = max(0.5 * way, 1e-6 * float(np.ptp(deflection)), 1e-300)
    cell = 2 * ((deflection - deflection.min()) / width).astype(int)
    inwards = np.gradient(uniform_filter1d(deflection, 2 * memory + 1, mode="nearest")) > 0.0
    begin = np.append(0, np.flatnonzero(np.diff(inwards)) + 1)
    turn = begin[np.searchsorted(begin, np.arange(deflection.size), side="right") - 1]
    gone = 2 * (np.abs(deflection - deflection[turn]) / width).astype(int)
    places = cell, cell + inwards, gone + inwards
    return min(_chance_of_cells(quick, place, 4 * memory) for place in places) < AGAIN / len(places)


def _chance_of_cells(values: FloatArray, cell: NDArray[np.int_], apart: int) -> float:
    """Return the chance that means of independent visits differ as much between cells; 1 for too few visits.

    A visit is the way through one cell, half a memory; one that follows another within `apart` samples does not count.
    Neighbours within two memories are not independent: the degrees of freedom are a quarter of their number.
    """
    begin = np.flatnonzero(np.diff(cell, prepend=-1))
    mean = np.add.reduceat(values, begin) / np.diff(begin, append=values.size)
    order = np.lexsort((begin, cell[begin]))
    begin, mean = begin[order], mean[order]
    counts = (np.diff(cell[begin], prepend=-1) != 0) | (np.diff(begin, prepend=0) > apart)
    begin, mean = begin[counts], mean[counts]
    _, number, visits = np.unique(cell[begin], return_inverse=True, return_counts=True)
    several = visits[number] > 1
    cells, within = int(np.sum(visits > 1)), int(np.sum(several)) - int(np.sum(visits > 1))
    if min(cells, within) < FEWEST_CELLS:
        return 1.0
    middle = np.bincount(number, mean) / visits
    left = float(np.sum((mean - middle[number])[several] ** 2)) / within
    between = float(np.sum((middle[number] - mean[several].mean())[several] ** 2)) / (cells - 1)
    return float(f.sf(between / max(left, 1e-300), (cells - 1) / 4.0, within / 4.0))


def noise_floor(
    level: float, stiffness: FloatArray, gauge_noise: float, step: float, force_step: float
) -> NoiseFloor:
    """Return the floor of a recording.

    level [N]: noise of the force less what a smooth model makes of it; stiffness [N/m] sample by sample
    gauge_noise [m]: of the deflection's reading; step [m], force_step [N]: in which the two are
    read, 0 where none is seen
    """
    mean_square = float(np.sqrt(np.mean(stiffness**2)))
    through_gauge = 0.0 if step > 0.0 else gauge_noise * mean_square
    through_steps = step * SHARE_OF_STEP * mean_square
    whole = max(level, force_step * SHARE_OF_STEP)
    amplifier = float(np.sqrt(max(whole**2 - through_gauge**2, 0.05 * whole**2)))
    return NoiseFloor(amplifier, through_gauge, through_steps, step)
