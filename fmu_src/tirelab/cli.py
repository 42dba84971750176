"""The program `tirelab`: each command is a module of `commands`."""

from __future__ import annotations

import click

from .commands import build, compare


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="tirelab")
def main() -> None:
    """Off-road bicycle tires: from recordings to a tire, an FMU, and the physics that a simulation left out."""


for module in (build, compare):
    main.add_command(module.command)
