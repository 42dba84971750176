"""build_fmu.py and tirelab build: a tire file packed as an FMU."""

from __future__ import annotations

from pathlib import Path

import click
from radialtire import TireModel, read_tire

from .options import FILE, SentenceCommand, out_option


@click.command("build", cls=SentenceCommand)
@click.option("--tire", type=FILE, help="The tire file.  [default: the article's tire]")
@out_option("dist")
def command(tire: Path | None, out: Path) -> None:
    """Pack a tire as DIR/BicycleTire.fmu, an FMI 2.0 Co-Simulation unit, and validate it."""
    from ..fmu.build import build_fmu
    from ..fmu.loader import NO_COMPILER

    model = TireModel() if tire is None else read_tire(tire)
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
