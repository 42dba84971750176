"""Force over deflection, recorded and simulated, before and after the correction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ..recordings.recording import Recording
from .svg import AFTER, BEFORE, drawing, inline_svg
from .thinning import LONGEST_LINE, Limits, occupancy, trail

FloatArray = NDArray[np.float64]

DOTS = (480, 640)
"""Rows and columns of the picture of the recorded samples."""

GREY, ORANGE, BLUE = (140, 148, 158), (222, 110, 26), (46, 138, 214)
"""Dots that show on light and on dark paper."""


@dataclass(frozen=True)
class Case:
    """A recording with the simulated forces [N] before and after the correction; arrays of its length."""

    recording: Recording
    before: FloatArray
    after: FloatArray

    @property
    def excess(self) -> float:
        """Sum of the squared errors before the correction [N^2]."""
        return float(np.sum((self.recording.force - self.before) ** 2))

    @property
    def alike(self) -> bool:
        """Whether the correction changes nothing here."""
        return bool(np.max(np.abs(self.before - self.after)) <= 1e-9 * np.max(np.abs(self.before)) + 1e-9)


def limits_of(*series: FloatArray, margin: float = 0.04) -> Limits:
    """Return limits around all the values, a little apart from them."""
    low, high = min(float(s.min()) for s in series), max(float(s.max()) for s in series)
    room = margin * (high - low) or 1.0
    return low - room, high + room


def draw_loops(case: Case, which: str, mark: str, alt: str) -> Markup:
    """Return the recorded loop with the simulated one: `which` is "before", "after" or "both"."""
    mm, force = 1e3 * case.recording.deflection, case.recording.force
    across, up = limits_of(mm), limits_of(force, case.before, case.after)
    with drawing() as (figure, axes):
        _dots(axes, mm, force, across, up, GREY, 2)
        if which != "after":
            _line(axes, mm, case.before, across, up, BEFORE, ORANGE)
        if which != "before" and not case.alike:
            _line(axes, mm, case.after, across, up, AFTER, BLUE)
        axes.set(xlim=across, ylim=up, xlabel="deflection [mm]", ylabel="radial force [N]")
        if which != "both" and not case.alike:
            axes.set_title(f"{which.capitalize()} the correction")
        return inline_svg(figure, alt, mark)


def draw_difference(case: Case, mark: str) -> Markup:
    """Return what the believed tire leaves of the recorded force, and what the correction adds to it."""
    mm, left, added = (
        1e3 * case.recording.deflection,
        case.recording.force - case.before,
        case.after - case.before,
    )
    across, up = limits_of(mm), limits_of(left, added)
    with drawing() as (figure, axes):
        _dots(axes, mm, left, across, up, GREY, 2)
        if not case.alike:
            _line(axes, mm, added, across, up, AFTER, BLUE)
        axes.set(
            xlim=across, ylim=up, xlabel="deflection [mm]", ylabel="force [N]", title="The difference alone"
        )
        alt = "Recorded less simulated force over deflection, and what the correction adds."
        return inline_svg(figure, alt, mark)


def _dots(
    axes: Axes,
    x: FloatArray,
    y: FloatArray,
    across: Limits,
    up: Limits,
    colour: tuple[int, int, int],
    wide: int = 0,
) -> None:
    picture = np.zeros((*DOTS, 4), dtype=np.uint8)
    picture[..., :3] = colour
    picture[..., 3] = occupancy(x, y, across, up, DOTS, wide)
    axes.imshow(picture, extent=(*across, *up), origin="lower", aspect="auto", interpolation="none", zorder=1)


def _line(
    axes: Axes,
    x: FloatArray,
    y: FloatArray,
    across: Limits,
    up: Limits,
    colour: str,
    dots: tuple[int, int, int],
) -> None:
    path = trail(x, y, across, up)
    if path[0].size > LONGEST_LINE:
        _dots(axes, x, y, across, up, dots)
    else:
        axes.plot(*path, color=colour, lw=1.1)
