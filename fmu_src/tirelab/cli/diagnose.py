"""tirelab diagnose: which physics a simulation left out of recordings, and the corrected tire."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import click

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, check_files, fmu_options, reading_options, simulation_of
from .output import Output, echo, example, output_options, printable, progress

if TYPE_CHECKING:
    from ..diagnosis.diagnosis_run import DiagnosisRun

COLUMNS = 100
"""Width of the report where the output is no terminal."""


STAGES = MappingProxyType(
    {
        "reading": 0.0,
        "comparing": 0.06,
        "fitting": 0.19,
        "validating": 0.6,
        "searching": 0.67,
        "building": 0.87,
        "replaying": 0.9,
        "writing": 0.93,
    }
)
"""Part of the whole time that is spent when each stage begins, as on seven short and on three long recordings."""


@click.command(
    "diagnose",
    cls=SentenceCommand,
    epilog=example("tirelab diagnose slow.csv fast.csv --held-out third.csv --out diagnosis"),
)
@click.argument("recordings", type=FILE, nargs=-1, required=True, metavar="RECORDING...")
@click.option("--tire", type=FILE, help="Tire file of the baseline.  [default: the article's tire]")
@click.option(
    "--held-out",
    type=FILE,
    multiple=True,
    metavar="RECORDING",
    help="Recording used only to check the correction, not fitted, or a range of the one RECORDING: 20s:30s; may be "
    "repeated.",
)
@click.option(
    "--fit", metavar="RANGE", help="Part of the one RECORDING that is fitted: 0s:20s (time), 100:2000 (rows)."
)
@output_options("diagnosis")
@reading_options
@click.option(
    "--believed-force",
    metavar="COLUMN",
    help="Diagnose your own simulation: the column of the recordings with its force.",
)
@click.option("--rig", type=FILE, help="TOML file with the limits of your rig, for the recommended test.")
@click.option(
    "--fmu",
    type=FILE,
    help="Diagnose your own simulation: its FMU, made by any tool. Native code: use one that you trust.",
)
@fmu_options
@click.option("--native", is_flag=True, help="Write DIR/native/BicycleTire.fmu too, which needs no Python.")
@click.option(
    "--each",
    is_flag=True,
    help="Batch diagnosis: one verdict per recording or folder, and a summary table; continues where it stopped.",
)
@click.option("--jobs", type=int, help="With --each: number of processes.  [default: one per core]")
@click.option("--dask", metavar="ADDRESS", help="With --each: address of the scheduler of a Dask cluster.")
def command(recordings: tuple[Path, ...], each: bool, **options: Any) -> None:
    """Find the physics that a tire model lacks to reproduce RECORDING... (files or folders), and correct it."""
    options["tire"] = simulation_of(
        *(options.pop(name) for name in ("tire", "fmu", "variables", "fmu_timeout"))
    )
    believed = options.pop("believed_force")
    if believed is not None:
        reading: Reading = options["reading"]
        options["reading"] = replace(reading, columns={**reading.columns, "believed_force": believed})
    fit = options.pop("fit")
    options["held_out"] = tuple(_ranged(recordings, file) for file in options["held_out"])
    if fit is not None:
        recordings = (_ranged(recordings, Path(fit), "--fit"),)
    check_files((*recordings, *options["held_out"], *([options["rig"]] if options["rig"] else [])))
    if each:
        _batch(recordings, options)
    else:
        _single(recordings, options)


def _ranged(recordings: tuple[Path, ...], given: Path, option: str = "--held-out") -> Path:
    """Return the piece of the one recording that a range means, such as press.csv@0s:20s; a file as it is."""
    if option == "--held-out" and (given.exists() or ":" not in given.name):
        return given
    from ..recordings.pieces import is_range

    if not is_range(str(given)):
        if option == "--held-out":
            return given
        raise TirelabError(f"{option} {given} is no range; write 0s:20s (time) or 100:2000 (rows)")
    if len(recordings) != 1 or recordings[0].is_dir():
        raise TirelabError(
            f"{option} {given} is a range of one recording; name its file, as in press.csv@{given}"
        )
    return recordings[0].with_name(f"{recordings[0].name}@{given}")


def _batch(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    output: Output = options["output"]
    if options["held_out"]:
        raise TirelabError("--each cannot be combined with --held-out; diagnose that recording alone")
    if options["rig"] is not None:
        raise TirelabError("--each recommends no test, so --rig has no use; leave it out")
    if options["native"]:
        raise TirelabError(
            "--each writes Python FMUs only; build one with tirelab build --native --tire FILE"
        )
    if not isinstance(options["tire"], Path | None):
        raise TirelabError("--each takes a tire file; give --tire, or diagnose without --each")
    from rich.console import Console

    from ..batch.batch import Batch, diagnose_batch
    from ..batch.summary import summary_content, summary_table
    from ..computing.workers import Cores

    folder = output.out
    cores = Cores(options["jobs"], options["dask"], output.quiet)
    batch = Batch(recordings, folder, options["tire"], options["reading"])
    result = diagnose_batch(batch, cores, output.stage)
    for path in result.skipped:
        output.note(f"{path} skipped: it is no recording")
    written = [str(folder / "summary.csv"), str(folder / "summary.html")]
    if output.as_json:
        output.result((), {**summary_content(result, folder), "written": written})
        return
    Console(highlight=False).print(summary_table(result))
    echo(f"summary: {', '.join(written)}")


def _single(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    if options["jobs"] is not None or options["dask"] is not None:
        raise TirelabError("--jobs and --dask need --each; add --each, or remove them")
    from ..diagnosis.diagnosis_run import Request, run_request

    output: Output = options["output"]
    folder = output.out
    how: Reading = options["reading"]
    with progress(output.quiet, STAGES) as show:
        asked = Request(recordings, folder, options["tire"], options["held_out"], how, rig=options["rig"])
        run = run_request(asked, show)
    corrects = "correction" in run.content
    if options["native"] and corrects:
        output.note("--native wrote nothing: a correction is written as a Python FMU only")
    native = _native(run, folder, options["native"] and not corrects)
    if output.as_json:
        click.echo(json.dumps(run.content, indent=2, allow_nan=False))
        for warning in run.warnings:
            echo(f"warning: {printable(warning)}", err=True)
        return
    for note in run.notes:
        output.note(note)
    for warning in run.warnings:
        echo(f"warning: {printable(warning)}")
    _print(run, folder)
    if native is not None:
        echo(f"native FMU: {native}")


def _native(run: DiagnosisRun, folder: Path, asked: bool) -> Path | None:
    """Write the native FMU where it is asked for; one of an earlier diagnosis would seem to belong to this one."""
    from ..fmu.archive import MODEL
    from ..fmu.native.pack import build_native_fmu

    if asked:
        return build_native_fmu(run.verdict.tire, folder / "native").path
    (folder / "native" / f"{MODEL}.fmu").unlink(missing_ok=True)
    return None


def _print(run: DiagnosisRun, out: Path) -> None:
    from rich.console import Console

    from ..report.terminal import print_diagnosis

    if sys.stdout.isatty():
        console = Console(markup=False, highlight=False, emoji=False)
        print_diagnosis(console, run.content, out)
        return
    text = io.StringIO()
    plain = Console(file=text, width=COLUMNS, color_system=None, markup=False, highlight=False, emoji=False)
    print_diagnosis(plain, run.content, out)
    for line in text.getvalue().splitlines():
        echo(line.rstrip())
