"""A recording as a small picture: in the terminal, and as a PNG."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from ..recordings.samples import find_gaps

if TYPE_CHECKING:
    from ..recordings.recording import Recording

WIDTH, HEIGHT = 60, 12
"""Of a picture in the terminal, in characters."""

MOST_LABELS = (5, 4)
"""Most steps between labels of the picture in the terminal, along it and up."""

DRAWN = 4000
"""Most samples of a recording that are drawn, evenly spaced."""


def terminal_picture(recording: Recording, width: int = WIDTH, height: int = HEIGHT) -> str:
    """Return force over deflection drawn with characters, for a terminal of at least `width` + 15 columns."""
    from uniplot import plot_to_string

    step = max(1, len(recording) // DRAWN)
    x, y = 1e3 * recording.deflection[::step], recording.force[::step]
    (left, right), (low, high) = _limits(x), _limits(y)
    text: str = plot_to_string(
        xs=x,
        ys=y,
        x_min=left,
        x_max=right,
        y_min=low,
        y_max=high,
        width=width,
        height=height,
        character_set="braille",
        title="force [N] over deflection [mm]",
    )
    # uniplot rounds its labels to what tells them apart: they are replaced
    lines = [line[: line.rfind("│") + 1] or line for line in text.splitlines()[: height + 3]]
    for label, share in _ticks(low, high, MOST_LABELS[1]):
        row = -2 - min(int(share * height), height - 1)
        lines[row] += f" {label}" if lines[row].endswith("│") else ""
    below = ""
    for label, share in _ticks(left, right, MOST_LABELS[0]):
        begin = max(0, 1 + min(int(share * width), width - 1) - len(label) // 2)
        below += " " * (begin - len(below)) + label if begin > len(below) or not below else ""
    return "\n".join([*lines, below])


def _limits(values: NDArray[np.float64]) -> tuple[float, float]:
    """Return the least and the greatest value, some way apart where all are equal."""
    low, high = float(values.min()), float(values.max())
    beside = 0.0 if high > low else max(abs(low), 1.0)
    return low - beside, high + beside


def _ticks(low: float, high: float, most: int) -> list[tuple[str, float]]:
    """Return round numbers of an axis as texts with all their digits, each with its share of the way along the axis."""
    values = np.asarray(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    step = values[1] - values[0]
    values = np.round(values / step) * step + 0.0
    values = values[(values >= low) & (values <= high)]
    digits = (
        [f"{v:,.{n}f}" for v in values] for n in range(7) if step >= 1e-6 and np.abs(values).max() < 1e9
    )
    scientific = ([f"{v:.{n}g}" for v in values] for n in range(1, 18))
    texts = next(
        texts
        for texts in (*digits, *scientific)
        if np.allclose([float(t.replace(",", "")) for t in texts], values, rtol=0.0, atol=1e-6 * step)
    )
    return [(text, (v - low) / (high - low)) for text, v in zip(texts, values, strict=True)]


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
