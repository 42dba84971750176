"""The noise floor of a recording: the root mean square of all sources of noise together over its samples.

amplifier: noise of the force's reading; one that steps by q errs by q / sqrt(12) at least, as a gauge does
gauge:     noise of the deflection's reading times the stiffness
steps:     a gauge that steps by q leaves stiffness x q / sqrt(12)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .noise import NEGLIGIBLE

FloatArray = NDArray[np.float64]


SHARE_OF_STEP = 1.0 / float(np.sqrt(12.0))
"""Root mean square error of a reading that is rounded to steps, in steps."""


@dataclass(frozen=True)
class NoiseFloor:
    """amplifier, gauge, steps [N]: root mean squares at the recorded samples; step [m] of the gauge, 0: none seen."""

    amplifier: float
    gauge: float
    steps: float
    step: float

    @property
    def level(self) -> float:
        """The whole noise floor [N]: root of the sum of squares."""
        return float(np.sqrt(self.amplifier**2 + self.gauge**2 + self.steps**2))


def noise_floor(
    level: float, stiffness: FloatArray, gauge_noise: float, step: float, force_step: float
) -> NoiseFloor:
    """Return the floor of a recording.

    level [N]: noise of the force less what a smooth model makes of it; stiffness [N/m] sample by sample
    gauge_noise [m]: of the deflection's reading; step [m], force_step [N]: in which the two are read, 0 for none
    """
    mean_square = float(np.sqrt(np.mean(stiffness**2)))
    through_gauge = 0.0 if step > 0.0 else gauge_noise * mean_square
    through_steps = step * SHARE_OF_STEP * mean_square
    whole = max(level, force_step * SHARE_OF_STEP)
    amplifier = float(np.sqrt(max(whole**2 - through_gauge**2, NEGLIGIBLE * whole**2)))
    return NoiseFloor(amplifier, through_gauge, through_steps, step)
