"""The program `tirelab`: each command is a module here, loaded when it is used."""

from __future__ import annotations

import os
import sys
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path

import click

# matplotlib keeps its font cache in the user's home by default
if sys.prefix != sys.base_prefix:
    os.environ.setdefault("MPLCONFIGDIR", str(Path(sys.prefix) / "var" / "matplotlib"))

COMMANDS = {
    "open": "Open a page on this machine: drop recordings, diagnose, take the tire.",
    "plan": "Choose what to record, within a rig's limits.",
    "inspect": "Show what is understood of recordings, and keep it in recording.toml.",
    "identify": "Identify a tire from recordings of it.",
    "build": "Pack a tire as an FMU and validate it.",
    "compare": "Replay a tire's FMU on a recording.",
    "diagnose": "Name the physics that a tire lacks, and correct it.",
    "ride": "Ride over terrain: deflection and force at every position.",
    "rig": "Write the recordings that the article's rig would have made.",
    "article": "Compute the article's claims and figures again.",
    "prove": "Put the diagnosis to blind trials.",
}
"""The commands in the order of the work, each a module of this package, with what the list says of them."""

EPILOG = """\b
Exit status: 0 done, 1 interrupted (Ctrl-C), 2 bad input, said in one sentence.
Completion of commands and options in the shell:
  bash: eval "$(_TIRELAB_COMPLETE=bash_source tirelab)"    in ~/.bashrc
  zsh:  eval "$(_TIRELAB_COMPLETE=zsh_source tirelab)"     in ~/.zshrc
  fish: _TIRELAB_COMPLETE=fish_source tirelab | source     in config.fish
"""
"""What every user of a command line may ask, at the end of the list of commands."""


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

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command that was typed; of one that is not there say which are spelled alike."""
        if args and args[0] not in COMMANDS and (alike := get_close_matches(args[0], COMMANDS, n=1)):
            ctx.fail(f"No such command {args[0]!r}. (Did you mean {alike[0]!r}?)")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=LazyCommands, context_settings={"help_option_names": ["-h", "--help"]}, epilog=EPILOG)
@click.version_option(package_name="tirelab")
def main() -> None:
    """Off-road bicycle tires: from recordings to a tire, an FMU, and the physics that a simulation left out."""
