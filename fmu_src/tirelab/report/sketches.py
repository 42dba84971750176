"""Small pictures: the motion of the recommended test, and the regression of a residual that no effect explains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from markupsafe import Markup

from .palette import PAGE
from .svg import drawing, inline_svg
from .thinning import envelope
from .words import scaled


def draw_waveform(time: Sequence[float], deflection: Sequence[float], mark: str) -> Markup:
    """Return the deflection [m] to drive over time [s]."""
    with drawing(2.4) as (figure, axes):
        axes.plot(
            *envelope(np.asarray(time, float), 1e3 * np.asarray(deflection, float)), color=PAGE.after, lw=1.1
        )
        axes.set(xlabel="time [s]", ylabel="deflection [mm]", title="The motion to drive")
        axes.margins(x=0.01)
        return inline_svg(figure, "Deflection over time of the recommended test.", mark)


def draw_correction(
    by: str, unit: str, x: Sequence[float], force: Sequence[float], std: Sequence[float] | None, mark: str
) -> Markup:
    """Return the regressed force [N] over the coordinate `by` in `unit`, with twice its standard deviation."""
    factor, name = scaled(unit)
    at, regressed = factor * np.asarray(x, float), np.asarray(force, float)
    with drawing(2.8) as (figure, axes):
        axes.axhline(0.0, color=PAGE.grid, lw=1.0)
        if std is not None:
            wide = 2.0 * np.asarray(std, float)
            axes.fill_between(at, regressed - wide, regressed + wide, color=PAGE.after, alpha=0.25, lw=0)
        axes.plot(at, regressed, color=PAGE.after, lw=1.4)
        label = f"{by} [{name}]" if name else by
        axes.set(xlabel=label, ylabel="remaining force [N]")
        return inline_svg(figure, f"Remaining force over {by}.", mark)
