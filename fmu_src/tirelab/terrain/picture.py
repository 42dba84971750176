"""Pictures of a ride: ground, wheel, force and the stretches where the article's limits are passed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..errors import TirelabError
from .limits import DOUBTS, Limit, percent
from .profile import Floats
from .ride import Ride

if TYPE_CHECKING:  # matplotlib takes longer to load than a ride to compute
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GROUND, WHEEL, FORCE, DOUBT, AIR = "#8a6d4b", "#1f5a99", "#222222", "#d1495b", "#7fb2dd"

LABELS = {
    Limit.SHARP_EDGE: "sharp edge",
    Limit.DISCONTINUOUS_RADIUS: "radius jumps",
    Limit.CHANGING_RADIUS: "radius changes quickly",
    Limit.TIGHT_CONCAVE: "tight concave",
    Limit.SEVERAL_CONTACTS: "several contacts",
    Limit.DEFLECTION_UNTESTED: "deflection untested",
    Limit.FORCE_UNTESTED: "force untested",
    Limit.COARSE_GROUND: "ground data coarse",
    Limit.AIRBORNE: "off the ground",
    Limit.SURFACE_UNTESTED: "surface untested",
}

LONGEST_TO_SCALE = 6.0
"""Rides up to this length [m] are drawn to scale, with the wheel; on longer ones the heights are exaggerated."""

WIDTH = 10.0
AXES_WIDTH = 8.4
"""Width [in] of a picture, and about that of its axes."""

MOST_FRAMES = 400


def draw_ride(ride: Ride, path: str | Path, title: str | None = None) -> None:
    """Write a PNG of `ride` to `path`: ground and wheel path, force over time, and one line per limit passed."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    met = [limit for limit in Limit if np.any(ride.limits & limit.value)]
    heights = [_ground_height(ride), 2.4] + ([0.25 * len(met) + 0.1] if met else [])
    figure = Figure(figsize=(WIDTH, sum(heights) + 1.9), layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(len(heights), 1, sharex=True, gridspec_kw={"height_ratios": heights})
    _draw_ground(rows[0], ride)
    _draw_force(rows[1], ride)
    if met:
        _draw_limits(rows[2], ride, met)
    rows[-1].set_xlabel("position of the hub s [m]")
    figure.legend(
        *rows[0].get_legend_handles_labels(), loc="outside upper center", ncols=5, fontsize=8, frameon=False
    )
    rows[0].set_title(title or f"{ride.ground.name}, {ride.speed:g} m/s", fontsize=11)
    _save(figure, path)


def animate_ride(ride: Ride, path: str | Path, frames: int = 120, frames_per_second: int = 20) -> None:
    """Write a GIF of `ride` to `path`: the moving wheel, the force on it and the section in contact."""
    from matplotlib.animation import PillowWriter
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    if not (2 <= frames <= MOST_FRAMES):
        raise TirelabError(f"{frames} frames; give 2 to {MOST_FRAMES}")
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    top, bottom = figure.subplots(2, 1, gridspec_kw={"height_ratios": [1.6, 1.0]})
    _draw_force(bottom, ride)
    bottom.set_xlabel("position of the hub s [m]")
    figure.suptitle(f"{ride.ground.name}, {ride.speed:g} m/s", fontsize=11)
    moments = np.linspace(0, ride.time.size - 1, min(frames, ride.time.size)).round().astype(int)
    marker = bottom.axvline(ride.contact.position[0], color=WHEEL)
    _draw_moment(top, ride, 0)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    writer = PillowWriter(fps=frames_per_second)
    try:
        with writer.saving(figure, str(path), dpi=80):
            for i in moments:
                marker.set_xdata([ride.contact.position[i]] * 2)
                _draw_moment(top, ride, int(i))
                writer.grab_frame()
    except OSError as error:
        raise TirelabError(f"{path}: {error.strerror or error}; name a file that can be written") from None


def _to_scale(ride: Ride) -> bool:
    return float(np.ptp(ride.contact.position)) + 2.0 * ride.wheel_radius <= LONGEST_TO_SCALE


def _ground_height(ride: Ride) -> float:
    """Return the height [in] of the upper axes: what a picture to scale needs."""
    if not _to_scale(ride):
        return 2.6
    low, high, length = (
        *_limits_to_scale(ride),
        float(np.ptp(ride.contact.position)) + 2.0 * ride.wheel_radius,
    )
    return float(np.clip(1.04 * AXES_WIDTH * (high - low) / length, 1.2, 5.0))


def _limits_to_scale(ride: Ride) -> tuple[float, float]:
    top = float(ride.contact.hub_height.max()) + 1.1 * ride.wheel_radius
    return float(_seen(ride)[1].min()) - 0.2 * ride.wheel_radius, top


def _seen(ride: Ride) -> tuple[Floats, Floats]:
    """Return s and z [m] of the ground that the wheel passes over."""
    ground, position = ride.ground, ride.contact.position
    near = (ground.s >= position[0] - ride.wheel_radius) & (ground.s <= position[-1] + ride.wheel_radius)
    return ground.s[near], ground.z[near]


def _draw_ground(axes: Axes, ride: Ride) -> None:
    from matplotlib.patches import Circle

    touch, (s, z) = ride.contact, _seen(ride)
    if _to_scale(ride):
        lowered, words = 0.0, "path of the hub"
        floor, top = _limits_to_scale(ride)
        for i in np.linspace(0, touch.position.size - 1, 4).astype(int):
            hub = (touch.position[i], touch.hub_height[i])
            axes.add_patch(Circle(hub, ride.wheel_radius, fill=False, color=WHEEL, alpha=0.5))
        axes.set_xlim(s[0], s[-1])
        axes.set_aspect("equal", adjustable="box")
    else:
        lowered, words = ride.wheel_radius, "path of the hub less the wheel's radius"
        margin = 0.08 * max(float(np.ptp(z)), 0.05)
        wheel = touch.hub_height - lowered
        floor = min(float(z.min()), float(wheel.min())) - margin
        top = max(float(z.max()), float(wheel.max())) + margin
        axes.set_xlim(s[0], s[-1])
    axes.fill_between(s, z, floor, color=GROUND, alpha=0.45, linewidth=0)
    axes.plot(s, z, color=GROUND, linewidth=1.2, label="ground")
    axes.plot(touch.position, touch.hub_height - lowered, color=WHEEL, linewidth=1.3, label=words)
    without = ride.rolling_height - lowered
    axes.plot(touch.position, without, color=WHEEL, linewidth=0.9, linestyle=":", label="without deflection")
    _shade(axes, ride)
    axes.set_ylim(floor, top)
    axes.set_ylabel("height [m]")


def _draw_force(axes: Axes, ride: Ride) -> None:
    start, speed = float(ride.contact.position[0]), ride.speed
    axes.plot(ride.contact.position, ride.radial_force, color=FORCE, linewidth=1.0)
    _shade(axes, ride)
    axes.set_ylim(0.0, 1.12 * max(float(ride.radial_force.max()), 1.0))
    axes.set_ylabel("radial force [N]")

    def seconds(position: ArrayLike) -> ArrayLike:
        return (np.asarray(position) - start) / speed

    def metres(time: ArrayLike) -> ArrayLike:
        return start + np.asarray(time) * speed

    clock = axes.secondary_xaxis("top", functions=(seconds, metres))
    clock.set_xlabel("time [s]", fontsize=8)
    clock.tick_params(labelsize=8)


def _draw_limits(axes: Axes, ride: Ride, met: list[Limit]) -> None:
    for row, limit in enumerate(reversed(met)):
        color = AIR if limit is Limit.AIRBORNE else DOUBT
        axes.broken_barh(_stretches(ride, limit), (row - 0.35, 0.7), color=color, linewidth=0.8)
    axes.set_yticks(
        range(len(met)),
        [f"{LABELS[limit]}, {percent(ride.report.share(limit))}" for limit in reversed(met)],
        fontsize=8,
    )
    axes.set_ylim(-0.6, len(met) - 0.4)
    axes.tick_params(axis="y", length=0)


def _draw_moment(axes: Axes, ride: Ride, i: int) -> None:
    from matplotlib.patches import Circle

    axes.clear()
    touch, ground, radius = ride.contact, ride.ground, ride.wheel_radius
    s, height = touch.position[i], touch.hub_height[i]
    axes.fill_between(ground.s, ground.z, height - 3.0 * radius, color=GROUND, alpha=0.45, linewidth=0)
    doubtful = bool(ride.limits[i] & DOUBTS.value)
    axes.add_patch(Circle((s, height), radius, fill=False, linewidth=2.0, color=DOUBT if doubtful else WHEEL))
    if touch.deflection[i] > 0.0:
        depth = radius - touch.deflection[i]
        foot = (s - depth * np.sin(touch.inclination[i]), height - depth * np.cos(touch.inclination[i]))
        axes.plot([foot[0], s], [foot[1], height], color=FORCE, linewidth=1.5)
    axes.set_aspect("equal")
    axes.set_xlim(s - 3.0 * radius, s + 3.0 * radius)
    axes.set_ylim(height - 1.6 * radius, height + 1.3 * radius)
    radius_text = "flat" if np.isinf(touch.surface_radius[i]) else f"{touch.surface_radius[i]:.2f} m"
    axes.set_title(
        f"{ride.time[i]:.2f} s   deflection {1000.0 * touch.deflection[i]:.1f} mm   surface radius {radius_text}   "
        f"force {ride.radial_force[i]:.0f} N",
        fontsize=9,
    )
    axes.set_ylabel("height [m]")


def _shade(axes: Axes, ride: Ride) -> None:
    for limit, color, label in (
        (DOUBTS, DOUBT, "outside the article's limits"),
        (Limit.AIRBORNE, AIR, "off the ground"),
    ):
        for k, (start, width) in enumerate(_stretches(ride, limit)):
            axes.axvspan(
                start, start + width, color=color, alpha=0.16, linewidth=0, label=None if k else label
            )


def _stretches(ride: Ride, limit: Limit) -> list[tuple[float, float]]:
    """Return start and length [m] of the stretches of the ride with any bit of `limit`."""
    marked = np.concatenate([[False], (ride.limits & limit.value) != 0, [False]])
    change = np.flatnonzero(np.diff(marked.astype(np.int8)))
    edges: Floats = np.concatenate([ride.contact.position, ride.contact.position[-1:]])
    return [
        (float(edges[a]), float(edges[b] - edges[a])) for a, b in zip(change[::2], change[1::2], strict=True)
    ]


def _save(figure: Figure, path: str | Path) -> None:
    try:
        figure.savefig(path, dpi=120, format="png")
    except OSError as error:
        raise TirelabError(f"{path}: {error.strerror or error}; name a file that can be written") from None
