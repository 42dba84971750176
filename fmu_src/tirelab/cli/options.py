"""What the commands share: options, and bad input reported in one sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import Any

import click
from radialtire import InputError, ParameterError, TireFileError

from ..errors import TirelabError
from ..recordings.reading import Reading

FILE = click.Path(path_type=Path)


class Refusal(click.ClickException):
    """Bad input reported in one sentence: exit status 2, no traceback. Ctrl-C ends a command with status 1."""

    exit_code = 2


def check_files(given: Iterable[Path]) -> None:
    """Raise TirelabError where a file or folder is not there: before anything is loaded that could read it."""
    for path in given:
        if not path.exists():
            raise TirelabError(f"{path}: there is no such file; check the path")


class SentenceCommand(click.Command):
    """A command that ends on bad input with its sentence."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except (TirelabError, TireFileError, ParameterError, InputError) as error:
            raise Refusal(str(error)) from None


def reading_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that say how a recording is to be read; the command gets them as `reading`."""

    @click.option(
        "--columns", metavar="NAME=COLUMN,...", help="Which of the file's columns is which quantity."
    )
    @click.option("--units", metavar="NAME=UNIT,...", help="Units of quantities, over what the file says.")
    @click.option(
        "--radius", metavar="R", help="Surface of a recording without a radius column: flat, 25.4cm, ..."
    )
    @wraps(command)
    def with_reading(
        *args: Any, columns: str | None, units: str | None, radius: str | None, **options: Any
    ) -> Any:
        how = Reading(radius=radius)
        if columns or units:
            from ..recordings.channels import parse_columns, parse_units

            how = Reading(parse_columns(columns or ""), parse_units(units or ""), radius)
        return command(*args, reading=how, **options)

    return with_reading
