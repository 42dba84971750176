"""Whether a law leaves more than the noise of the readings: then something else acts in the recordings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..names import plain
from ..preprocessing.data_checks import PoorRecording, check_recordings
from ..preprocessing.driven import Driven
from ..preprocessing.motion import motion_of
from ..preprocessing.noise import noise_of
from ..preprocessing.samples import is_timed, surface_numbers
from ..recordings.recording import Recording

Array = NDArray[np.float64]

MISFIT = 1.5
"""A law misfits where it leaves this many times the noise of the readings: their error is known to a few percent."""

SAMPLES_LEAST = 50
"""With fewer samples of a recording the noise is not taken from it."""

SAMPLES_MOST = 100_000
"""Budget: samples of a recording, the first ones, that show its noise."""


def noise_beside(recordings: Sequence[Recording], residuals: Sequence[Array]) -> float:
    """Return the noise of the readings [N], root mean square over the recordings; NaN where they are too short.

    It is the noise that a diagnosis finds in a residual [N]: one that a filter smoothed counts whole, and what comes
    again at the same deflection is none. The noise of the deflection, passed on by the stiffness, is in it.
    """
    squares, samples = 0.0, 0
    for recording, residual in zip(recordings, residuals, strict=True):
        if residual.size < SAMPLES_LEAST:
            continue
        first = slice(0, SAMPLES_MOST)
        motion = motion_of(recording.time[first], recording.deflection[first], timed=is_timed([recording]))
        (surface,) = surface_numbers([recording.surface_radius[first]])
        interval = float(np.median(np.diff(recording.time)))
        driven = Driven(interval, motion.deflection, motion.rate, motion.acceleration, surface)
        squares += residual.size * noise_of(residual[first], driven).level ** 2
        samples += residual.size
    return float(np.sqrt(squares / samples)) if samples else float("nan")


def diagnosis_refused(recordings: Sequence[Recording], *, part: bool) -> str:
    """Return why no diagnosis takes recordings, "" where one does; part: whether they are of one that can pull."""
    try:
        check_recordings(recordings, two_sided=part)
    except PoorRecording as error:
        return str(error)
    return ""


def misfit_sentence(
    rmse: float, noise: float, command: str = "", law: str = "the law", refused: str = ""
) -> str:
    """Return the sentence for a law that leaves more than the noise, both [N], "" where it does not.

    command: that looks for what is missing, where one was typed; law: what it is called; refused: why no diagnosis
    takes such recordings
    """
    if not noise > 0.0 or rmse < MISFIT * noise:
        return ""
    step = f"try `{command}`" if command else "diagnose the recordings with this tire"
    step = f"but no diagnosis can say what: {refused}" if refused else step
    mark = ", " if refused else ": "
    return (
        f"{law} leaves {plain(rmse, 2)} N beside {plain(noise, 2)} N of noise, so something else acts "
        f"here{mark}{step}"
    )
