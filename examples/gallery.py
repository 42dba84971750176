"""The pictures of examples/docs: the law, rides over obstacles and rough ground, and the quarter bicycle.

    python examples/gallery.py [--out examples/docs] [NAME ...]

draws all of them, or those named.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import click
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from radialtire import Hull1996, TireModel
from radialtire.hull1996 import CONCAVE_RADIUS_RANGE, CONVEX_RADIUS_RANGE, SECOND_READING
from radialtire.power_law import force
from tirelab.terrain import OBSTACLES, HubPath, draw_ride, flat, ground_from, place, ride

sys.path.insert(0, str(Path(__file__).resolve().parent / "quarter_bicycle"))
from ride_with_fmu import COUPLINGS, STEPS, outcome, reference, stepped
from rides import GROUNDS, RideOnGround, elastic, elastic_array

Floats = NDArray[np.float64]
TIRE = TireModel()
LOAD = 500.0
"""Load [N] of the slow rides."""

COLORS = ("#1f5a99", "#d1495b", "#5b8c5a", "#e08e2b", "#7d5ba6", "#444444")
RADII = (0.0127, 0.0508, 0.254, np.inf, -0.584, -0.381)
"""Surfaces [m] of the law's curves: the sharpest and the tightest tested, and some between."""


def law(path: Path) -> None:
    """Draw A and B over the ground's curvature, and the force over the deflection on a few surfaces."""
    figure = Figure(figsize=(10.0, 7.2), layout="constrained")
    axes = figure.subplots(2, 2)
    curvature = np.linspace(1.0 / CONCAVE_RADIUS_RANGE[1], 1.0 / CONVEX_RADIUS_RANGE[0], 2001)
    radius = np.divide(1.0, curvature, out=np.full(curvature.shape, np.inf), where=np.abs(curvature) > 1e-9)
    readings = {
        "E0 = 0.2519 /cm, as printed": Hull1996(),
        "E0 = 0.02519 /cm": Hull1996(convex_coefficient_decay=SECOND_READING),
    }
    for (label, reading), color in zip(readings.items(), COLORS, strict=False):
        values = np.array([reading.coefficients(r) for r in radius.tolist()])
        axes[0, 0].plot(curvature, values[:, 0], color=color, label=label)
    axes[0, 1].plot(curvature, values[:, 1], color=COLORS[5])
    for panel, name in ((axes[0, 0], "A [N/cm^B]"), (axes[0, 1], "B [1]")):
        panel.set_xlabel("curvature of the ground 1/R [1/m]: concave < 0 < convex")
        panel.set_ylabel(name)
        panel.axvline(0.0, color="#bbbbbb", linewidth=0.8, zorder=0)
    axes[0, 0].set_ylim(0.0, None)
    axes[0, 0].legend(fontsize=8)
    axes[0, 0].set_title("coefficient and exponent of F = A x^B", fontsize=10)
    deflection = np.linspace(0.0, 0.03175, 200)
    for panel, (label, reading) in zip(axes[1], readings.items(), strict=True):
        for r, color in zip(RADII, COLORS, strict=True):
            name = "flat" if np.isinf(r) else f"{'convex' if r > 0 else 'concave'} {abs(100.0 * r):.4g} cm"
            forces = [force(x, *reading.coefficients(r)) for x in deflection.tolist()]
            panel.plot(1000.0 * deflection, forces, color=color, label=name)
        panel.axhline(2240.0, color="#bbbbbb", linewidth=0.8, zorder=0)
        panel.text(0.2, 2260.0, "largest force tested", fontsize=7, color="#777777", va="bottom")
        panel.set_title(label, fontsize=10)
        panel.set_xlabel("deflection [mm]")
        panel.set_ylabel("radial force [N]")
        panel.set_ylim(0.0, 3500.0)
    axes[1, 0].legend(fontsize=8, ncols=2, loc="upper left")
    _save(figure, path)


def over_obstacle(name: str, path: Path) -> None:
    """Draw a slow ride over one obstacle."""
    shape = OBSTACLES[name]()
    half = float(shape.u[-1])
    length = 2.0 * half + 3.0
    ground = ground_from(place(flat(length), shape, 0.5 * length), 0.002)
    draw_ride(
        ride(ground, elastic_array(TIRE), speed=3.0, load=LOAD),
        path,
        f"{name}: the wheel carries {LOAD:g} N all the way, without bouncing",
    )


def rough_ground(path: Path) -> None:
    """Draw the quarter bicycle's ride over class D, with what is doubtful."""
    _draw_motion("class-d", 5.0, path)


def over_log(path: Path) -> None:
    """Draw the quarter bicycle's ride over a log."""
    _draw_motion("log", 5.0, path)


def bicycle_over_root(path: Path) -> None:
    """Draw force, hub and fork over a root at three speeds."""
    figure = Figure(figsize=(10.0, 7.2), layout="constrained")
    rows = figure.subplots(3, 1, sharex=True)
    for speed, color in zip((3.0, 5.0, 8.0), COLORS, strict=False):
        motion = _ride("root", speed).integrated(elastic(TIRE), 801)
        values = (
            motion.radial_force,
            1000.0 * (motion.hub_height - motion.hub_height[0]),
            1000.0 * (motion.states[:, 2] - motion.states[:, 0]),
        )
        for row, value in zip(rows, values, strict=True):
            row.plot(motion.position, value, color=color, label=f"{speed:g} m/s")
    for row, name in zip(
        rows, ("radial force [N]", "rise of the hub [mm]", "fork shortened by [mm]"), strict=True
    ):
        row.set_ylabel(name)
        row.axvspan(
            3.95, 4.05, color="#8a6d4b", alpha=0.3, linewidth=0, label="root" if row is rows[0] else None
        )
    rows[0].axhline(2240.0, color="#bbbbbb", linewidth=0.8, zorder=0)
    rows[0].text(3.41, 2270.0, "largest force tested", fontsize=7, color="#777777", va="bottom")
    rows[0].set_title("the quarter bicycle over a root 5 cm tall", fontsize=11)
    rows[0].legend(fontsize=8)
    rows[2].set_xlabel("position of the hub [m]")
    _save(figure, path)


def which_step(path: Path) -> None:
    """Draw the error of the force and the energy made over the step, for the four ways of coupling."""
    figure = Figure(figsize=(10.0, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    on_root = _ride("root", 5.0)
    truth, law_force = reference(on_root, TIRE), elastic(TIRE)

    def tire(time: float, deflection: float, surface_radius: float) -> float:
        return law_force(deflection, surface_radius) if deflection > 0.0 else 0.0

    for name, color in zip(COUPLINGS, (COLORS[0], COLORS[0], COLORS[1], COLORS[1]), strict=True):
        found = [outcome(on_root, truth, stepped(on_root, tire, 1e-3 * step, name), TIRE) for step in STEPS]
        style = {
            "color": color,
            "marker": "o",
            "markersize": 4.0,
            "linestyle": "--" if "ahead" in name else "-",
        }
        left.loglog(STEPS, [100.0 * o.force for o in found], label=name, **style)
        right.loglog(STEPS, [abs(o.energies.made) for o in found], label=name, **style)
    for panel, title in (
        (left, "RMS error of the force [% of its peak]"),
        (right, "energy that the coupling makes [J], magnitude"),
    ):
        panel.set_title(title, fontsize=10)
        panel.set_xlabel("step [ms]")
        panel.grid(color="#dddddd", linewidth=0.6)
    steps = np.array([0.25, 4.0])
    for order, at in ((1, 0.9), (2, 0.0025)):
        left.loglog(steps, at * (steps / 0.25) ** order, color="#999999", linewidth=0.8)
        left.annotate(
            f"order {order}",
            (0.7, at * 2.8**order),
            fontsize=8,
            color="#777777",
            va="top" if order == 2 else "bottom",
            ha="left" if order == 2 else "right",
        )
    for panel in (left, right):
        panel.set_xticks(STEPS, [f"{step:g}" for step in STEPS])
        panel.minorticks_off()
    left.legend(fontsize=7.5)
    figure.suptitle("a root 5 cm tall at 5 m/s, the tire asked once per step", fontsize=11)
    _save(figure, path)


PICTURES: dict[str, Callable[[Path], None]] = {
    "law": law,
    **{f"ride_{name}": partial(over_obstacle, name) for name in OBSTACLES},
    "bicycle_class_d": rough_ground,
    "bicycle_log": over_log,
    "bicycle_root": bicycle_over_root,
    "which_step": which_step,
}
"""Every picture by the name of its file."""


@cache
def _ride(ground: str, speed: float) -> RideOnGround:
    return GROUNDS[ground](TIRE, speed)


def _draw_motion(ground: str, speed: float, path: Path) -> None:
    on_ground = _ride(ground, speed)
    motion = on_ground.integrated(elastic(TIRE), 2001)
    drawn = ride(
        on_ground.ground,
        elastic_array(TIRE),
        speed=speed,
        hub_path=HubPath(motion.hub_height, motion.position),
    )
    draw_ride(drawn, path, f"the quarter bicycle: {on_ground.name}")


def _reduce(path: Path) -> None:
    """Write the picture at `path` again with a palette: a third of the size, and nothing that shows."""
    with Image.open(path) as picture:
        reduced = picture.convert("RGB").quantize(128, dither=Image.Dither.NONE)
    reduced.save(path, optimize=True)


def _save(figure: Figure, path: Path) -> None:
    FigureCanvasAgg(figure)
    figure.savefig(path, dpi=100, format="png")


@click.command()
@click.argument("names", nargs=-1, type=click.Choice(list(PICTURES)))
@click.option("--out", type=click.Path(path_type=Path), default=Path(__file__).parent / "docs")
def main(names: tuple[str, ...], out: Path) -> None:
    """Draw the pictures NAMES, or all of them."""
    out.mkdir(parents=True, exist_ok=True)
    for name in names or PICTURES:
        PICTURES[name](out / f"{name}.png")
        _reduce(out / f"{name}.png")
        click.echo(out / f"{name}.png")


if __name__ == "__main__":
    main()
