"""build_fmu.py and tirelab build: a tire file packed as an FMU."""

from __future__ import annotations

from pathlib import Path

import click
from radialtire import TireModel, read_tire

from ..errors import TirelabError
from .options import FILE, SentenceCommand
from .output import Output, example, output_options


@click.command("build", cls=SentenceCommand, epilog=example("tirelab build --tire tire.json --out dist"))
@click.option("--tire", type=FILE, help="The tire file.  [default: the article's tire]")
@click.option(
    "--native",
    is_flag=True,
    help="Without Python inside: Co-Simulation and Model Exchange on Linux, Windows and macOS.",
)
@click.option(
    "--fmi",
    type=click.Choice(["2", "3"]),
    default="2",
    show_default=True,
    help="Version of FMI; 3 needs --native.",
)
@output_options("dist")
def command(tire: Path | None, native: bool, fmi: str, output: Output) -> None:
    """Pack a tire as DIR/BicycleTire.fmu, an FMI 2.0 Co-Simulation unit, and validate it."""
    model = TireModel() if tire is None else read_tire(tire)
    if native:
        _native(model, int(fmi), output)
        return
    if fmi == "3":
        raise TirelabError("the Python FMU is FMI 2.0 only; add --native for FMI 3.0")

    from ..fmu.build import build_fmu
    from ..fmu.loader import NO_COMPILER

    output.stage("compiling and packing the FMU")
    built = build_fmu(model, output.out)
    lines = [f"{built.path}: {model.name}, FMI 2.0 Co-Simulation, valid, guid {built.guid}"]
    if built.compiler is None:
        lines.append(NO_COMPILER)
    else:
        glibc = (
            f"glibc {built.compiler.glibc} or newer"
            if built.compiler.glibc
            else "this machine's glibc or newer"
        )
        lines.append(f"Linux binary: compiled by {built.compiler.name}, for {glibc}")
    compiler = None if built.compiler is None else built.compiler.name
    content = {"fmu": str(built.path), "tire": model.name, "guid": built.guid, "compiler": compiler}
    output.result(lines, content)


def _native(model: TireModel, fmi: int, output: Output) -> None:
    from ..fmu.native.make import PLATFORMS
    from ..fmu.native.pack import build_native_fmu

    output.stage("packing the FMU")
    built = build_native_fmu(model, output.out, fmi=fmi)
    binaries = [platform.folder(fmi) for platform in PLATFORMS]
    kinds = f"FMI {fmi}.0 Co-Simulation and Model Exchange"
    lines = [
        f"{built.path}: {model.name}, {kinds}, valid, guid {built.guid}",
        f"binaries: {', '.join(binaries)}",
    ]
    content = {"fmu": str(built.path), "tire": model.name, "guid": built.guid, "binaries": binaries}
    output.result(lines, content)
