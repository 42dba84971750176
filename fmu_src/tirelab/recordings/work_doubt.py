"""Whether a part gives out energy: then one of the gauges may count the other way, or the columns be exchanged."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .samples import longest_unbroken
from .sign_convention import CLEAR, loading_share, work_share
from .zero import ZEROED, Gauges

FloatArray = NDArray[np.float64]


def work_doubt(
    gauges: Gauges, time: FloatArray, deflection: FloatArray, force: FloatArray, part: bool
) -> str:
    """Return a sentence where the part gives out energy in every cycle, "" where it does not.

    part: not a tire; then also where its force falls on the way to the largest one, if it makes no whole cycle
    What it did in a gap of the time is not known where it is elsewhere after it, so cycles are whole within the longest
    stretch without such a gap only.
    """
    unbroken = longest_unbroken(time, deflection)
    share = work_share(deflection[unbroken], force[unbroken])
    if share < -CLEAR:
        return (
            f"the loops of force over deflection run backwards: {-share:.0%} of the work comes out of the part, and "
            f"nothing passive gives out energy; {_backwards(gauges)}"
        )
    if not (part and np.isnan(share) and loading_share(deflection, force) < -CLEAR):
        return ""
    turned = "deflection" if force[np.argmax(np.abs(force))] > 0.0 else "force"
    return (
        "the force falls as the deflection grows, up to the largest one; is one of the two counted the other way? "
        f"Then {gauges.signed(flipped=turned)} turns the {turned}"
    )


def _backwards(gauges: Gauges) -> str:
    """Return what may be wrong where loops run backwards, and what to write: exchanged columns turn a loop, too."""
    turns = f"{gauges.signed(flipped='force')} turns the force"
    if not all(gauges.names[name].startswith("#") for name in ZEROED):
        return f"is one of the two counted the other way? Then {turns}"
    exchanged = gauges.origin.columns(deflection=gauges.names["force"], force=gauges.names["deflection"])
    return (
        "nothing names the columns: are they exchanged, or is one counted the other way? "
        f"{exchanged} exchanges them, {turns}"
    )
