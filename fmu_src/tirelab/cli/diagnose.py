"""tirelab diagnose: which physics a simulation left out of recordings, and the tire with it."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, check_files, out, reading

if TYPE_CHECKING:
    from ..diagnosis.diagnosis_run import DiagnosisRun

COLUMNS = 100
"""Width of the report where the output is no terminal."""


@click.command("diagnose", cls=SentenceCommand)
@click.argument("recordings", type=FILE, nargs=-1, required=True, metavar="RECORDING...")
@click.option("--tire", type=FILE, help="The baseline: a tire file.  [default: the article's tire]")
@click.option(
    "--held-out",
    type=FILE,
    multiple=True,
    metavar="RECORDING",
    help="A recording kept from the fit, on which the correction is judged; may be given again.",
)
@out("diagnosis")
@reading
@click.option("--json", "as_json", is_flag=True, help="Print diagnosis.json alone.")
@click.option("--quiet", is_flag=True, help="Show no progress.")
@click.option(
    "--each",
    is_flag=True,
    help="Batch diagnosis: one verdict per recording or folder, and a summary table; goes on where it stopped.",
)
@click.option("--jobs", type=int, help="With --each: processes to work in.  [default: one per core]")
@click.option("--dask", metavar="ADDRESS", help="With --each: scheduler of a Dask cluster to work on.")
def command(recordings: tuple[Path, ...], each: bool, **options: Any) -> None:
    """Say which physics a tire lacks to follow RECORDING..., files or folders of them, and correct it."""
    check_files((*recordings, *options["held_out"]))
    if each:
        _batch(recordings, options)
    else:
        _single(recordings, options)


def _batch(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    if options["held_out"] or options["as_json"]:
        raise TirelabError("--each goes with neither --held-out nor --json; read its summary.csv instead")
    from rich.console import Console

    from ..batch.batch import Batch, diagnose_batch
    from ..batch.summary import summary_table
    from ..batch.workers import Cores

    folder: Path = options["out"]
    cores = Cores(options["jobs"], options["dask"])
    batch = Batch(recordings, folder, options["tire"], options["reading"])
    result = diagnose_batch(batch, cores, click.echo)
    Console(highlight=False).print(summary_table(result))
    click.echo(f"summary: {folder / 'summary.csv'}, {folder / 'summary.html'}")


def _single(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    if options["jobs"] is not None or options["dask"] is not None:
        raise TirelabError("--jobs and --dask say where to work with --each; add it, or leave them out")
    from ..diagnosis.diagnosis_run import run_diagnosis
    from ..report.terminal import printable

    folder: Path = options["out"]
    how: Reading = options["reading"]
    with _progress(options["quiet"]) as progress:
        run = run_diagnosis(
            recordings,
            folder,
            tire=options["tire"],
            held_out=options["held_out"],
            reading=how,
            progress=progress,
        )
    if options["as_json"]:
        click.echo(json.dumps(run.content, indent=2, allow_nan=False))
        for warning in run.warnings:
            click.echo(f"note: {printable(warning)}", err=True)
        return
    for note in (*run.notes, *run.warnings):
        _echo(f"note: {printable(note)}")
    _print(run, folder)


@contextmanager
def _progress(quiet: bool) -> Iterator[Callable[[str], None]]:
    """Give a function that shows a stage on standard error: in place of the last one in a terminal, else as a line."""
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    from ..report.terminal import printable

    console = Console(stderr=True)
    if quiet:
        yield lambda sentence: None
    elif not console.is_terminal:
        yield lambda sentence: click.echo(printable(sentence), err=True)
    else:
        shown = (SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
        with Progress(*shown, console=console, transient=True) as progress:
            task = progress.add_task("starting", total=None)
            yield lambda sentence: progress.update(task, description=printable(sentence))


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
        _echo(line.rstrip())


def _echo(line: str) -> None:
    """Print a line, with question marks for letters that the output's encoding lacks."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    click.echo(line.encode(encoding, errors="replace").decode(encoding))
