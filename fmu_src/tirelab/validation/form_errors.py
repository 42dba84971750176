"""Measure how far the catalogue's forms are from another formulation of the same physics.

Run: python -m tirelab.validation.form_errors --seed SEED --draws N

The independent rig hides one effect alone, 30 to 1000 times the noise, its parameters drawn over their ranges; the
catalogue's form is fitted to it. Its form error is the root mean square of what it leaves beyond the noise, over the
size of the effect:

    f = sqrt(mean over draws of (left^2 - 1) / size^2),   in units of the noise

The root mean square over all draws of an effect is what `Effect.form_error` states, rounded up to two digits.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np
from radialtire import read_tire

from ..computing.workers import Cores, work
from ..estimation.explanation import explain_misfit
from ..names import REFITTED_LAW
from ..recordings.recording import read_recording
from .commitment import draw_and_commit
from .folders import Folders, read_json


def form_error_of(folder: Path, seed: int, number: int) -> dict[str, Any]:
    """Return the name of the one effect of a loud draw, and its squared form error; nothing where there are several."""
    folders = Folders(folder / str(number))
    (key,) = (k for k in draw_and_commit(folders, seed, number, "loud") if not k.endswith(".derived"))
    answer = read_json(folders.sealed(key))
    (name, *more) = answer["right"][0]
    if more or len(answer["right"]) > 1:
        return {}
    recordings = [read_recording(path) for path in folders.recordings(key, "train")]
    found = explain_misfit(recordings, read_tire(folders.tire(key)), [name], lambda stage: None).of([name])
    fit = found.model.fit
    beyond = max(fit.power / fit.residual.size - 1.0, 0.0)
    return {"name": name, "square": beyond / fit.sizes[name] ** 2}


def form_errors_of(squares: Mapping[str, Sequence[float]]) -> dict[str, float]:
    """Return the root mean square of each effect."""
    return {name: float(np.sqrt(np.mean(values))) for name, values in sorted(squares.items())}


@click.command()
@click.option("--seed", type=int, required=True)
@click.option("--draws", type=click.IntRange(min=1), default=300, show_default=True)
def main(seed: int, draws: int) -> None:
    """Print the form error of every effect that was drawn alone, and from how many draws."""
    squares: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as name:
        tasks = {str(n): (Path(name), seed, n) for n in range(draws)}
        for done in work(form_error_of, tasks, Cores(), "measuring forms"):
            if done.value is None:
                click.echo(f"draw {done.key} failed: {done.error}")
            elif done.value:
                squares.setdefault(done.value["name"], []).append(done.value["square"])
    for effect, error in form_errors_of(squares).items():
        own = np.sqrt(squares[effect])
        title = "the refitted law" if effect == REFITTED_LAW else effect
        click.echo(f"{title:28s} {error:.4f}  (largest {own.max():.4f}, {own.size} draws)")


if __name__ == "__main__":
    main()
