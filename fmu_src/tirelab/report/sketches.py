"""Small pictures: the next test's motion, a remainder's regression, a refitted law's change, a parameter's part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from markupsafe import Markup

from .numbers import curves_link
from .palette import PAGE
from .svg import drawing, inline_svg
from .thinning import envelope
from .words import number, scaled, surface

DASHES = ("-", (0, (5, 2)), (0, (1.5, 1.5)), (0, (5, 2, 1.5, 2)))
"""Line styles, so that curves are told apart without their colours."""

SKETCH = (150, 60)
"""Width and height of a parameter's sketch [px]."""

TOO_SMALL = "too small to draw"
SEEN = 0.03
"""Two curves of a sketch differ to the eye from this part of its height on: two pixels."""


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
        axes.plot(at, regressed, color=PAGE.after, lw=1.4, label="regression")
        label = f"{by} [{name}]" if name else by
        axes.set(xlabel=label, ylabel="remaining force [N]")
        picture = inline_svg(figure, f"Remaining force over {by}.", mark)
        return picture + curves_link(f"remainder_over_{by.replace(' ', '_')}", axes)


def draw_law_changes(changes: Sequence[Mapping[str, Any]], mark: str) -> Markup:
    """Return the force of the refitted law less that of the baseline over the deflection, one curve a surface."""
    with drawing(2.9) as (figure, axes):
        axes.axhline(0.0, color=PAGE.grid, lw=1.0)
        for i, change in enumerate(changes):
            colour = (PAGE.after, PAGE.before, PAGE.ink, PAGE.recorded)[i // len(DASHES) % 4]
            x, y = 1e3 * np.asarray(change["deflection"], float), np.asarray(change["difference"], float)
            axes.plot(x, y, color=colour, ls=DASHES[i % len(DASHES)], lw=1.4, label=surface(change["radius"]))
        axes.legend(frameon=False, fontsize=8.0)
        axes.set(xlabel="deflection [mm]", ylabel="force [N]", title="Refitted law − baseline law")
        alt = "Force of the refitted law less that of the baseline over the deflection."
        return inline_svg(figure, alt, mark) + curves_link("refitted_law", axes)


def draw_sketch(sketch: Mapping[str, Any], parameter: str) -> Markup:
    """Return the force that an effect adds over the deflection, and the same with one parameter larger, dashed.

    TOO_SMALL is returned where the eye would not see both.
    """
    varied = sketch["varied"].get(parameter)
    if varied is None:
        return Markup("")
    x, curves = np.asarray(sketch["deflection"], float), (sketch["force"], varied)
    values = np.concatenate([np.asarray(c, float) for c in curves])
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    if float(np.max(np.abs(np.subtract(*curves)))) < SEEN * (high - low) or not high > low:
        return Markup(TOO_SMALL)
    wide, tall = SKETCH

    def path(force: Sequence[float]) -> str:
        across = 3.0 + (wide - 6.0) * (x - x.min()) / max(float(np.ptp(x)), 1e-300)
        up = tall - 3.0 - (tall - 6.0) * (np.asarray(force, float) - low) / max(high - low, 1e-300)
        return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up, strict=True))

    zero = tall - 3.0 + (tall - 6.0) * low / max(high - low, 1e-300)
    alt = (
        f"Force that the effect adds over the deflection, from {number(low)} to {number(high)} N; dashed: with the "
        "parameter half as large again."
    )
    return Markup(
        '<svg class="sketch" viewBox="0 0 {wide} {tall}" role="img" aria-label="{alt}">'
        '<path class="zero" d="M0 {zero}H{wide}"/><polyline class="more" points="{more}"/>'
        '<polyline class="fitted" points="{fitted}"/></svg>'
    ).format(wide=wide, tall=tall, alt=alt, zero=f"{zero:.1f}", more=path(curves[1]), fitted=path(curves[0]))
