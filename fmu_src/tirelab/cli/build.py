"""build_fmu.py and tirelab build: a tire file packed as an FMU."""

from __future__ import annotations

from pathlib import Path

import click
from radialtire import TireModel, read_tire

from .options import FILE, SentenceCommand, out_option


@click.command("build", cls=SentenceCommand)
@click.option("--tire", type=FILE, help="The tire file.  [default: the article's tire]")
@click.option(
    "--native",
    is_flag=True,
    help="Without Python inside: Co-Simulation and Model Exchange on Linux, Windows and macOS.",
)
@out_option("dist")
def command(tire: Path | None, native: bool, out: Path) -> None:
    """Pack a tire as DIR/BicycleTire.fmu, an FMI 2.0 Co-Simulation unit, and validate it."""
    model = TireModel() if tire is None else read_tire(tire)
    if native:
        from ..fmu.native.make import PLATFORMS
        from ..fmu.native.pack import build_native_fmu

        written = build_native_fmu(model, out)
        kinds = "FMI 2.0 Co-Simulation and Model Exchange"
        click.echo(f"{written.path}: {model.name}, {kinds}, valid, guid {written.guid}")
        click.echo(f"binaries: {', '.join(platform.fmi2 for platform in PLATFORMS)}")
        return

    from ..fmu.build import build_fmu
    from ..fmu.loader import NO_COMPILER

    built = build_fmu(model, out)
    click.echo(f"{built.path}: {model.name}, FMI 2.0 Co-Simulation, valid, guid {built.guid}")
    if built.compiler is None:
        click.echo(NO_COMPILER)
    else:
        glibc = (
            f"glibc {built.compiler.glibc} or newer"
            if built.compiler.glibc
            else "this machine's glibc or newer"
        )
        click.echo(f"Linux binary: compiled by {built.compiler.name}, for {glibc}")
