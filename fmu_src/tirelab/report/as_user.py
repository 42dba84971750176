"""The command `tirelab diagnose` as a user calls it, inside of this process."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Sequence
from pathlib import Path

import click

from ..errors import TirelabError

Diagnoser = Callable[[Sequence[Path], "Path | None", Path], None]
"""Diagnoses recordings with a believed tire's file (None: the article's) and writes a folder."""


def diagnose_as_user(
    recordings: Sequence[Path], tire: Path | None, out: Path, options: Sequence[str] = ()
) -> None:
    """Run `tirelab diagnose RECORDING... [--tire T] --out DIR` with further `options`; what it prints is dropped.

    Raises TirelabError with the sentence of the command where it ends with another exit status than 0.
    """
    from ..cli import main  # here, since the program's commands import this module

    arguments = ["diagnose", *map(str, recordings), "--out", str(out), *options]
    if tire is not None:
        arguments += ["--tire", str(tire)]
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as told:
        try:
            status = main.main(arguments, prog_name="tirelab", standalone_mode=False)
        except click.ClickException as error:
            raise TirelabError(error.format_message()) from None
        except SystemExit as leaving:
            status = leaving.code
    if isinstance(status, int) and status != 0:
        raise TirelabError(f"ended with the exit status {status}: {told.getvalue().strip()[-500:]}")
