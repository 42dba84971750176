"""What the commands share: options, and bad input reported in one sentence."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from radialtire import InputError, ParameterError, TireFileError

from ..errors import TirelabError
from ..recordings.reading import Reading

if TYPE_CHECKING:
    from ..fmu.foreign import Simulation

FILE = click.Path(path_type=Path)

WORDS = "tirelab.words"
"""The key of a context's meta under which the words of its command line are kept."""


class Refusal(click.ClickException):
    """Bad input reported in one sentence: exit status 2, no traceback. Ctrl-C ends a command with status 1."""

    exit_code = 2


UNKNOWN = "=NAME"
"""What stands in advice where no column is likely."""


def check_files(given: Iterable[Path]) -> None:
    """Raise TirelabError where a file or folder is not there: before anything is loaded that could read it."""
    for path in given:
        if path.exists():
            continue
        name = path.name.partition("@")[0]  # of press.csv@10s:20s
        if not name or not path.with_name(name).exists():
            raise TirelabError(f"{path}: there is no such file; check the path")


class SentenceCommand(click.Command):
    """A command that ends on bad input with its sentence."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Keep the words of the command line, so that advice can repeat them."""
        ctx.meta[WORDS] = tuple(args)
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except (TirelabError, TireFileError, ParameterError, InputError) as error:
            raise Refusal(_sentence(ctx, error)) from None


def _sentence(ctx: click.Context, error: Exception) -> str:
    """Return the sentence of an error; where options are lacking, with the whole command that has them."""
    words = getattr(error, "words", None)
    if words is None:
        return str(error)
    command = whole_command(ctx, words())
    to_do = "NAME to replace and guesses to check" if UNKNOWN in command else "guesses to check"
    return f"{error}\nThe whole command, with {to_do}: {command}"


def whole_command(
    ctx: click.Context, added: Sequence[str], of: Sequence[Path] = (), given: Sequence[Path] = ()
) -> str:
    """Return the command line as it was given, with options added or replaced.

    of: the files it is to read, in place of all that were `given`; none: it reads the same ones
    """
    names = {str(path) for path in given} if of else set()
    kept = [word for word in _without(ctx.meta[WORDS], added) if word not in names]
    bare = kept.index("--") if "--" in kept else len(kept)  # behind it all words are files
    kept[bare:bare] = added
    return shlex.join(["tirelab", str(ctx.info_name), *map(str, of), *kept])


def _without(given: Sequence[str], added: Sequence[str]) -> list[str]:
    """Return the words of a command line without the options that others replace."""
    options = [word for word in added if word.startswith("--")]
    kept: list[str] = []
    value = False
    for word in given:
        if value:
            value = False
        elif word in options:
            value = True
        elif not word.startswith(tuple(f"{option}=" for option in options)):
            kept.append(word)
    return kept


_READING = (
    click.option(
        "--columns", metavar="NAME=COLUMN,...", help="The column of each quantity, by name or #number."
    ),
    click.option(
        "--units", metavar="NAME=UNIT,...", help="Units of quantities, in place of those in the file."
    ),
    click.option(
        "--zero",
        multiple=True,
        metavar="NAME=VALUE",
        help="Reading of a gauge without load, which is subtracted: deflection=30mm; may be repeated.",
    ),
    click.option(
        "--radius", metavar="R", help="Surface of a recording without a radius column: flat, 25.4cm, ..."
    ),
    click.option(
        "--sampling",
        metavar="RATE",
        help="Sampling rate or interval where there is no time column: 10Hz, 0.1s.",
    ),
    click.option(
        "--skip-rows",
        type=click.IntRange(0),
        metavar="N",
        help="Rows of text above the table.  [default: found]",
    ),
    click.option(
        "--from", "start", metavar="BOUND", help="Read every file from this time (10s) or row (100) on."
    ),
    click.option(
        "--to", "stop", metavar="BOUND", help="Read up to this time (exclusive) or row (inclusive)."
    ),
    click.option(
        "--settings",
        type=FILE,
        help="Settings file, in place of the recording.toml beside each recording.",
    ),
)
_NAMES = ("columns", "units", "zero", "radius", "sampling", "skip_rows", "start", "stop", "settings")


def reading_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that say how a recording is to be read; the command gets them as `reading`."""

    @wraps(command)
    def with_reading(*args: Any, **options: Any) -> Any:
        said = {name: options.pop(name) for name in _NAMES}
        said["start"], said["stop"] = said["start"] or "", said["stop"] or ""
        if said["columns"] or said["units"]:
            from ..recordings.channels import parse_columns, parse_units

            said["columns"] = parse_columns(said["columns"] or "")
            said["units"] = parse_units(said["units"] or "")
        else:
            said["columns"], said["units"] = {}, {}
        if said["zero"]:
            from ..recordings.zero import parse_zeros

            said["zero"] = parse_zeros(said["zero"])
        else:
            said["zero"] = {}
        return command(*args, reading=Reading(**said), **options)

    with_options: Callable[..., Any] = with_reading
    for option in reversed(_READING):
        with_options = option(with_options)
    return with_options


def fmu_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command with --fmu the options of an FMU that anyone made: see `simulation_of`."""
    variables = click.option(
        "--variables",
        metavar="NAME=VARIABLE,...",
        help="Which of its variables is the deflection, the force (and the radius), with the unit where it has "
        "another.",
    )
    timeout = click.option(
        "--fmu-timeout", type=float, metavar="SECONDS", help="End the FMU after this time.  [default: 300]"
    )
    return variables(timeout(command))


def simulation_of(
    tire: Path | None, fmu: Path | None, variables: str | None, fmu_timeout: float | None
) -> Path | Simulation | None:
    """Return the tire file or the FMU that the options name; None for the article's tire.

    Raises TirelabError where they contradict each other, or the FMU does not exist.
    """
    if fmu is None:
        if variables is not None or fmu_timeout is not None:
            raise TirelabError(
                "--variables and --fmu-timeout are those of --fmu; name the FMU, or leave them out"
            )
        if tire is not None and tire.suffix == ".fmu":
            raise TirelabError(f"{tire} is an FMU and no tire file; give it with --fmu {tire}")
        return tire
    if tire is not None:
        raise TirelabError("--fmu and --tire both name a simulation; give one of them")
    check_files([fmu])
    from ..fmu.foreign import TIMEOUT, Simulation, parse_variables

    if fmu_timeout is not None and not fmu_timeout > 0.0:
        raise TirelabError(f"--fmu-timeout {fmu_timeout:g} is not allowed; give seconds, more than 0")
    return Simulation(fmu, parse_variables(variables or ""), TIMEOUT if fmu_timeout is None else fmu_timeout)
