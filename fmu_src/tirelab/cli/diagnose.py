"""tirelab diagnose: which physics a simulation left out of recordings, and the tire with it."""

from __future__ import annotations

import io
import json
import os
import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import numpy as np
import polars as pl
from numpy.typing import NDArray
from radialtire import TireModel, read_tire, write_tire
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from ..batch.batch import diagnose_each
from ..batch.summary import summary_table
from ..batch.workers import Cores
from ..diagnosis.diagnose import diagnose
from ..diagnosis.verdict import Verdict
from ..errors import TirelabError
from ..fmu.build import build_fmu
from ..fmu.replay import replay
from ..recordings.formats import LOADERS
from ..recordings.recording import Recording
from ..report import write_report
from ..report.outcome import DIAGNOSIS, REPORT, TEST, TIRE, Replayed, beside, contract_of
from ..report.terminal import print_diagnosis, printable
from ..simulation.simulate import simulate
from .options import FILE, Reading, SentenceCommand, out, reading

AGREEMENT = 1e-9
"""The FMU and the simulation differ by less than this part of the largest force: they sum the same in another order."""

COLUMNS = 100
"""Width of the report where the output is no terminal."""


@click.command("diagnose", cls=SentenceCommand)
@click.argument("recordings", type=FILE, nargs=-1, required=True, metavar="RECORDING...")
@click.option(
    "--tire", type=FILE, help="The tire that was believed, a tire file.  [default: the article's tire]"
)
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
    help="One verdict per recording or folder, and a summary table; goes on where it stopped.",
)
@click.option("--jobs", type=int, help="With --each: processes to work in.  [default: one per core]")
@click.option("--dask", metavar="ADDRESS", help="With --each: scheduler of a Dask cluster to work on.")
def command(
    recordings: tuple[Path, ...],
    tire: Path | None,
    held_out: tuple[Path, ...],
    out: Path,
    reading: Reading,
    as_json: bool,
    quiet: bool,
    each: bool,
    jobs: int | None,
    dask: str | None,
) -> None:
    """Say which physics a tire lacks to follow RECORDING..., files or folders of them, and correct it."""
    if each:
        if held_out or as_json:
            raise TirelabError("--each goes with neither --held-out nor --json; read its summary.csv instead")
        found = diagnose_each(
            recordings, out, tire=tire, cores=Cores(jobs, dask), options=reading.words(), tell=click.echo
        )
        Console(highlight=False).print(summary_table(found))
        click.echo(f"summary: {out / 'summary.csv'}, {out / 'summary.html'}")
        return
    if jobs is not None or dask is not None:
        raise TirelabError("--jobs and --dask say where to work with --each; add it, or leave them out")
    told = {"--tire": tire, "--out": out}
    words = ["tirelab", "diagnose", *(str(r) for r in recordings)]
    words += [str(part) for option, value in told.items() if value is not None for part in (option, value)]
    words += reading.words()
    words += [str(part) for kept in held_out for part in ("--held-out", kept)]

    believed = TireModel() if tire is None else read_tire(tire)
    files, kept_files = _files(recordings), _files(held_out)
    _check_once([*files, *kept_files])
    _check_folder(out)
    with _progress(quiet) as tell:

        def read(file: Path) -> Recording:
            tell(f"reading {file.name}")
            return reading(file)

        fitted, kept = [read(file) for file in files], [read(file) for file in kept_files]
        verdict = diagnose(fitted, believed, held_out=kept, progress=tell)
        tell("building the corrected FMU")
        corrected = _named(verdict, believed, fitted)
        fmu = build_fmu(corrected, out).path
        warnings: list[str] = []

        def replayed(recorded: Sequence[Recording]) -> Replayed:
            forces = []
            for r in recorded:
                tell(f"replaying the corrected FMU on {r.name}")
                forces.append(replay(fmu, r))
                warnings.extend(_disagreement(r, forces[-1], simulate(corrected, r)))
            return Replayed(recorded, [simulate(believed, r) for r in recorded], forces)

        on_fitted, on_kept = replayed(fitted), replayed(kept)
        tell("writing the report")
        diagnosis = contract_of(verdict, on_fitted, on_kept)
        report = {
            **diagnosis,
            **beside(verdict),
            "tire_before": believed.name,
            "tire_after": corrected.name,
            "warnings": warnings,
            "command": shlex.join(words),
        }
        _write(out, diagnosis, corrected, verdict)
        write_report(
            out / REPORT,
            report,
            fitted,
            on_fitted.before,
            on_fitted.after,
            held_out=(kept, on_kept.before, on_kept.after) if kept else None,
        )
    if as_json:
        click.echo(json.dumps(diagnosis, indent=2, allow_nan=False))
        for warning in warnings:
            click.echo(f"note: {printable(warning)}", err=True)
        return
    for recording in (*fitted, *kept):
        for note in recording.notes:
            _echo(f"note: {printable(f'{recording.name}: {note}')}")
    for warning in warnings:
        _echo(f"note: {printable(warning)}")
    _report(diagnosis, out)


def _files(given: Sequence[Path]) -> list[Path]:
    """Return the recordings' files, those of a folder in the order of their names."""
    found = []
    for path in given:
        if not path.is_dir():
            found.append(path)
            continue
        inside = sorted(f for f in path.iterdir() if f.suffix.lower() in LOADERS and f.is_file())
        if not inside:
            raise TirelabError(f"{path} holds no recording; a recording ends in one of {', '.join(LOADERS)}")
        found += inside
    return found


def _check_once(files: Sequence[Path]) -> None:
    seen = set()
    for file in files:
        if file.resolve() in seen:
            raise TirelabError(f"{file} is given twice; a recording is either fitted or held out, once")
        seen.add(file.resolve())


def _check_folder(out: Path) -> None:
    """Raise TirelabError where `out` cannot become a folder to write into: before the work, not after it."""
    there = next(path for path in (out.absolute(), *out.absolute().parents) if path.exists())
    if not there.is_dir() or not os.access(there, os.W_OK):
        why = "is not writable" if there.is_dir() else "is a file"
        raise TirelabError(f"{out} cannot be written, {there} {why}; name another folder with --out")


def _named(verdict: Verdict, believed: TireModel, fitted: Sequence[Recording]) -> TireModel:
    """Return the corrected tire under a name of its own, unless it is the believed one."""
    if verdict.tire.law == believed.law and verdict.tire.effects == believed.effects:
        return verdict.tire
    names = ", ".join(r.name for r in fitted)
    return replace(
        verdict.tire,
        name=f"{believed.name}, corrected",
        source=f"{believed.source}; corrected by tirelab diagnose with {names}",
    )


def _disagreement(
    recording: Recording, replayed: NDArray[np.float64], simulated: NDArray[np.float64]
) -> list[str]:
    """Return the sentence to be said where the FMU does not do what the simulation did."""
    apart = float(np.max(np.abs(replayed - simulated)))
    if apart <= AGREEMENT * float(np.max(np.abs(simulated))) + 1e-12:
        return []
    return [
        f"on {recording.name} the corrected FMU differs by up to {apart:.3g} N from the simulation that was fitted; "
        "the errors told are the FMU's"
    ]


def _write(out: Path, diagnosis: dict[str, Any], corrected: TireModel, verdict: Verdict) -> None:
    """Write all but the FMU and the report; a test of an earlier diagnosis is removed."""
    test = verdict.separating_test
    try:
        write_tire(corrected, out / TIRE)
        (out / DIAGNOSIS).write_text(
            json.dumps(diagnosis, indent=2, allow_nan=False) + "\n", encoding="utf-8"
        )
        (out / TEST).unlink(missing_ok=True)
        if test is not None:
            motion = test.test
            pl.DataFrame(
                {
                    "time [s]": np.round(motion.time, 9),
                    "deflection [cm]": np.round(100.0 * motion.deflection, 9),
                    "radius [cm]": np.round(100.0 * motion.surface_radius, 9),
                }
            ).write_csv(out / TEST)
    except OSError as error:
        raise TirelabError(f"{out} cannot be written ({error.strerror}); name another with --out") from None


@contextmanager
def _progress(quiet: bool) -> Iterator[Any]:
    """Give a function that shows a sentence on the terminal's standard error, in place of the one before."""
    console = Console(stderr=True)
    shown = (SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
    with Progress(
        *shown, console=console, transient=True, disable=quiet or not console.is_terminal
    ) as progress:
        task = progress.add_task("starting", total=None)
        yield lambda sentence: progress.update(task, description=printable(sentence))


def _report(diagnosis: dict[str, Any], out: Path) -> None:
    if sys.stdout.isatty():
        console = Console(markup=False, highlight=False, emoji=False)
        print_diagnosis(console, diagnosis, out)
        return
    text = io.StringIO()
    plain = Console(file=text, width=COLUMNS, color_system=None, markup=False, highlight=False, emoji=False)
    print_diagnosis(plain, diagnosis, out)
    for line in text.getvalue().splitlines():
        _echo(line.rstrip())


def _echo(line: str) -> None:
    """Print a line, with question marks for letters that the output's encoding lacks."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    click.echo(line.encode(encoding, errors="replace").decode(encoding))
