"""`python -m concealed --seed S --trials N --out DIR`: write blind trials and their sealed answers."""

from pathlib import Path

import click
import numpy as np

from concealed import KINDS, draw, write, write_answer, write_believed


def trial_seed(seed: int, number: int) -> int:
    """Seed of one trial of a series."""
    return int(np.random.SeedSequence([seed, number]).generate_state(1)[0])


@click.command()
@click.option("--seed", type=click.IntRange(min=0), required=True, help="Seed of the whole series.")
@click.option("--trials", type=click.IntRange(min=1), required=True, help="How many trials to write.")
@click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), required=True, help="Folder to write to."
)
@click.option("--kind", type=click.Choice(list(KINDS)), help="Write trials of this kind only.")
def main(seed: int, trials: int, out: Path, kind: str | None) -> None:
    """Write trial_0000/ ... with recordings alone, believed/ with the tires that are believed in, and
    sealed/.

    The SHA-256 of every sealed answer is printed, so that nobody can change one afterwards.
    """
    for number in range(trials):
        trial = draw(trial_seed(seed, number), kind=kind)
        name = f"trial_{number:04d}"
        write(trial, out / name)
        write_believed(trial, out / "believed" / f"{name}.json")
        seal = write_answer(trial, out / "sealed" / f"{name}.json")
        click.echo(f"{name}  {seal}")


if __name__ == "__main__":
    main()
