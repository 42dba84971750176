"""What the commands share: options, and failures told in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar

import click
from radialtire import InputError, ParameterError, TireFileError

from ..errors import TirelabError
from ..recordings.channels import parse_columns, parse_units
from ..recordings.recording import Recording, read_recording

Command = TypeVar("Command", bound=Callable[..., Any])

FILE = click.Path(path_type=Path)


class Told(click.ClickException):
    """A failure told in one sentence: exit status 2, no traceback."""

    exit_code = 2


class SentenceCommand(click.Command):
    """A command that ends on bad input with its sentence."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except (TirelabError, TireFileError, ParameterError, InputError) as error:
            raise Told(str(error)) from None


@dataclass(frozen=True)
class Reading:
    """How the user wants recordings read: the texts of --columns, --units and --radius."""

    columns: str | None
    units: str | None
    radius: str | None

    def __call__(self, file: Path) -> Recording:
        """Read one recording."""
        return read_recording(
            file,
            columns=parse_columns(self.columns) if self.columns else None,
            units=parse_units(self.units) if self.units else None,
            radius=self.radius,
        )

    def words(self) -> list[str]:
        """Return the options again as words of the command line."""
        told = (("--columns", self.columns), ("--units", self.units), ("--radius", self.radius))
        return [word for option, text in told if text is not None for word in (option, text)]


def reading(command: Callable[..., Any]) -> Callable[..., Any]:
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
        return command(*args, reading=Reading(columns, units, radius), **options)

    return with_reading


def out(default: str) -> Callable[[Command], Command]:
    """Add the option --out DIR."""
    return click.option(
        "--out",
        type=FILE,
        default=Path(default),
        show_default=True,
        metavar="DIR",
        help="Folder for what is written.",
    )
