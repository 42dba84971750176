"""What every command shares on its output: --out, --json and --quiet, notes and progress."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from .option_group import Decorator, option_group
from .options import FILE

CONTROLS = "[\x00-\x08\x0b-\x1f\x7f-\x9f]"
"""What would control a terminal, in a name that stands in a file of others."""


@dataclass(frozen=True)
class Output:
    """Where results go and how much is said.

    out: folder, or file, that is written; as_json: only one JSON document on standard output; quiet: no progress, no
    notes
    """

    out: Path
    as_json: bool
    quiet: bool

    def result(self, lines: Iterable[str], content: Mapping[str, Any] | str) -> None:
        """Print the result: `lines` for people, or with --json its `content` (a text is JSON already)."""
        if self.as_json:
            click.echo(
                content if isinstance(content, str) else json.dumps(content, indent=2, allow_nan=False)
            )
            return
        for line in lines:
            echo(re.sub(CONTROLS, "?", line))

    def note(self, text: str) -> None:
        """Print a note: before the result, or on standard error where that is JSON."""
        if not self.quiet:
            echo(f"note: {printable(text)}", err=self.as_json)

    def stage(self, text: str) -> None:
        """Print one line for a stage on standard error."""
        if not self.quiet:
            click.echo(printable(text), err=True)


def output_options(
    default: str | None, what: str = "Folder for what is written.", metavar: str = "DIR"
) -> Decorator:
    """Add --out, --json and --quiet; the command gets them as `output`. default: of --out, None: it must be given."""
    given: dict[str, Any] = (
        {"required": True} if default is None else {"default": Path(default), "show_default": True}
    )
    return option_group(
        "output",
        Output,
        click.option("--out", type=FILE, metavar=metavar, help=what, **given),
        click.option("--json", "as_json", is_flag=True, help="Print only one JSON document."),
        click.option("--quiet", is_flag=True, help="Show no progress and no notes."),
    )


def example(*lines: str) -> str:
    """Return the end of a command's help: `lines` as they are typed."""
    return "\n".join(["\b", "Example:", *(f"  {line}" for line in lines)])


@contextmanager
def progress(quiet: bool, shares: Mapping[str, float] | None = None) -> Iterator[Callable[[str], None]]:
    """Give a function that shows a stage on standard error: a bar with the time left in a terminal, else a line each.

    shares: beginning of a stage's sentence -> part of the whole time that is spent when it begins, 0 to 1; without, the
    bar has no end
    """
    from rich.console import Console

    console = Console(stderr=True)
    if quiet:
        yield lambda sentence: None
    elif not console.is_terminal:
        yield lambda sentence: click.echo(printable(sentence), err=True)
    else:
        from .progress_bar import live

        with live(console, shares or {}) as show:
            yield lambda sentence: show(printable(sentence))


def echo(line: str, err: bool = False) -> None:
    """Print a line, with a question mark for each letter that the encoding of the output lacks."""
    stream = sys.stderr if err else sys.stdout
    encoding = getattr(stream, "encoding", None) or "utf-8"
    click.echo(line.encode(encoding, errors="replace").decode(encoding), err=err)


def printable(text: str) -> str:
    """Return `text` with a question mark for every character that could control a terminal."""
    # as report.terminal, whose libraries take long to import
    return "".join(c if c.isprintable() else "?" for c in text)
