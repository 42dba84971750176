"""A simulated force beside a recorded one: how large the difference is, and where it is largest."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..errors import TirelabError, check_recordings_given
from ..names import plain
from .thinning import COLUMNS, envelope

PIXELS, FEW = 1000, 20_000
"""Across and up of the picture; fewer samples than the second are all drawn."""

if TYPE_CHECKING:
    from ..recordings.recording import Recording


@dataclass(frozen=True)
class Comparison:
    """The residual (recorded minus simulated force [N]) and its largest member.

    rmse: root mean square of the residual [N]
    peak: the residual of largest magnitude [N], at sample `at`
    """

    recording: Recording
    simulated: NDArray[np.float64]
    residual: NDArray[np.float64]
    rmse: float
    peak: float
    at: int

    def sentences(self) -> list[str]:
        """Return the result in words."""
        r = self.recording
        surface = _surface(float(r.surface_radius[self.at]))
        scale = float(np.max(np.abs(r.force)))
        over = f" over {r.time[-1] - r.time[0]:g} s" if r.timed else ""
        at = f"t = {r.time[self.at]:g} s" if r.timed else f"sample {self.at + 1}"
        return [
            f"{len(r.time)} samples{over}, forces up to {scale:.0f} N",
            f"RMSE {self.rmse:.2f} N ({100 * self.rmse / scale:.2f} % of the largest force)",
            f"peak error {self.peak:+.1f} N (recorded minus simulated) at {at}, "
            f"deflection {1000 * r.deflection[self.at]:.2f} mm, {surface}",
        ]


def compare(recording: Recording, simulated: NDArray[np.float64]) -> Comparison:
    """Return how `simulated` [N] (n,), one number for each sample, differs from the recorded force.

    Raises TypeError where `recording` is none, TirelabError where there are not as many numbers, or one is not finite.
    """
    check_recordings_given([recording])
    simulated = np.asarray(simulated, dtype=np.float64)
    if simulated.shape != recording.force.shape:
        raise TirelabError(
            f"the simulated force has the shape {simulated.shape}, and {recording.name} has {recording.force.size} "
            "samples; give one number for each of them"
        )
    if not np.isfinite(simulated).all():
        at = int(np.argmin(np.isfinite(simulated)))
        raise TirelabError(
            f"the simulated force is {simulated[at]} at sample {at + 1}; simulate it anew, or cut it off"
        )
    residual = recording.force - simulated
    at = int(np.argmax(np.abs(residual)))
    rmse = float(np.sqrt(np.mean(residual**2)))
    return Comparison(recording, simulated, residual, rmse, float(residual[at]), at)


def plot(comparison: Comparison, path: Path) -> None:
    """Draw force over deflection, force over time and the residual over time into the PNG at `path`."""
    r, simulated = comparison.recording, comparison.simulated
    figure = Figure(figsize=(11, 6.5), layout="constrained")
    loops, forces, residuals = figure.subplot_mosaic([["loop", "force"], ["loop", "residual"]]).values()
    measured: dict[str, Any] = {"color": "0.55", "lw": 1.0, "label": "recorded"}
    computed: dict[str, Any] = {"color": "tab:blue", "lw": 1.0, "label": "simulated"}
    _draw_loops(loops, comparison)
    mark: dict[str, Any] = {
        "marker": "o",
        "ms": 9,
        "mfc": "none",
        "mec": "tab:red",
        "mew": 1.8,
        "ls": "none",
        "label": "peak error",
    }
    loops.plot(1000 * r.deflection[comparison.at], r.force[comparison.at], **mark)
    course = r.time if r.timed else np.arange(1.0, len(r.time) + 1.0)
    forces.plot(*envelope(course, r.force), **measured)
    forces.plot(*envelope(course, simulated), **computed)
    forces.set(ylabel="force [N]")
    residuals.plot(*envelope(course, comparison.residual), color="tab:blue", lw=0.7)
    residuals.plot(course[comparison.at], comparison.peak, **mark)
    residuals.axhline(0.0, color="0.3", lw=0.8)
    residuals.set(
        xlabel="time [s]" if r.timed else "sample",
        ylabel="recorded − simulated [N]",
        title=f"RMSE {comparison.rmse:.2f} N, peak {comparison.peak:+.1f} N",
    )
    for axes in (loops, forces, residuals):
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    loops.legend(frameon=False, loc="upper left")
    forces.legend(frameon=False, loc="upper right", ncols=2)
    figure.savefig(path, dpi=120)


def _draw_loops(axes: Axes, comparison: Comparison) -> None:
    """Draw the recorded force as dots and the simulated one as a line for each surface, over the deflection."""
    r, simulated = comparison.recording, comparison.simulated
    mm = 1000 * r.deflection
    shown = _distinct(mm, r.force)
    axes.plot(mm[shown], r.force[shown], ".", ms=2, color="0.55", label="recorded", rasterized=True)
    order = np.lexsort((r.deflection, r.surface_radius))
    sorted_radii = r.surface_radius[order]
    breaks = np.flatnonzero(sorted_radii[1:] != sorted_radii[:-1]) + 1
    for i, part in enumerate(np.split(order, breaks)):
        line = envelope(mm[part], simulated[part]) if part.size > 2 * COLUMNS else (mm[part], simulated[part])
        axes.plot(*line, color="tab:blue", lw=1.2, label="simulated" if i == 0 else None)
    axes.set(xlabel="deflection [mm]", ylabel="force [N]", title=r.name)


def _distinct(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the first sample of each pixel that the dots (x, y) fall on, all of them where they are few."""
    if x.size <= FEW:
        return np.arange(x.size)
    pixel = np.zeros(x.size, dtype=np.int64)
    for values in (x, y):
        low, high = float(values.min()), float(values.max())
        pixel = pixel * PIXELS + ((values - low) * ((PIXELS - 1) / max(high - low, 1e-300))).astype(np.int64)
    first = np.full(PIXELS * PIXELS, -1, dtype=np.intp)
    first[pixel[::-1]] = np.arange(x.size)[::-1]
    return first[first >= 0]


def _surface(radius: float) -> str:
    if abs(radius) >= 1e5:
        return "flat ground"
    return f"{'convex' if radius > 0 else 'concave'} {plain(100 * abs(radius), 3)} cm"
