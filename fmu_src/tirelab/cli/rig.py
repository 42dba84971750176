"""tirelab rig: the recordings that the article's rig would have made."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import click
from radialtire import TireModel, read_tire

from ..names import plain
from .options import FILE, SentenceCommand
from .output import Output, example, output_options

NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)")


def quantity(unit: str) -> Callable[[click.Context, click.Parameter, str], float]:
    """Return the callback that turns an option such as "10N" or "2 lbf" into a number in the SI unit `unit`."""

    def convert(context: click.Context, parameter: click.Parameter, text: str) -> float:
        import numpy as np

        from ..recordings.units import UnitError, conversion

        found = NUMBER.fullmatch(text)
        if found is None or not found[2].strip():
            raise click.BadParameter(f"{text!r} is not a number with a unit; write for instance 10{unit}")
        try:
            return float(conversion(found[2].strip(), unit).to_si(np.array([float(found[1])]))[0])
        except UnitError as error:
            raise click.BadParameter(f"{text!r}: {error}") from None

    return convert


@click.command(
    "rig", cls=SentenceCommand, epilog=example("tirelab rig --noise 10N --seed 1 --out recordings")
)
@output_options("recordings")
@click.option("--tire", type=FILE, help="The tire file.  [default: the article's tire]")
@click.option(
    "--noise",
    default="0N",
    callback=quantity("N"),
    metavar="FORCE",
    help="Standard deviation of the force's noise: 10N.",
)
@click.option(
    "--correlation",
    default="0s",
    callback=quantity("s"),
    metavar="TIME",
    help="Time over which the noise fades to 1/e: 0.5s.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="Seed of the noise.")
@click.option(
    "--cycles", type=click.IntRange(1, 1000), default=1, show_default=True, help="Triangles of 30 s."
)
def command(
    output: Output, tire: Path | None, noise: float, correlation: float, seed: int, cycles: int
) -> None:
    """Write the recordings that the rig of Hull, Wang & Moore (1996) would have made of a tire, as CSV.

    Ten convex surfaces, a flat one, three concave ones; a triangle wave of 30 s sampled at 5 Hz; force below 2240 N.
    """
    from ..article.press import ForceNoise, record_all
    from ..computing.staging import staged
    from ..recordings.writing import write_recording

    model = TireModel() if tire is None else read_tire(tire)
    recordings = record_all(model, cycles=cycles, noise=ForceNoise(noise, correlation, (seed,)))
    with staged(output.out) as folder:
        for recording in recordings:
            write_recording(recording, folder / f"{recording.name}.csv")
    made = [
        {
            "file": str(output.out / f"{recording.name}.csv"),
            "samples": int(recording.time.size),
            "deflection_max": float(recording.deflection.max()),
            "force_max": float(recording.force.max()),
        }
        for recording in recordings
    ]
    lines = [
        f"{output.out / recording.name}.csv: to {plain(100.0 * recording.deflection.max(), 4)} cm and "
        f"{recording.force.max():.0f} N, {recording.time.size} samples"
        for recording in recordings
    ]
    lines.append(
        f"computed from {model.name or 'a tire'}; these are the law's numbers, not the authors' measurements"
    )
    output.result(lines, {"tire": model.name, "recordings": made})
