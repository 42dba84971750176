"""Which samples of a recording lie in a place of `where`, and the picture of the difference with its places shaded."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray
from radialtire import FLAT_RADIUS

from ..recordings.recording import Recording
from .course import loading, rate_of
from .loops import GREY, ORANGE, Frame, draw_dots, limits_of
from .palette import PAGE
from .svg import drawing, inline_svg

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

WHOLE = 0.9
"""Places with more than this part of a recording's samples are not shaded: they would shade the picture."""

MEANS = 48
"""Bins of the mean difference over the deflection."""

FEWEST = 5
"""A bin with fewer samples has no mean."""

CORE = 0.995
"""Part of the differences between the limits of the picture, which a spike would else stretch."""

LEGEND: dict[str, Any] = {
    "loc": "lower right",
    "bbox_to_anchor": (0.99, -0.015),
    "ncols": 2,
    "frameon": False,
    "fontsize": 8.5,
    "handlelength": 1.4,
    "columnspacing": 1.2,
}
"""Beside the label of the axis below, where no sample can be."""


@dataclass(frozen=True)
class Located:
    """A recording with the residual [N] in which the places lie, and the baseline's force [N]."""

    recording: Recording
    residual: FloatArray
    baseline: FloatArray


def _between(values: FloatArray, place: Mapping[str, Any]) -> BoolArray:
    return np.asarray((values >= float(place["from"])) & (values <= float(place["to"])))


def _time(at: Located, place: Mapping[str, Any]) -> BoolArray:
    if place.get("recording") not in (None, at.recording.name):
        return np.zeros(len(at.recording), dtype=bool)
    return _between(at.recording.time, place)


def _rate(at: Located, place: Mapping[str, Any]) -> BoolArray:
    return _between(rate_of(at.recording.time, at.recording.deflection), place)


def _direction(at: Located, place: Mapping[str, Any]) -> BoolArray:
    loads = loading(rate_of(at.recording.time, at.recording.deflection))
    return np.asarray(loads == (float(place["from"]) + float(place["to"]) > 0.0))


def _surface(at: Located, place: Mapping[str, Any]) -> BoolArray:
    def bend(radius: FloatArray) -> FloatArray:
        return np.where(np.abs(radius) >= FLAT_RADIUS, 0.0, 1.0 / radius)

    ends = np.sort(bend(np.array([float(place["from"]), float(place["to"])])))
    own = bend(at.recording.surface_radius)
    return np.asarray((own >= ends[0] - 1e-9) & (own <= ends[1] + 1e-9))


_INSIDE: Mapping[str, Callable[[Located, Mapping[str, Any]], BoolArray]] = MappingProxyType(
    {
        "deflection": lambda at, place: _between(at.recording.deflection, place),
        "force": lambda at, place: _between(at.baseline, place),
        "history": lambda at, place: _between(np.maximum.accumulate(at.recording.deflection), place),
        "time": _time,
        "rate": _rate,
        "direction": _direction,
        "radius": _surface,
    }
)
"""Coordinates of `where` that a recording has at every sample; the others are told in words only."""


def inside(place: Mapping[str, Any], at: Located) -> BoolArray | None:
    """Return which samples lie in an entry of `where`; None for a coordinate that is not drawn."""
    known = _INSIDE.get(place["by"])
    try:
        return None if known is None else known(at, place)
    except (TypeError, ValueError):  # a bound that is no number
        return None


def shaded(where: Sequence[Mapping[str, Any]], at: Located) -> list[Mapping[str, Any]]:
    """Return the places to shade: the first one that can be drawn, and others along its coordinate.

    Together they leave more than 1 - WHOLE of the samples unshaded.
    """
    drawn: list[Mapping[str, Any]] = []
    chosen = np.zeros(len(at.recording), dtype=bool)
    for place in where:
        if drawn and place["by"] != drawn[0]["by"]:
            continue
        samples = inside(place, at)
        if samples is not None and samples.any() and float((chosen | samples).mean()) <= WHOLE:
            chosen |= samples
            drawn.append(place)
    return drawn


def draw_where(at: Located, places: Sequence[Mapping[str, Any]], noise: float, mark: str) -> Markup:
    """Return the difference alone over the deflection, its mean loop, and the samples of `places` shaded.

    noise [N]: of one sample
    """
    mm = 1e3 * at.recording.deflection
    chosen = np.zeros(mm.size, dtype=bool)
    for place in places:
        samples = inside(place, at)
        chosen |= False if samples is None else samples
    core = np.quantile(at.residual, [1.0 - CORE, CORE]) if mm.size > 100 else at.residual
    ends = [1e3 * float(p[end]) for p in places if p["by"] == "deflection" for end in ("from", "to")]
    frame = Frame(limits_of(np.append(mm, ends)), limits_of(core, np.array([-noise, noise]), margin=0.12))
    with drawing(3.0) as (figure, axes):
        axes.axhspan(-noise, noise, color=PAGE.band, lw=0, zorder=0.5)
        for place in places:
            if place["by"] == "deflection":
                start, stop = (1e3 * float(place[end]) for end in ("from", "to"))
                axes.axvspan(start, stop, color=PAGE.before, alpha=0.13, lw=0, zorder=0.4)
        draw_dots(axes, mm[~chosen], at.residual[~chosen], frame, GREY)
        draw_dots(axes, mm[chosen], at.residual[chosen], frame, ORANGE)
        axes.axhline(0.0, color=PAGE.ink, lw=0.6)
        loads = loading(rate_of(at.recording.time, at.recording.deflection))
        for branch, marker in ((loads, "^"), (~loads, "v")):
            axes.plot(*_means(mm[branch], at.residual[branch]), color=PAGE.ink, marker=marker, ms=2.6, lw=1.3)
        title = "Recorded − simulated (▲ loading, ▼ unloading)"
        axes.set(xlim=frame.across, ylim=frame.up, ylabel="force [N]")
        axes.set_title(title, loc="right")  # it is as wide as the picture
        axes.set_xlabel("deflection [mm]", loc="left")
        legend = [Patch(color=PAGE.band, label="noise"), Line2D([], [], color=PAGE.ink, lw=1.3, label="mean")]
        figure.legend(handles=legend, **LEGEND)
        alt = (
            "The difference between recorded and simulated force over the deflection, with its means for loading and "
            "unloading, and the places shaded in which it lies."
        )
        return inline_svg(figure, alt, mark)


def _means(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the means of x and y in MEANS even bins of x; none where there are no samples."""
    if not x.size or not np.ptp(x) > 0.0:
        return np.empty(0), np.empty(0)
    bin_of = np.minimum((MEANS * (x - x.min()) / np.ptp(x)).astype(np.intp), MEANS - 1)
    count = np.bincount(bin_of, minlength=MEANS)
    full = count >= min(FEWEST, max(x.size // MEANS, 1))
    at = np.bincount(bin_of, x, minlength=MEANS)[full] / count[full]
    return at, np.bincount(bin_of, y, minlength=MEANS)[full] / count[full]
