"""`python -m concealed --seed S --trials N --out DIR`: write blind trials and their answers."""

from pathlib import Path

import click
import numpy as np

from . import KINDS, WIDE_KINDS, draw, write, write_answer, write_baseline


def trial_seed(seed: int, number: int) -> int:
    """Return the seed of one trial, from the seed of all of them and its number."""
    return int(np.random.SeedSequence([seed, number]).generate_state(1)[0])


@click.command()
@click.option("--seed", type=click.IntRange(min=0), required=True, help="Seed of all trials.")
@click.option("--trials", type=click.IntRange(min=1), required=True, help="How many trials to write.")
@click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), required=True, help="Folder to write to."
)
@click.option("--kind", type=click.Choice([*KINDS, *WIDE_KINDS]), help="Write trials of this kind only.")
def main(seed: int, trials: int, out: Path, kind: str | None) -> None:
    """Write trial_0000/ ... with the recordings alone, baseline/ with the baseline tires, and sealed/ with the
    answers.

    The SHA-256 of every answer is printed as its commitment hash: an answer that is changed later no longer fits.
    """
    for number in range(trials):
        trial = draw(trial_seed(seed, number), kind=kind)
        name = f"trial_{number:04d}"
        write(trial, out / name)
        write_baseline(trial, out / "baseline" / f"{name}.json")
        commitment = write_answer(trial, out / "sealed" / f"{name}.json")
        click.echo(f"{name}  {commitment}")


if __name__ == "__main__":
    main()
