"""tirelab identify: recordings in, a tire out."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from radialtire import write_tire
from radialtire.tirefile import LAWS

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, reading_options

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress, TaskID

    from ..identification.result import Identification
    from ..recordings.recording import Recording

PART_LAWS = ("linear_gap", "power_gap")
"""Laws of `--part` that a tire file holds."""

WIDTH_LEAST = 100
"""Columns that the tables need; a narrower terminal wraps them, a file has room."""


@click.command("identify", cls=SentenceCommand)
@click.argument("recordings", metavar="RECORDING...", nargs=-1, required=True, type=FILE)
@click.option(
    "--out",
    type=FILE,
    default=Path("tire.json"),
    show_default=True,
    metavar="FILE",
    help="The tire file written.",
)
@click.option(
    "--law",
    type=click.Choice(["auto", *LAWS]),
    default="auto",
    show_default=True,
    help="The form of A(R) and B(R).",
)
@click.option(
    "--part",
    type=click.Choice(["compare", *PART_LAWS]),
    help="For any spring, also one that pulls: compare laws (linear, with gap or preload, power, polynomial, "
    "piecewise, MF-Tyre), and write the tire file of the one named.",
)
@click.option("--name", default="", help="The tire's name.")
@reading_options
def command(
    recordings: tuple[Path, ...], law: str, part: str | None, reading: Reading, **options: Any
) -> None:
    """Identify the tire that RECORDING..., files or folders of them, show, and say how sure that is.

    Writes the tire file, and beside it FILE.identification.json with uncertainties, intervals and Table 1.
    """
    from rich.console import Console

    from ..identification.identify import identify
    from ..identification.misfit import misfit_sentence
    from ..recordings.files import recording_files

    out, name = options["out"], options["name"]
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDTH_LEAST
    files, skipped = recording_files(recordings, reading.columns)
    for file in skipped:
        console.print(f"note: {file}", markup=False, soft_wrap=True)
    with _bars() as bars:
        read = [reading(path) for path in bars.track(files, description="reading")]
        if part is not None:
            _part(console, read, part, out, name)
            return
        tasks: dict[str, TaskID] = {}

        def show(what: str, done: int, total: int) -> None:
            if what not in tasks:
                tasks[what] = bars.add_task(what)
            bars.update(tasks[what], completed=done, total=total or None)

        found = identify(read, law=law, name=name, progress=show)
    _print(console, read, found)
    words = ["tirelab", "diagnose", *map(str, recordings), "--tire", str(out), *reading.words()]
    misfit = misfit_sentence(found.rmse, found.reading_noise, shlex.join(words))
    if misfit:
        console.print(f"- {misfit}", markup=False, soft_wrap=True)
    beside = out.parent / f"{out.stem}.identification.json"
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        write_tire(found.tire, out)
        beside.write_text(found.to_json(), encoding="utf-8")
    except OSError as error:
        raise TirelabError(f"{out} cannot be written ({error.strerror}); name another with --out") from None
    console.print(f"tire: {out}\nuncertainties: {beside}", soft_wrap=True)


def _part(console: Console, recordings: list[Recording], part: str, out: Path, name: str) -> None:
    """Print what the laws leave of recordings of a part; write the tire file of the law that is named."""
    from ..identification.part_laws import fit_laws, tire_of
    from ..identification.table import law_table

    for recording in recordings:
        for note in recording.notes:
            console.print(f"note: {recording.name}: {note}", markup=False, soft_wrap=True)
    fits = fit_laws(recordings)
    console.print(law_table(fits))
    if part == "compare":
        return
    tire = tire_of(next(fit for fit in fits if fit.name == part), recordings, name)
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        write_tire(tire, out)
    except OSError as error:
        raise TirelabError(f"{out} cannot be written ({error.strerror}); name another with --out") from None
    console.print(f"tire: {out}", soft_wrap=True)


def _bars() -> Progress:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not Console(stderr=True).is_terminal,
    )


def _print(console: Console, recordings: list[Recording], found: Identification) -> None:
    from ..identification.table import constant_table, surface_table

    for recording in recordings:
        for note in recording.notes:
            console.print(f"note: {recording.name}: {note}", markup=False, soft_wrap=True)
    console.print(surface_table(found))
    console.print(constant_table(found))
    console.print(
        f"RMSE of the law over all samples: {found.rmse:.3g} N (two stages: {found.two_stage_rmse:.3g} N)"
    )
    for note in found.notes:
        console.print(f"- {note}", markup=False, soft_wrap=True)
