"""tirelab diagnose: which physics a simulation left out of recordings, and the corrected tire."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, check_files, out_option, reading_options

if TYPE_CHECKING:
    from ..diagnosis.diagnosis_run import DiagnosisRun

COLUMNS = 100
"""Width of the report where the output is no terminal."""


@click.command("diagnose", cls=SentenceCommand)
@click.argument("recordings", type=FILE, nargs=-1, required=True, metavar="RECORDING...")
@click.option("--tire", type=FILE, help="Tire file of the baseline.  [default: the article's tire]")
@click.option(
    "--held-out",
    type=FILE,
    multiple=True,
    metavar="RECORDING",
    help="Recording that is not fitted, only used to check the correction, or a range of the one RECORDING: 20s:30s; "
    "may be repeated.",
)
@click.option(
    "--fit", metavar="RANGE", help="Part of the one RECORDING that is fitted: 0s:20s (time), 100:2000 (rows)."
)
@out_option("diagnosis")
@reading_options
@click.option(
    "--believed-force",
    metavar="COLUMN",
    help="Look for effects beside a simulation: the recordings' column of its force.",
)
@click.option("--json", "as_json", is_flag=True, help="Print only diagnosis.json.")
@click.option("--quiet", is_flag=True, help="Show no progress.")
@click.option(
    "--each",
    is_flag=True,
    help="Batch diagnosis: one verdict per recording or folder, and a summary table; continues where it stopped.",
)
@click.option("--jobs", type=int, help="With --each: number of processes.  [default: one per core]")
@click.option("--dask", metavar="ADDRESS", help="With --each: address of the scheduler of a Dask cluster.")
def command(recordings: tuple[Path, ...], each: bool, **options: Any) -> None:
    """Find the physics that a tire model lacks to reproduce RECORDING... (files or folders), and correct it."""
    believed = options.pop("believed_force")
    if believed is not None:
        reading: Reading = options["reading"]
        options["reading"] = replace(reading, columns={**reading.columns, "believed_force": believed})
    fit = options.pop("fit")
    options["held_out"] = tuple(_ranged(recordings, file) for file in options["held_out"])
    if fit is not None:
        recordings = (_ranged(recordings, Path(fit), "--fit"),)
    check_files((*recordings, *options["held_out"]))
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
        raise TirelabError(f"{option} {given}: is no range; write 0s:20s (time) or 100:2000 (rows)")
    if len(recordings) != 1 or recordings[0].is_dir():
        raise TirelabError(
            f"{option} {given}: is a range of one recording; name its file, as in press.csv@{given}"
        )
    return recordings[0].with_name(f"{recordings[0].name}@{given}")


def _batch(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    if options["held_out"] or options["as_json"]:
        raise TirelabError(
            "--each cannot be combined with --held-out or --json; read its summary.csv instead"
        )
    from rich.console import Console

    from ..batch.batch import Batch, diagnose_batch
    from ..batch.summary import summary_table
    from ..computing.workers import Cores

    folder: Path = options["out"]
    cores = Cores(options["jobs"], options["dask"])
    batch = Batch(recordings, folder, options["tire"], options["reading"])
    result = diagnose_batch(batch, cores, click.echo)
    Console(highlight=False).print(summary_table(result))
    click.echo(f"summary: {folder / 'summary.csv'}, {folder / 'summary.html'}")


def _single(recordings: tuple[Path, ...], options: Mapping[str, Any]) -> None:
    if options["jobs"] is not None or options["dask"] is not None:
        raise TirelabError("--jobs and --dask need --each; add --each, or remove them")
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
    """Give a function that shows a stage on standard error: a live line in a terminal, else one plain line each."""
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
    """Print a line, with a question mark for each letter that the encoding of the output lacks."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    click.echo(line.encode(encoding, errors="replace").decode(encoding))
