"""build_fmu.py and tirelab build: a tire file packed as an FMU."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from radialtire import TireModel, read_tire

from ..errors import TirelabError
from .options import FILE, SentenceCommand
from .output import Output, example, output_options

if TYPE_CHECKING:
    from ..fmu.build import Correction


@click.command("build", cls=SentenceCommand, epilog=example("tirelab build --tire tire.json --out dist"))
@click.option("--tire", type=FILE, help="The tire file.  [default: the article's tire]")
@click.option(
    "--from",
    "diagnosis",
    type=FILE,
    metavar="DIAGNOSIS",
    help="Build the corrected tire, or the correction, of this diagnosis.json.",
)
@click.option(
    "--with-remainder",
    is_flag=True,
    help="With --from: add the force that no effect explains, as learned; outside the range of learning it fades out.",
)
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
def command(
    tire: Path | None,
    diagnosis: Path | None,
    with_remainder: bool,
    native: bool,
    fmi: str,
    output: Output,
) -> None:
    """Pack a tire as DIR/BicycleTire.fmu, an FMI 2.0 Co-Simulation unit, and validate it."""
    if diagnosis is None:
        if with_remainder:
            raise TirelabError("--with-remainder is that of a diagnosis; name its diagnosis.json with --from")
        model: TireModel | Correction = TireModel() if tire is None else read_tire(tire)
    elif tire is not None:
        raise TirelabError("--tire and --from both name a tire; give one of them")
    else:
        from ..diagnosis.diagnosis_file import read_corrected

        model = read_corrected(diagnosis, with_remainder=with_remainder)
    if not isinstance(model, TireModel):
        _correction(model, native, output)
        return
    if native:
        _native(model, int(fmi), output)
        return
    if model.remainder is not None:
        output.note(f"the FMU has {model.remainder}")
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


def _correction(correction: Correction, native: bool, output: Output) -> None:
    if native:
        raise TirelabError("a correction is written as a Python FMU only; leave out --native")
    from ..fmu.build import build_correction

    if correction.corrected.remainder is not None:
        output.note(f"the FMU has {correction.corrected.remainder}")
    output.stage("compiling and packing the FMU")
    built = build_correction(correction, output.out)
    named = correction.corrected.name
    lines = [
        f"{built.path}: what {correction.believed.name} lacks, FMI 2.0 Co-Simulation, valid, guid {built.guid}"
    ]
    compiler = None if built.compiler is None else built.compiler.name
    content = {"fmu": str(built.path), "tire": named, "guid": built.guid, "compiler": compiler}
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
