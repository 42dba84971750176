"""tirelab ride: terrain and a tire in, deflection, radius and force out, with the part that is doubtful."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click
from radialtire import InputError, TireModel, read_tire
from radialtire.hull1996 import WHEEL_RADIUS

from ..errors import TirelabError
from ..names import plain
from .option_group import option_group
from .options import FILE, SentenceCommand
from .output import Output, example, output_options

if TYPE_CHECKING:
    from ..terrain import Profile, ProfileColumns, Ride
    from ..terrain.ride import HeldTire

LOAD = 500.0
"""Load [N] where neither a load nor a path of the hub is given."""


def _known_column(name: str, option: str) -> None:
    if name not in ("s", "z"):
        raise TirelabError(f"{option}: {name!r} is not a column of a profile; name s or z")


@dataclass(frozen=True)
class Terrain:
    """The ground to ride over, as the user describes it beside the file of the profile."""

    columns: str | None
    units: str | None
    iso_class: str | None
    seed: int
    length: float
    obstacle: tuple[str, ...]
    spacing: float | None
    smoothing_length: float | None

    def profile(self, path: Path | None) -> Profile:
        """Return the profile of the file at `path`, or random or flat ground, with the obstacles placed on it."""
        from ..terrain import Profile, add_roughness, flat, iso8608, read_profile

        terrain = None if path is None else read_profile(path, self.source())
        if terrain is not None and self.smoothing_length is not None:
            terrain = Profile(terrain.s, terrain.z, terrain.name, self.smoothing_length, terrain.notes)
        if self.iso_class is not None:
            rough = iso8608(self.iso_class, self.length if terrain is None else terrain.length, self.seed)
            terrain = rough if terrain is None else add_roughness(terrain, rough)
        return self._with_obstacles(flat(self.length) if terrain is None else terrain)

    def source(self) -> ProfileColumns:
        """Return which columns of the file are which, and their units."""
        from ..recordings.assignments import assignments
        from ..terrain import ProfileColumns

        example = 's=Distance,z="Height of ground"'
        columns = assignments(self.columns or "", "--columns", example, _known_column)
        units = assignments(self.units or "", "--units", "s=m,z=mm", _known_column)
        return ProfileColumns(columns, units)

    def _with_obstacles(self, terrain: Profile) -> Profile:
        from ..terrain import OBSTACLES, place

        start, span = terrain.s[0], terrain.length
        for word in self.obstacle:
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


@dataclass(frozen=True)
class Passage:
    """How the wheel passes over the ground: its speed [m/s], and the load [N] it carries or the path of its hub."""

    speed: float
    load: float | None
    hub_path: Path | None
    wheel_radius: float
    inflation_pressure: str | None


@click.command(
    "ride",
    cls=SentenceCommand,
    epilog=example("tirelab ride trail.gpx --speed 5 --obstacle log@12.5 --out ride"),
)
@click.argument("profile", required=False, type=FILE)
@option_group(
    "terrain",
    Terrain,
    click.option("--columns", metavar="s=COLUMN,z=COLUMN", help="Which of PROFILE's columns are s and z."),
    click.option("--units", metavar="s=UNIT,z=UNIT", help="Their units, in place of those in the file."),
    click.option(
        "--iso-class", type=click.Choice(list("ABCDEFGH")), help="Random ground of this ISO 8608 class."
    ),
    click.option("--seed", default=0, show_default=True, help="Seed of the random ground."),
    click.option("--length", default=20.0, show_default=True, help="Length [m] of ground without a file."),
    click.option(
        "--obstacle",
        multiple=True,
        metavar="NAME[@S]",
        help="Add an obstacle (stick, log, root, rut, whoops, kerb) at S [m].  [default place: the middle]",
    ),
    click.option("--spacing", type=float, help="Distance [m] between samples of the ground."),
    click.option(
        "--smoothing-length",
        type=float,
        help="Wavelength [m] at which the smoothing keeps half of the height; 0: no smoothing.",
    ),
)
@option_group(
    "passage",
    Passage,
    click.option("--speed", default=5.0, show_default=True, help="Speed [m/s]."),
    click.option(
        "--load",
        type=float,
        help=f"Load [N] on the wheel, held constant.  [default: {LOAD:g}, or --hub-path]",
    ),
    click.option("--hub-path", type=FILE, help="CSV with the hub's path: s [m], h [m]."),
    click.option(
        "--wheel-radius", default=WHEEL_RADIUS, show_default=True, help="Unloaded radius [m] of the wheel."
    ),
    click.option(
        "--inflation-pressure",
        metavar="VALUE",
        help="Gauge pressure, such as 2.5bar or 36psi.  [default: that at which the tire was measured]",
    ),
)
@click.option("--tire", type=FILE, help="The tire file.  [default: the article's tire]")
@output_options("ride")
@click.option("--animation", is_flag=True, help="Write an animation too (ride.gif).")
def command(
    profile: Path | None,
    terrain: Terrain,
    passage: Passage,
    tire: Path | None,
    output: Output,
    animation: bool,
) -> None:
    """Ride over the terrain of PROFILE (CSV with s [m] and z [m], or GPX), or over random or flat ground.

    Prints the range of deflection and force, and how much of the ride lies outside the tire's limits.
    Writes ride.csv and ride.png.
    """
    from ..computing.staging import staged
    from ..terrain import HubPath, animate_ride, draw_ride, ground_from, ride, write_ride
    from ..terrain.profile_file import read_columns

    model = TireModel() if tire is None else read_tire(tire)
    ground = ground_from(terrain.profile(profile), terrain.spacing)
    load, hub_path, notes = passage.load, None, ground.notes
    if passage.hub_path is not None:
        table = read_columns(passage.hub_path, ("s", "h"))
        position, height = table.values
        hub_path, notes = HubPath(height, position), (*notes, *table.notes)
    elif load is None:
        load = LOAD
    ridden = _at_pressure(model, passage.inflation_pressure)
    result = ride(
        ground,
        ridden,
        speed=passage.speed,
        load=load,
        hub_path=hub_path,
        wheel_radius=passage.wheel_radius,
    )
    names = ["ride.csv", "ride.png", *(["ride.gif"] if animation else [])]
    with staged(output.out) as folder:
        output.stage("writing and drawing the ride")
        write_ride(result, folder / "ride.csv")
        draw_ride(result, folder / "ride.png")
        if animation:
            output.stage("drawing the animation")
            animate_ride(result, folder / "ride.gif")
    written = [str(output.out / name) for name in names]
    notes += _of_effects(model, ridden)
    lines = _summary(result, model, () if output.quiet else notes)
    output.result([*lines, f"written: {', '.join(written)}"], _content(result, model, notes, written))


def _at_pressure(tire: TireModel, text: str | None) -> TireModel | HeldTire:
    """Return the tire, or its force at a pressure that is given with its unit."""
    from ..recordings.units import UnitError, parse_quantity
    from ..terrain.ride import force_at

    if text is None:
        return tire
    try:
        return force_at(tire, {"pressure": parse_quantity(text, "Pa")})
    except (UnitError, InputError, TirelabError) as error:
        raise TirelabError(f"--inflation-pressure: {error}") from None


def _content(result: Ride, tire: TireModel, notes: tuple[str, ...], written: list[str]) -> dict[str, object]:
    """Return what --json prints: lengths [m], forces [N], speed [m/s]."""
    touch, force = result.contact, result.radial_force
    return {
        "ground": result.ground.name,
        "tire": tire.name,
        "speed": result.speed,
        "positions": int(touch.position.size),
        "deflection": [float(touch.deflection.min()), float(touch.deflection.max())],
        "force": [float(force.min()), float(force.max())],
        "force_mean": float(force.mean()),
        "limits": list(result.report.sentences()),
        "notes": list(notes),
        "written": written,
    }


def _of_effects(tire: TireModel, ridden: TireModel | HeldTire) -> tuple[str, ...]:
    """Return the note on which effects of a tire act in the ride and which in its FMU alone, none where it has none."""
    found, acting = [], []
    if not isinstance(ridden, TireModel):
        acting = [effect.name for effect, _ in ridden.acting.effects]
        given = ridden.channels["pressure"]
        own = next(value for _, channel, value in ridden.acting.channels if channel.name == "pressure")
        found.append(
            f"the tire's law is that at {plain(own / 1e5, 4)} bar; its effect {', '.join(acting)} takes it to "
            f"{plain(given / 1e5, 4)} bar, and the tire file does not say between which pressures it was measured"
        )
    learned = [] if tire.remainder is None else ["learned remainder"]
    others = [*(effect.name for effect, _ in tire.effects if effect.name not in acting), *learned]
    if others and acting:
        found.append(f"its other effects ({', '.join(others)}) act in the FMU")
    elif others:
        found.append(f"the tire's elastic law alone; its effects ({', '.join(others)}) act in the FMU")
    return tuple(found)


def _summary(result: Ride, tire: TireModel, notes: tuple[str, ...]) -> list[str]:
    touch, force = result.contact, result.radial_force
    length = touch.position[-1] - touch.position[0]
    return [
        f"{result.ground.name}: {length:.1f} m at {result.speed:g} m/s, {touch.position.size} positions",
        *(f"note: {note}" for note in notes),
        f"tire: {tire.name}",
        f"deflection {1000.0 * touch.deflection.min():.1f} to {1000.0 * touch.deflection.max():.1f} mm",
        f"radial force {force.min():.0f} to {force.max():.0f} N, mean {force.mean():.0f} N",
        *result.report.sentences(),
    ]
