"""Figures 1 to 3 of Hull, Wang & Moore (1996), drawn from the law: A(R), B(R), and force against deflection.

The authors' measured points are not in the article's text, so there are none here. Where points are drawn they are the
law's own, taken as the rig would have taken them, and the figure says so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from radialtire import CATALOGUE, Hull1996, TireModel
from radialtire.hull1996 import FORCE_MAX

from . import press as rig
from .checks import WANG_HULL, force
from .outcomes import READINGS

RESOLUTION = 150
"""Dots per inch."""

COLOURS = ("#1b5e9b", "#c1531b")
"""Of the two readings of E0, or of two curves side by side: apart in grey, too, and for the colour-blind."""

STYLES: tuple[Literal["-"], Literal["--"]] = ("-", "--")
"""Of the two readings of E0."""

GREY = "0.45"

EVERY = 5
"""One in so many of the rig's samples is drawn: one a second."""

CONVEX_DRAWN = (0.0127, 0.0508, 0.1143, 0.254, 0.584)
"""Convex radii [m] in figure 3: all ten would hide one another."""


def draw(folder: Path) -> tuple[Path, ...]:
    """Write figure1.png, figure2.png and figure3.png into `folder` and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for name, figure in (
        (
            "figure1.png",
            coefficient_figure(0, "A [N/cm$^B$]", "Figure 1: coefficient A against the surface's radius"),
        ),
        ("figure2.png", coefficient_figure(1, "B", "Figure 2: exponent B against the surface's radius")),
        ("figure3.png", force_figure()),
    ):
        figure.savefig(folder / name, dpi=RESOLUTION)
        found.append(folder / name)
    return tuple(found)


def coefficient_figure(which: int, label: str, title: str) -> Figure:
    """Return A (`which` 0) or B (1) over concave and convex radii, with their common limit on flat ground."""
    figure = Figure(figsize=(9.0, 4.5), layout="constrained")
    concave, convex = figure.subplots(1, 2, sharey=True, width_ratios=(1.0, 2.0))
    flat = Hull1996().coefficients(math.inf)[which]
    readings = READINGS if which == 0 else (("law", READINGS[0][1]),)
    _coefficient(
        concave, np.linspace(-62.0, -33.0, 200), rig.CONCAVE_RADII, which, (("law", READINGS[0][1]),)
    )
    _coefficient(convex, np.linspace(0.0, 62.0, 400)[1:], rig.CONVEX_RADII, which, readings)
    for axes in (concave, convex):
        axes.axhline(flat, color=GREY, linewidth=1.0, linestyle=":", label=f"flat ground: {flat:g}")
        axes.grid(alpha=0.25)
        axes.set_xlabel("radius [cm]")
    concave.set_xlim(-62.0, -33.0)
    convex.set_xlim(0.0, 62.0)
    concave.set_title(f"concave ({5 + which}b)", fontsize=10)
    convex.set_title(f"convex ({5 + which}a)", fontsize=10)
    concave.set_ylabel(label)
    convex.legend(loc="lower right", frameon=False)
    figure.suptitle(title)
    figure.supxlabel(
        "Circles: the law at the rig's radii. The measured points are not in the article's text.", fontsize=8
    )
    return figure


def _coefficient(
    axes: Axes,
    radii: NDArray[np.float64],
    tested: Sequence[float],
    which: int,
    laws: Sequence[tuple[str, Hull1996]],
) -> None:
    for (name, law), colour, style in zip(laws, COLOURS, STYLES, strict=False):
        axes.plot(
            radii,
            [law.coefficients(r / 100.0)[which] for r in radii],
            color=colour,
            linestyle=style,
            label=name,
        )
        at_rig = [law.coefficients(r)[which] for r in tested]
        axes.plot(
            [100.0 * r for r in tested], at_rig, "o", color=colour, markersize=4.5, markerfacecolor="white"
        )


def force_figure() -> Figure:
    """Return force against deflection: A on flat ground, B on convex and C on concave surfaces."""
    figure = Figure(figsize=(13.5, 5.2), layout="constrained")
    flat, convex, concave = figure.subplots(1, 3, sharey=True)
    _flat_panel(flat)
    _surface_panel(convex, CONVEX_DRAWN, READINGS)
    _surface_panel(concave, rig.CONCAVE_RADII, (("law", READINGS[0][1]),))
    for axes, title in ((flat, "A: flat"), (convex, "B: convex"), (concave, "C: concave")):
        axes.axhline(FORCE_MAX, color=GREY, linewidth=0.8)
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("deflection [cm]")
        axes.set_xlim(0.0, 3.4)
        axes.set_ylim(0.0, 2500.0)
        axes.grid(alpha=0.25)
    flat.legend(loc="lower right", frameon=False, fontsize=8, bbox_to_anchor=(1.0, 0.0))
    flat.text(0.05, FORCE_MAX + 25.0, "2240 N: the rig's limit", fontsize=8, color=GREY)
    flat.set_ylabel("radial force [N]")
    figure.suptitle("Figure 3: force against deflection")
    figure.supxlabel(
        "Points: computed from the law as the rig would record it, one a second. The measured points are not in the "
        "article's text.",
        fontsize=8,
    )
    return figure


def _flat_panel(axes: Axes) -> None:
    """Draw the flat law, the hysteresis that the article describes, and the comparison with Wang & Hull."""
    law = READINGS[0][1]
    friction = CATALOGUE["rate_independent_hysteresis"]
    values = {"slip_force": 50.0}
    tire = TireModel(
        law=law, effects=((friction, tuple(values.get(p.name, p.start) for p in friction.parameters)),)
    )
    recorded = rig.record(tire, math.inf)
    x = np.linspace(0.0, 100.0 * recorded.deflection.max(), 200)
    axes.plot(x, [force(law, math.inf, v) for v in x], color=COLOURS[0], label="law, 550.9 x$^{1.422}$")
    axes.plot(
        x,
        [force(law, math.inf, v + 0.1) for v in x],
        color=COLOURS[0],
        linestyle=":",
        label="shifted by 1 mm",
    )
    axes.plot(
        x,
        [force(WANG_HULL, math.inf, v) for v in x],
        color=COLOURS[1],
        linestyle="--",
        label="Wang & Hull, 718.5 x$^{1.4}$",
    )
    top = int(recorded.deflection.argmax())
    for part, marker, name in (
        (slice(0, top + 1, EVERY), "^", "law with 100 N of hysteresis, loading"),
        (slice(top, None, EVERY), "v", "the same, unloading"),
    ):
        axes.plot(
            100.0 * recorded.deflection[part],
            recorded.force[part],
            marker,
            color=GREY,
            markersize=4.0,
            markerfacecolor="white",
            label=name,
        )


def _surface_panel(axes: Axes, radii: Sequence[float], laws: Sequence[tuple[str, Hull1996]]) -> None:
    """Draw the law of each radius up to the rig's deflection, by colour, and each law by its style."""
    for i, radius in enumerate(radii):
        colour = colormaps["viridis"](0.85 * i / max(len(radii) - 1, 1))
        for (_, law), style in zip(laws, STYLES, strict=False):
            recorded = rig.record(TireModel(law=law), radius)
            loading = slice(0, int(recorded.deflection.argmax()) + 1)
            x = 100.0 * recorded.deflection[loading]
            axes.plot(x, [force(law, 100.0 * radius, v) for v in x], color=colour, linestyle=style)
            if style == STYLES[0]:
                axes.plot(
                    x[::EVERY],
                    recorded.force[loading][::EVERY],
                    "o",
                    label=f"{100.0 * radius:g} cm",
                    color=colour,
                    markersize=3.5,
                    markerfacecolor="white",
                )
    of_radii = axes.legend(loc="upper left", bbox_to_anchor=(0.0, 0.88), frameon=False, fontsize=8)
    if len(laws) > 1:
        lines = [Line2D([], [], color=GREY, linestyle=style) for style in STYLES]
        axes.legend(lines, [name for name, _ in laws], loc="lower right", frameon=False, fontsize=8)
        axes.add_artist(of_radii)
