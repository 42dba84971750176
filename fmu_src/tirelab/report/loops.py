"""Force over deflection, recorded and simulated, before and after the correction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from ..recordings.recording import Recording
from .palette import PAGE, PLAIN, Palette
from .svg import drawing, inline_svg
from .thinning import LONGEST_LINE, Limits, occupancy, trail

FloatArray = NDArray[np.float64]

DOTS = (480, 640)
"""Rows and columns of the picture of the recorded samples."""

VISIBLE = 1e-2
"""A change of the simulated force is visible from this part of the largest residual on."""

GREY, ORANGE, BLUE = (140, 148, 158), (222, 110, 26), (46, 138, 214)
"""Colours of dots that show on a light and on a dark page."""


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
        """Whether the correction changes nothing here that a picture could show."""
        residual = self.recording.force - self.before
        return bool(np.max(np.abs(self.before - self.after)) <= VISIBLE * np.max(np.abs(residual)))


@dataclass(frozen=True)
class Frame:
    """The limits of a picture, across and up."""

    across: Limits
    up: Limits


def limits_of(*series: FloatArray, margin: float = 0.04) -> Limits:
    """Return limits around all the values, a little apart from them."""
    low, high = min(float(s.min()) for s in series), max(float(s.max()) for s in series)
    room = margin * (high - low) or 1.0
    return low - room, high + room


def plot_loops(case: Case, axes: Axes | None) -> Axes:
    """Draw the recorded and both simulated loops, with a legend, on `axes` or on those of a new figure."""
    drawn: Axes = Figure(layout="constrained").subplots() if axes is None else axes
    _loops(drawn, case, "both", PLAIN)
    drawn.set_title(case.recording.name, parse_math=False)
    lines = (
        [(PLAIN.before, "simulated")] if case.alike else [(PLAIN.before, "before"), (PLAIN.after, "after")]
    )
    dots = Line2D([], [], color=PLAIN.recorded, marker="o", ls="none", label="recorded")
    drawn.legend(
        handles=[dots, *(Line2D([], [], color=colour, label=label) for colour, label in lines)],
        frameon=False,
        loc="upper left",
    )
    return drawn


def draw_loops(case: Case, which: str, mark: str, alt: str) -> Markup:
    """Return the recorded loop with the simulated one: `which` is "before", "after" or "both"."""
    with drawing() as (figure, axes):
        _loops(axes, case, which, PAGE)
        before_after = "Before and after" if which == "both" else which.capitalize()
        axes.set_title("Recorded and simulated" if case.alike else f"{before_after} the correction")
        return inline_svg(figure, alt, mark)


def draw_difference(case: Case, mark: str) -> Markup:
    """Return the residual of the baseline tire over the deflection, and the force that the correction adds."""
    mm = 1e3 * case.recording.deflection
    residual, added = case.recording.force - case.before, case.after - case.before
    frame = Frame(limits_of(mm), limits_of(residual, added))
    with drawing() as (figure, axes):
        draw_dots(axes, mm, residual, frame, GREY, 2)
        if not case.alike:
            _line(axes, mm, added, frame, PAGE.after, BLUE)
        title = "Recorded minus simulated force"
        axes.set(xlim=frame.across, ylim=frame.up, xlabel="deflection [mm]", ylabel="force [N]", title=title)
        alt = "Recorded minus simulated force over deflection, and the force that the correction adds."
        return inline_svg(figure, alt, mark)


def _loops(axes: Axes, case: Case, which: str, palette: Palette) -> None:
    mm, force = 1e3 * case.recording.deflection, case.recording.force
    frame = Frame(limits_of(mm), limits_of(force, case.before, case.after))
    draw_dots(axes, mm, force, frame, GREY, 2)
    if which != "after":
        _line(axes, mm, case.before, frame, palette.before, ORANGE)
    if which != "before" and not case.alike:
        _line(axes, mm, case.after, frame, palette.after, BLUE)
    axes.set(xlim=frame.across, ylim=frame.up, xlabel="deflection [mm]", ylabel="force [N]")


def draw_dots(
    axes: Axes, x: FloatArray, y: FloatArray, frame: Frame, colour: tuple[int, int, int], wide: int = 0
) -> None:
    picture = np.zeros((*DOTS, 4), dtype=np.uint8)
    picture[..., :3] = colour
    picture[..., 3] = occupancy(x, y, frame.across, frame.up, DOTS, wide)
    extent = (*frame.across, *frame.up)
    axes.imshow(picture, extent=extent, origin="lower", aspect="auto", interpolation="none", zorder=1)


def _line(
    axes: Axes, x: FloatArray, y: FloatArray, frame: Frame, colour: str, dots: tuple[int, int, int]
) -> None:
    path = trail(x, y, frame.across, frame.up)
    if path[0].size > LONGEST_LINE:
        draw_dots(axes, x, y, frame, dots)
    else:
        axes.plot(*path, color=colour, lw=1.1)
