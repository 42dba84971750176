"""Measure how far the catalogue's forms are from another formulation of the same physics.

Run: python -m tirelab.validation.form_errors --seed SEED --draws N

The independent rig hides one effect alone, 30 to 1000 times the noise, its parameters drawn over their ranges; the
catalogue's form is fitted to it. Its form error is the root mean square of what it leaves beyond what the true tire
leaves on the same readings, over the size of the effect:

    f = root mean square over draws of sqrt((left^2 - floor^2) / (before^2 - floor^2)),

0.001 at least, to which a calibrated force repeats (ISO 376, class 0.5). A draw counts where its readings show the
motion: where a corner or the gauge hides rate or acceleration, the true tire itself leaves more than the noise.
`Effect.form_error` states it, rounded to two digits.

The rig has no parts. The refitted law of a part is fitted to closed forms of elastic laws (`concealed.part_laws`),
where the believed one is a straight line of a stiffness up to a fifth off.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import numpy as np
from concealed.part_laws import drawn_part_law
from radialtire import PowerLaw, TireModel, read_tire

from ..computing.workers import Cores, Done, work
from ..diagnosis.held_out import noise_free_residual
from ..estimation.explanation import explain_misfit
from ..names import REFITTED_LAW
from ..preprocessing.motion import motion_of
from ..recordings.recording import Recording, read_recording
from ..regressors.signature import CURVE
from .commitment import draw_and_commit
from .folders import Folders, read_json

REPEATS = 0.001
"""Part of a force to which its reading repeats."""

LOUD, COUNT = (30.0, 1000.0), 4000
"""Sizes over the noise of what a part's law is off, and the number of its samples."""

HIDDEN = 2.0
"""A motion is hidden where the true tire leaves this much more power on the readings than on the motion itself."""


def form_error_of(folder: Path, seed: int, number: int, only: str | None, kind: str) -> dict[str, Any]:
    """Return the name of the one effect of a draw of a kind and its form error; nothing where there are several, or
    another than the one that is wanted, or its motion is hidden.
    """
    folders = Folders(folder / str(number))
    (key,) = (k for k in draw_and_commit(folders, seed, number, kind) if not k.endswith(".derived"))
    answer = read_json(folders.sealed(key))
    (name, *more) = answer["right"][0]
    if more or len(answer["right"]) > 1 or name != (only or name):
        return {}
    recordings = [read_recording(path) for path in folders.recordings(key, "train")]
    found = explain_misfit(recordings, read_tire(folders.tire(key)), [name], lambda stage: None).of([name])
    files = [answer["files"][f"{r.name}.csv"] for r in recordings]
    samples = np.array([f["samples"] for f in files])
    left, read_floor, before, floor = (
        float(samples @ np.square(errors))
        for errors in (
            [_left(found.model.tire, recording) for recording in recordings],
            *([f[key] for f in files] for key in ("read_floor_rmse", "baseline_rmse", "floor_rmse")),
        )
    )
    if read_floor > HIDDEN * floor:
        return {}
    return {"name": name, "error": float(np.sqrt(max(left - read_floor, 0.0) / (before - floor)))}


def form_error_of_part(seed: int, number: int) -> dict[str, Any]:
    """Return the name of the effect that holds a part's refitted law, and its form error on one law."""
    rng = np.random.default_rng([seed, number])
    law, loudness = drawn_part_law(rng), float(np.exp(rng.uniform(*np.log(LOUD))))
    time = np.arange(COUNT) / 200.0
    over_stroke = np.where(
        time < 10.0, np.sin(2.0 * np.pi * 0.3 * time), 1.0 - 2.0 * np.abs(1.0 - (0.6 * time + 0.5) % 2.0)
    )
    force = 1000.0 * law(over_stroke)
    stiffness, preload = np.polyfit(over_stroke, force, 1)
    believed = stiffness * float(np.exp(rng.uniform(-0.2, 0.2)))
    tire = TireModel(PowerLaw(believed, 1.0), two_sided=True, preload=float(preload), inflated=False)
    before = float(np.sqrt(np.mean((force - preload - believed * over_stroke) ** 2)))
    noise = before / loudness
    noisy = force + noise * rng.standard_normal(COUNT)
    recording = Recording("part", time, 0.01 * over_stroke, np.full(COUNT, np.inf), noisy)
    found = explain_misfit([recording], tire, [REFITTED_LAW], lambda stage: None).of([REFITTED_LAW])
    left = _left(found.model.tire, replace(recording, force=force))
    return {"name": CURVE, "error": left / before}


def _left(tire: TireModel, recording: Recording) -> float:
    """Return what a tire leaves of a recording whose whole motion is known [N]: a tracker's errors are not a form's."""
    residual = noise_free_residual(tire, recording, motion_of(recording.time, recording.deflection))
    return float(np.sqrt(np.mean(residual**2)))


def form_errors_of(errors: Mapping[str, Sequence[float]]) -> dict[str, float]:
    """Return the form error of each effect, from those of its draws."""
    return {
        name: max(REPEATS, float(np.sqrt(np.mean(np.square(values)))))
        for name, values in sorted(errors.items())
    }


@click.command()
@click.option("--seed", type=int, required=True)
@click.option("--draws", type=click.IntRange(min=1), default=300, show_default=True)
@click.option("--only", help="One effect.")
@click.option(
    "--kind",
    type=click.Choice(["loud", "set", "drift"]),
    default="loud",
    show_default=True,
    help="Trials that hide it: set holds a permanent set, drift a drifting gauge.",
)
def main(seed: int, draws: int, only: str | None, kind: str) -> None:
    """Print the form error of every effect that was drawn alone, and from how many draws."""
    errors: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as name:
        found: list[Done[dict[str, Any]]] = []
        if only != CURVE:
            tasks = {str(n): (Path(name), seed, n, only, kind) for n in range(draws)}
            found += work(form_error_of, tasks, Cores(), "measuring forms")
        if only in (None, CURVE):
            parts = {str(n): (seed, n) for n in range(draws)}
            found += work(form_error_of_part, parts, Cores(), "measuring the law of parts")
    for done in found:
        if done.value is None:
            click.echo(f"draw {done.key} failed: {done.error}")
        elif done.value:
            errors.setdefault(done.value["name"], []).append(done.value["error"])
    for effect, error in form_errors_of(errors).items():
        own = np.array(errors[effect])
        title = "the refitted law" if effect == REFITTED_LAW else effect
        click.echo(f"{title:28s} {error:.4f}  (largest {own.max():.4f}, {own.size} draws)")


if __name__ == "__main__":
    main()
