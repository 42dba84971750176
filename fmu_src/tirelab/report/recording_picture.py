"""A recording as a small picture: in the terminal, and as a PNG."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..recordings.samples import find_gaps

if TYPE_CHECKING:
    from ..recordings.recording import Recording

WIDTH, HEIGHT = 60, 12
"""Of a picture in the terminal, in characters."""

DRAWN = 4000
"""So many samples of a recording are drawn, evenly spaced."""


def terminal_picture(recording: Recording, width: int = WIDTH, height: int = HEIGHT) -> str:
    """Return force over deflection drawn with characters, for a terminal of at least `width` + 15 columns."""
    from uniplot import plot_to_string

    step = max(1, len(recording) // DRAWN)
    text: str = plot_to_string(
        xs=1e3 * recording.deflection[::step],
        ys=recording.force[::step],
        width=width,
        height=height,
        character_set="braille",
        title="force [N] over deflection [mm]",
    )
    return text


def broken(values: NDArray[np.float64], time: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values with a NaN in each gap of their times [s], at which a line that is drawn through them breaks."""
    return np.insert(values, find_gaps(np.diff(time)) + 1, np.nan) if len(time) > 1 else values


def draw_recordings(recordings: list[Recording], path: Path) -> None:
    """Draw force over deflection and both over time, one row for each recording, into the PNG at `path`.

    A gap in time breaks the lines: nothing is drawn where nothing was recorded.
    """
    figure = Figure(figsize=(10, 2.8 * len(recordings) + 0.6), layout="constrained")
    rows = figure.subplots(len(recordings), 2, squeeze=False)
    for (loop, course), recording in zip(rows, recordings, strict=True):
        step = max(1, len(recording) // (10 * DRAWN))
        channels = (1e3 * recording.deflection, recording.force, recording.time)
        mm, force, time = (broken(values[::step], recording.time[::step]) for values in channels)
        loop.plot(mm, force, lw=0.8, color="tab:blue", rasterized=True)
        loop.set(xlabel="deflection [mm]", ylabel="force [N]", title=recording.name)
        at = time if recording.timed else np.arange(len(time)) * step + 1
        course.plot(at, force, lw=0.8, color="tab:blue", rasterized=True)
        course.set(xlabel="time [s]" if recording.timed else "sample")
        course.set_ylabel("force [N]", color="tab:blue")
        beside = course.twinx()
        beside.plot(at, mm, lw=0.8, color="tab:orange", rasterized=True)
        beside.set_ylabel("deflection [mm]", color="tab:orange")
        loop.grid(alpha=0.3)
        course.grid(alpha=0.3)
    figure.savefig(path, dpi=110)
