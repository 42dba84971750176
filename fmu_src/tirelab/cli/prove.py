"""tirelab prove: blind trials of the diagnosis on recordings of an independent rig."""

from __future__ import annotations

import click

from .options import SentenceCommand
from .output import Output, example, output_options

TABLE_WIDTH = 110
"""Width of the table [characters] where the output is no terminal."""


@click.command(
    "prove", cls=SentenceCommand, epilog=example("tirelab prove --trials 40 --seed 20260101 --out proof")
)
@click.option("--trials", type=click.IntRange(min=1), default=200, show_default=True, help="How many trials.")
@click.option("--seed", type=click.IntRange(min=0), required=True, help="Seed of all trials.")
@output_options(None, "Folder for the proof; an interrupted proof is continued.")
@click.option("--jobs", type=int, help="Processes to work in.  [default: one per core]")
@click.option(
    "--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster to work on, such as tcp://host:8786."
)
@click.option(
    "--kind",
    type=click.Choice(
        [
            *("none", "single", "masked", "pair", "triple", "open"),
            *("loud", "press", "foreign", "outside", "beside", "pressure", "set", "drift", "all"),
        ]
    ),
    help="Draw only one kind of trial: nothing hidden, one effect, one effect on another tire, two effects, three, or "
    "an effect outside the catalogue. Worlds wider than the catalogue, drawn on request only: effects 30 to 1000 times "
    "the noise (loud), an engineer's first file (press), known physics in forms that the catalogue lacks (foreign), "
    "other physics (outside), a known effect beside other physics (beside), two or three measured pressures "
    "(pressure). all: the wide kinds but pressure and the drawn kinds in turn.  [default: drawn from none to open]",
)
def command(
    trials: int, seed: int, output: Output, jobs: int | None, dask: str | None, kind: str | None
) -> None:
    """Test the diagnosis by blind trials, and write proof.json and proof.html.

    An independent rig hides effects in recordings and writes the answers. The SHA-256 of every answer is printed
    before the first diagnosis. Each trial is diagnosed from its recordings and the baseline tire alone. Then the
    answers are opened, their SHA-256 are checked, and the verdicts are scored.
    """
    from rich.console import Console

    from ..computing.workers import Cores
    from ..validation import BlindTrials, Folders, prove  # here: the rig is imported for this command only
    from ..validation.page import numbers
    from ..validation.terminal import criteria_table, lines

    def show(line: str) -> None:
        if not output.quiet:
            click.echo(line, err=output.as_json)

    proof = prove(BlindTrials(Folders(output.out), seed, trials, kind), Cores(jobs, dask, output.quiet), show)
    if output.as_json:
        output.result((), numbers(proof))
        return
    console = Console()
    if not console.is_terminal:
        console.width = TABLE_WIDTH
    console.print(criteria_table(proof))
    for line in lines(proof):
        click.echo(line)
    for score in proof.failures:
        click.echo(f"trial {score.trial} failed: {score.error}")
    click.echo(f"proof: {output.out / 'proof.html'}")
