"""tirelab diagnose: which physics a simulation left out of recordings, and the corrected tire."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import click

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, check_files, reading_options
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
    help="Recording that is not fitted, only used to check the correction; may be repeated.",
)
@output_options("diagnosis")
@reading_options
@click.option(
    "--each",
    is_flag=True,
    help="Batch diagnosis: one verdict per recording or folder, and a summary table; continues where it stopped.",
)
@click.option("--jobs", type=int, help="With --each: number of processes.  [default: one per core]")
@click.option("--dask", metavar="ADDRESS", help="With --each: address of the scheduler of a Dask cluster.")
def command(recordings: tuple[Path, ...], each: bool, **options: Any) -> None:
    """Find the physics that a tire model lacks to reproduce RECORDING... (files or folders), and correct it."""
    check_files((*recordings, *options["held_out"]))
    if each:
        _batch(recordings, options)
    else:
        _single(recordings, options)


def _batch(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    output: Output = options["output"]
    if options["held_out"] or output.as_json:
        raise TirelabError(
            "--each cannot be combined with --held-out or --json; read its summary.csv instead"
        )
    from rich.console import Console

    from ..batch.batch import Batch, diagnose_batch
    from ..batch.summary import summary_table
    from ..computing.workers import Cores

    folder = output.out
    cores = Cores(options["jobs"], options["dask"])
    batch = Batch(recordings, folder, options["tire"], options["reading"])
    result = diagnose_batch(batch, cores, (lambda line: None) if output.quiet else click.echo)
    Console(highlight=False).print(summary_table(result))
    click.echo(f"summary: {folder / 'summary.csv'}, {folder / 'summary.html'}")


def _single(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    if options["jobs"] is not None or options["dask"] is not None:
        raise TirelabError("--jobs and --dask need --each; add --each, or remove them")
    from ..diagnosis.diagnosis_run import run_diagnosis

    output: Output = options["output"]
    folder = output.out
    how: Reading = options["reading"]
    with progress(output.quiet, STAGES) as show:
        run = run_diagnosis(
            recordings,
            folder,
            tire=options["tire"],
            held_out=options["held_out"],
            reading=how,
            progress=show,
        )
    if output.as_json:
        click.echo(json.dumps(run.content, indent=2, allow_nan=False))
        for warning in run.warnings:
            click.echo(f"note: {printable(warning)}", err=True)
        return
    for note in run.notes:
        output.note(note)
    for warning in run.warnings:
        echo(f"note: {printable(warning)}")
    _print(run, folder)


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
