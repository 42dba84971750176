"""The program `tirelab`: each command is a module here, loaded when it is used."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from pathlib import Path

import click

# matplotlib keeps its font cache in the user's home by default
if sys.prefix != sys.base_prefix:
    os.environ.setdefault("MPLCONFIGDIR", str(Path(sys.prefix) / "var" / "matplotlib"))

COMMANDS = {
    "article": "Compute the article's claims and figures again.",
    "build": "Pack a tire as an FMU and validate it.",
    "compare": "Replay a tire's FMU on a recording.",
    "diagnose": "Name the physics that a tire lacks, and correct it.",
    "identify": "Identify a tire from recordings of it.",
    "inspect": "Show what is understood of recordings, and keep it in recording.toml.",
    "prove": "Put the diagnosis to blind trials.",
    "ride": "Ride over terrain: deflection and force at every position.",
    "rig": "Write the recordings that the article's rig would have made.",
}
"""The commands, each a module of this package, with what the list of commands says of them."""


class LazyCommands(click.Group):
    """A group that loads a command's module when the command is used, and none to list them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of that name, or None where there is none."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f".{cmd_name}", __name__).command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=LazyCommands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="tirelab")
def main() -> None:
    """Off-road bicycle tires: from recordings to a tire, an FMU, and the physics that a simulation left out."""
