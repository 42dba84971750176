"""tirelab inspect: what is understood of recordings, and the file of settings that keeps it."""

from __future__ import annotations

import io
import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, check_files, reading_options

if TYPE_CHECKING:
    from rich.console import Console

    from ..recordings.inspection import Inspection

COLUMNS = 110
"""Width of the tables where the output is no terminal."""


@click.command("inspect", cls=SentenceCommand)
@click.argument("recordings", metavar="FILE...", nargs=-1, required=True, type=FILE)
@click.option(
    "--out", type=FILE, help="File of settings written.  [default: recording.toml beside each recording]"
)
@click.option("--picture", type=FILE, metavar="PNG", help="Draw the recordings into this picture too.")
@reading_options
def command(recordings: tuple[Path, ...], out: Path | None, picture: Path | None, reading: Reading) -> None:
    """Show what is understood of each FILE (or folder of them), and write it into recording.toml, which all
    commands then use."""
    check_files(recordings)
    from ..recordings.files import recording_files
    from ..recordings.inspection import inspect_recording
    from ..recordings.settings_file import write_settings

    console = _console()
    files, skipped = recording_files(recordings, reading.columns)
    for other in skipped:
        console.print(f"note: {other}", soft_wrap=True)
    found: list[Inspection] = []
    refused: list[str] = []
    for file in files:
        try:
            found.append(inspect_recording(file, reading))
        except TirelabError as error:
            _show_assumed(console, file, reading, error)
            _flush(console)
            if len(files) == 1:
                raise
            refused.append(_refusal(file, error))
            continue
        _show(console, found[-1])
        _flush(console)
    by_file: dict[Path, dict[str, Inspection]] = {}
    for one in found:
        by_file.setdefault(out or one.path.with_name("recording.toml"), {})[one.key] = one
    for target, ones in by_file.items():
        there = " (what else it says stays)" if target.exists() else ""
        write_settings(target, {key: one.settings for key, one in ones.items()})
        console.print(f"settings: {target}{there}", soft_wrap=True)
    if picture is not None and found:
        _draw(found, picture)
        console.print(f"picture: {picture}", soft_wrap=True)
    _flush(console)
    if refused:
        raise TirelabError("\n".join([f"{len(refused)} of {len(files)} files cannot be read:", *refused]))


def _console() -> Console:
    """Return a console on the terminal; where the output is none, one whose lines `_flush` writes."""
    from rich.console import Console

    live = Console(highlight=False, emoji=False, markup=False)
    if live.is_terminal:
        return live
    return Console(
        file=io.StringIO(), width=COLUMNS, color_system=None, highlight=False, emoji=False, markup=False
    )


def _flush(console: Console) -> None:
    """Write what a console without a terminal holds, without the blanks that end the lines of a table."""
    if isinstance(console.file, io.StringIO):
        for line in console.file.getvalue().splitlines():
            click.echo(line.rstrip())
        console.file = io.StringIO()


def _show_assumed(console: Console, file: Path, reading: Reading, error: TirelabError) -> None:
    """Show what is understood of a file where all that it lacks can be guessed; nothing of that is written."""
    from ..recordings.asking import IncompleteRecording
    from ..recordings.inspection import inspect_recording

    if not isinstance(error, IncompleteRecording):
        return
    guessed = error.settings
    choices = replace(reading, columns=guessed.columns, units=guessed.units, radius=guessed.radius)
    try:
        found = inspect_recording(file, choices)
    except TirelabError:
        return
    console.print(f"ASSUMED, and not written: {' '.join(error.words())}", soft_wrap=True)
    _show(console, found)


def _refusal(file: Path, error: TirelabError) -> str:
    words = getattr(error, "words", None)
    if words is None:
        return f"- {error}"
    return f"- {error}\n  {shlex.join(['tirelab', 'inspect', str(file), *words()])}"


def _show(console: Console, one: Inspection) -> None:
    from rich.table import Table
    from rich.text import Text

    from ..report.recording_picture import terminal_picture
    from ..report.terminal import printable

    table = Table(title=printable(one.recording.name), title_justify="left", box=None, pad_edge=False)
    for head in ("channel", "column", "read in", "values", "step", "sign"):
        table.add_column(head, overflow="fold")
    for row in one.channels:
        cells = (row.channel, row.column, row.unit, row.span, row.step, row.remark)
        table.add_row(*(Text(printable(cell)) for cell in cells))
    console.print(table)
    for name, text in one.facts:
        console.print(f"{name + ':':<11}{printable(text)}", soft_wrap=True)
    for name, texts in (
        ("says", one.recording.provenance),
        ("note", tuple(note for note in one.recording.notes if not note.startswith("doubtful: "))),
        ("DOUBTFUL", one.recording.doubts),
    ):
        for text in texts:
            console.print(f"{name + ':':<11}{printable(text)}", soft_wrap=True)
    console.print(terminal_picture(one.recording), soft_wrap=True)


def _draw(found: list[Inspection], picture: Path) -> None:
    from ..report.recording_picture import draw_recordings

    try:
        picture.parent.mkdir(parents=True, exist_ok=True)
        draw_recordings([one.recording for one in found], picture)
    except OSError as error:
        raise TirelabError(
            f"{picture} cannot be written ({error.strerror}); name another with --picture"
        ) from None
