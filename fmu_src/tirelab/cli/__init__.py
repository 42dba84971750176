"""The program `tirelab`: each command is a module of `commands`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

# matplotlib keeps its font cache in the user's home if it is not told otherwise
if sys.prefix != sys.base_prefix:
    os.environ.setdefault("MPLCONFIGDIR", str(Path(sys.prefix) / "var" / "matplotlib"))

from . import article, build, compare, diagnose, identify, prove, ride, rig


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="tirelab")
def main() -> None:
    """Off-road bicycle tires: from recordings to a tire, an FMU, and the physics that a simulation left out."""


for module in (diagnose, compare, identify, rig, article, build, ride, prove):
    main.add_command(module.command)
