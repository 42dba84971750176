"""tirelab ride: terrain and a tire in, deflection, radius and force out, with the share that is doubtful."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
from radialtire import TireModel, read_tire

from ..errors import TirelabError
from ..terrain import (
    OBSTACLES,
    WHEEL_RADIUS,
    Profile,
    Ride,
    TireForce,
    add_roughness,
    animate_ride,
    draw_ride,
    flat,
    ground_from,
    iso8608,
    place,
    read_profile,
    ride,
)
from ..terrain.iso8608 import GEOMETRIC_MEAN
from ..terrain.profile import Floats
from ..terrain.profile_file import read_columns
from .options import FILE, SentenceCommand


@click.command("ride", cls=SentenceCommand)
@click.argument("profile", required=False, type=FILE)
@click.option(
    "--iso-class", type=click.Choice(list(GEOMETRIC_MEAN)), help="Random ground of this ISO 8608 class."
)
@click.option("--seed", default=0, show_default=True, help="Which random ground.")
@click.option("--length", default=20.0, show_default=True, help="Length [m] of ground that no file gives.")
@click.option(
    "--obstacle",
    multiple=True,
    metavar="NAME[@S]",
    help=f"Add {', '.join(OBSTACLES)} at S [m]; middle if not said.",
)
@click.option("--speed", default=5.0, show_default=True, help="Speed [m/s].")
@click.option(
    "--load", type=float, help="Load [N] that the wheel carries, without bouncing; 500 without --hub-path."
)
@click.option("--hub-path", type=FILE, help="CSV with the hub's path: s [m], h [m].")
@click.option("--tire", type=FILE, help="Tire file (JSON); the article's tire if not given.")
@click.option("--wheel-radius", default=WHEEL_RADIUS, show_default=True, help="Unloaded radius [m].")
@click.option("--spacing", type=float, help="Distance [m] of samples of the ground.")
@click.option(
    "--smoothing-length", type=float, help="Wavelength [m] of which smoothing keeps half; 0 for none."
)
@click.option("--output", type=FILE, help="Write the ride as CSV.")
@click.option("--picture", type=FILE, help="Write a picture (PNG).")
@click.option("--animation", type=FILE, help="Write an animation (GIF).")
def command(
    profile: Path | None,
    iso_class: str | None,
    seed: int,
    length: float,
    obstacle: tuple[str, ...],
    speed: float,
    load: float | None,
    hub_path: Path | None,
    tire: Path | None,
    wheel_radius: float,
    spacing: float | None,
    smoothing_length: float | None,
    output: Path | None,
    picture: Path | None,
    animation: Path | None,
) -> None:
    """Ride over the terrain of PROFILE (CSV with s [m] and z [m], or GPX), or over random or flat ground.

    Prints the range of deflection and force, and how much of the ride is outside of what the article's tire stands for.
    """
    terrain = _terrain(profile, iso_class, seed, length, obstacle, smoothing_length)
    model = TireModel() if tire is None else read_tire(tire)
    position, hub_height = (None, None) if hub_path is None else read_columns(hub_path, ("s", "h"))[0]
    if load is None and hub_path is None:
        load = 500.0
    result = ride(
        ground_from(terrain, spacing),
        law_force(model),
        speed=speed,
        load=load,
        position=position,
        hub_height=hub_height,
        wheel_radius=wheel_radius,
    )
    for line in _summary(result, model):
        click.echo(line)
    if output is not None:
        write_ride(result, output)
    if picture is not None:
        draw_ride(result, picture)
    if animation is not None:
        animate_ride(result, animation)


def law_force(tire: TireModel) -> TireForce:
    """Return the elastic law of `tire` for arrays of deflection [m] and surface radius [m]."""

    def force(deflection: Floats, surface_radius: Floats) -> Floats:
        coefficients = np.array([tire.law.coefficients(radius) for radius in surface_radius.tolist()])
        newtons: Floats = coefficients[:, 0] * (100.0 * deflection) ** coefficients[:, 1]
        return newtons

    return force


def write_ride(result: Ride, path: Path) -> None:
    """Write `result` to `path` as CSV, units in the header, `limits` as the bits of `Limit`."""
    columns = {
        "time [s]": result.time,
        "position [m]": result.contact.position,
        "hub_height [m]": result.contact.hub_height,
        "deflection [m]": result.contact.deflection,
        "surface_radius [m]": result.contact.surface_radius,
        "radial_force [N]": result.radial_force,
        "vertical_force [N]": result.vertical_force,
        "limits": result.limits.astype(np.float64),
    }
    try:
        np.savetxt(
            path, np.column_stack(list(columns.values())), "%.9g", ",", header=",".join(columns), comments=""
        )
    except OSError as error:
        raise TirelabError(f"{path}: {error.strerror or error}; name a file that can be written") from None


def _terrain(
    path: Path | None,
    iso_class: str | None,
    seed: int,
    length: float,
    obstacles: tuple[str, ...],
    smoothing_length: float | None,
) -> Profile:
    terrain = None if path is None else read_profile(path)
    if terrain is not None and smoothing_length is not None:
        terrain = Profile(terrain.s, terrain.z, terrain.name, smoothing_length, terrain.notes)
    if iso_class is not None:
        rough = iso8608(iso_class, length if terrain is None else terrain.length, seed)
        terrain = rough if terrain is None else add_roughness(terrain, rough)
    if terrain is None:
        terrain = flat(length)
    start, span = terrain.s[0], terrain.length
    for word in obstacles:
        name, at, where = word.partition("@")
        try:
            shape = OBSTACLES[name]
            position = float(where) if at else float(start + 0.5 * span)
        except (KeyError, ValueError):
            raise TirelabError(
                f"--obstacle {word}: give one of {', '.join(OBSTACLES)}, and its place as in log@12.5"
            ) from None
        terrain = place(terrain, shape(), position)
    return terrain


def _summary(result: Ride, tire: TireModel) -> list[str]:
    touch, force = result.contact, result.radial_force
    length = touch.position[-1] - touch.position[0]
    lines = [
        f"{result.ground.name}: {length:.1f} m at {result.speed:g} m/s, {touch.position.size} positions",
        *(f"note: {note}" for note in result.ground.notes),
        f"tire: {tire.name}",
        f"deflection {1000.0 * touch.deflection.min():.1f} to {1000.0 * touch.deflection.max():.1f} mm",
        f"radial force {force.min():.0f} to {force.max():.0f} N, mean {force.mean():.0f} N",
    ]
    if tire.effects:
        names = ", ".join(effect.name for effect, _ in tire.effects)
        lines.insert(2, f"note: the tire's elastic law alone; its effects ({names}) act in the FMU")
    return lines + list(result.report.sentences())
