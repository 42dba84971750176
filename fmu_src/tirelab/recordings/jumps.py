"""A jump of the deflection between two samples, as where two runs stand one below the other in a table."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FAR = 10.0
"""A jump is this many times as far as the motion between any two other samples; a corner of a motion is none."""

BOTH = 0.5
"""Part of the jump that the motion covers before and after it at least: a step between two holds is driven."""

FEWEST = 20
"""Samples of a run at least."""


def jump_doubt(deflection: NDArray[np.float64]) -> tuple[tuple[int, str], ...]:
    """Return the sample after a jump between two runs and a sentence, none without one; deflection (n,) [m]."""
    moved = np.abs(np.diff(deflection))
    if moved.size < 2 * FEWEST:
        return ()
    at = int(np.argmax(moved))
    jump, other = float(moved[at]), float(np.max(np.delete(moved, at)))
    before, after = deflection[: at + 1], deflection[at + 1 :]
    covered = min(float(np.ptp(before)), float(np.ptp(after)))
    if min(before.size, after.size) < FEWEST or not 0.0 < FAR * other < jump or covered < BOTH * jump:
        return ()
    said = (
        f"the deflection jumps by {1e3 * jump:.3g} mm from the sample before, {jump / other:.0f} times as far as "
        "between any two others: if these are two runs in one table, give the rows of one of them, as in FILE@1:2000"
    )
    return ((at + 1, said),)
