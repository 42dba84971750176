"""tirelab inspect: what is understood of recordings, and the file of settings that keeps it."""

from __future__ import annotations

import io
import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, check_files, reading_options, whole_command
from .output import Output, echo, example, output_options

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rich.console import Console

    from ..recordings.inspection import Inspection

SETTINGS = "recording.toml"

COLUMNS = 110
"""Width of the tables where the output is no terminal."""


@click.command(
    "inspect",
    cls=SentenceCommand,
    epilog=example("tirelab inspect press/*.csv --radius flat --picture press.png"),
)
@click.argument("recordings", metavar="FILE...", nargs=-1, required=True, type=FILE)
@output_options(SETTINGS, "File of settings written; unless given, one beside each recording.", "FILE")
@click.option("--part", is_flag=True, help="Of a damper, a bushing, a spring: no surface is asked for.")
@click.option("--picture", type=FILE, metavar="PNG", help="Draw the recordings into this picture too.")
@reading_options
def command(
    recordings: tuple[Path, ...], output: Output, picture: Path | None, reading: Reading, part: bool
) -> None:
    """Show what is understood of each FILE (or folder of them), and write it into recording.toml, which all
    commands then use."""
    check_files(recordings)
    from ..recordings.files import recording_files
    from ..recordings.inspection import inspect_recording

    reading = reading.of_part() if part else reading
    console = _console()
    files, skipped = recording_files(recordings, reading.columns)
    for other in skipped:
        output.note(str(other))
    found: list[Inspection] = []
    refused: dict[Path, TirelabError] = {}
    for file in files:
        output.stage(f"reading {file.name}")
        try:
            found.append(inspect_recording(file, reading))
        except TirelabError as error:
            if not output.as_json:
                _show_assumed(console, file, reading, error)
                _flush(console)
            if len(files) == 1:
                raise
            refused[file] = error
            continue
        if not output.as_json:
            _show(console, found[-1])
            _flush(console)
    written, doubts = _write(found, _given(output))
    for doubt in doubts:
        output.note(f"DOUBTFUL: {doubt}")
    if picture is not None and found:
        _draw(found, picture)
    lines = [
        f"settings: {target}{' (what else it says stays)' if old else ''}" for target, old in written.items()
    ]
    lines += [f"picture: {picture}"] if picture is not None and found else []
    content = {
        "recordings": [one.to_dict() for one in found],
        "settings": [str(target) for target in written],
        "picture": str(picture) if picture is not None and found else None,
        "refused": len(refused),
    }
    output.result(lines, content)
    if refused:
        said = _refusals(refused, len(files), recordings)
        raise TirelabError("\n".join([f"{len(refused)} of {len(files)} files cannot be read:", *said]))


def _given(output: Output) -> Path | None:
    """Return the file of settings that the user named, None where each stands beside its recording."""
    source = click.get_current_context().get_parameter_source("out")
    return None if source is ParameterSource.DEFAULT else output.out


def _write(found: list[Inspection], out: Path | None) -> tuple[dict[Path, bool], list[str]]:
    """Write the settings, each file whole; return each that was written, whether it was there before, and doubts."""
    from ..computing.staging import staged
    from ..recordings.settings_file import opposite_signs, settings_text

    by_file: dict[Path, dict[str, Inspection]] = {}
    for one in found:
        by_file.setdefault(out or one.path.with_name(SETTINGS), {})[one.key] = one
    written, doubts = {}, []
    for target, ones in by_file.items():
        written[target] = target.exists()
        text = settings_text(target, {key: one.settings for key, one in ones.items()})
        with staged(target.parent) as folder:
            (folder / target.name).write_text(text, encoding="utf-8")
        doubts += [f"{target}, {doubt}" for doubt in opposite_signs(text)]
    return written, doubts


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
            echo(line.rstrip())
        console.file = io.StringIO()


def _show_assumed(console: Console, file: Path, reading: Reading, error: TirelabError) -> None:
    """Show what is understood of a file where all that it lacks can be guessed; nothing of that is written."""
    from ..recordings.asking import IncompleteRecording
    from ..recordings.inspection import inspect_recording

    if not isinstance(error, IncompleteRecording):
        return
    guessed = error.settings
    radius = reading.radius if guessed.radius is None else guessed.radius
    choices = replace(reading, columns=guessed.columns, units=guessed.units, radius=radius, zero=guessed.zero)
    try:
        found = inspect_recording(file, choices)
    except TirelabError:
        return
    console.print(f"ASSUMED, and not written: {shlex.join(error.words())}", soft_wrap=True)
    _show(console, found, assumed=True)


def _refusals(refused: Mapping[Path, TirelabError], files: int, given: Sequence[Path]) -> list[str]:
    """Return why files cannot be read, each reason once, and one command for those that lack the same options."""
    alike: dict[tuple[str, ...], list[Path]] = {}
    for file, error in refused.items():
        words = getattr(error, "words", None)
        alike.setdefault(tuple(words()) if words else (), []).append(file)
    said: list[str] = []
    for added, ones in alike.items():
        said += dict.fromkeys(f"- {refused[one]}" for one in ones)
        if added:
            of = ones if len(ones) < files else []
            said.append(f"  {whole_command(click.get_current_context(), added, of, given)}")
    return said


def _show(console: Console, one: Inspection, *, assumed: bool = False) -> None:
    """Print one recording; assumed: whether what no column holds is a guess and not given."""
    from rich.table import Table
    from rich.text import Text

    from ..recordings.inspection import GIVEN
    from ..report.recording_picture import terminal_picture
    from ..report.terminal import printable

    table = Table(title=printable(one.recording.name), title_justify="left", box=None, pad_edge=False)
    heads = ["channel", "column", "read in", "values", "step", "sign"]
    with_zero = any(row.zero for row in one.channels)
    for head in [*heads, "zero"] if with_zero else heads:
        table.add_column(head, overflow="fold")
    for row in one.channels:
        column = "assumed" if assumed and row.column == GIVEN else row.column
        cells = [row.channel, column, row.unit, row.span, row.step, row.remark]
        cells += [row.zero] if with_zero else []
        table.add_row(*(Text(printable(cell)) for cell in cells))
    console.print(table)
    for name, text in one.facts:
        console.print(f"{name + ':':<11}{printable(text)}", soft_wrap=True)
    for name, texts in (
        ("says", one.recording.provenance),
        ("note", [note.replace(" as given", " as assumed") if assumed else note for note in one.remarks]),
        ("DOUBTFUL", one.recording.doubts),
    ):
        for text in texts:
            console.print(f"{name + ':':<11}{printable(text)}", soft_wrap=True)
    console.print(terminal_picture(one.recording), soft_wrap=True)


def _draw(found: list[Inspection], picture: Path) -> None:
    from ..computing.staging import staged
    from ..report.recording_picture import draw_recordings

    with staged(picture.parent) as folder:
        draw_recordings([one.recording for one in found], folder / picture.name)
