"""tirelab prove: blind trials on recordings that never existed before."""

from __future__ import annotations

from pathlib import Path

import click
from rich.console import Console

from ..batch.workers import Cores
from .options import FILE, SentenceCommand

WIDTH = 110
"""Columns of the table where it does not go to a terminal."""


@click.command("prove", cls=SentenceCommand)
@click.option("--trials", type=click.IntRange(min=1), default=200, show_default=True, help="How many trials.")
@click.option("--seed", type=click.IntRange(min=0), required=True, help="Seed of the whole series.")
@click.option(
    "--out", type=FILE, required=True, metavar="DIR", help="Folder for the proof; started again, it goes on."
)
@click.option("--jobs", type=int, help="Processes to work in.  [default: one per core]")
@click.option(
    "--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster to work on, such as tcp://host:8786."
)
@click.option(
    "--kind",
    type=click.Choice(["none", "single", "masked", "pair", "triple", "open"]),
    help="Hide only this: nothing, one effect, one under another tire's coefficients, two, three, or what no catalogue "
    "names.  [default: all of them]",
)
def command(trials: int, seed: int, out: Path, jobs: int | None, dask: str | None, kind: str | None) -> None:
    """Prove the diagnosis by blind trials, and write proof.json and proof.html.

    A rig that shares nothing with the tool hides effects in recordings and seals the answers; their SHA-256 are
    printed first. Each trial is diagnosed as a user would, from the recordings alone. Then the seals are opened and
    the verdicts scored.
    """
    from ..validation import Folders, Series, prove  # here, since the rig is loaded for a proof only
    from ..validation.terminal import bar_table

    proof = prove(Series(Folders(out), seed, trials, kind), Cores(jobs, dask), click.echo)
    console = Console()
    if not console.is_terminal:
        console.width = WIDTH
    console.print(bar_table(proof))
    for score in proof.failures:
        click.echo(f"trial {score.trial} failed: {score.error}")
    click.echo(f"proof: {out / 'proof.html'}")
