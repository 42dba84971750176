"""How often a parameter's 95 % interval holds the value that made the recording.

Run: python -m tirelab.validation.coverage --seed SEED --draws N

Each draw has one effect of the catalogue, in turn, with parameters of its priors, 3 to 300 times the noise, on slow and
fast cycles with a hold and a repeat. Its response is changed smoothly by its declared form error, over deflection and
time, since real forms are not the catalogue's:

    F = F_0 + c (1 + f m(x, t)),   m: a random wave of mean square 1

The catalogue's form is fitted to it. Counted are parameters that the recording is said to determine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel
from scipy.stats import norm

from ..computing.workers import Cores, work
from ..estimation.explanation import explain_misfit
from ..estimation.findings import estimates_of
from ..recordings.recording import Recording
from ..regressors.dataset import arranged, dataset_of
from ..regressors.draws import quantile, strengthened
from ..regressors.signature import candidates
from ..simulation.simulate import simulate
from .metrics import Rate

FloatArray = NDArray[np.float64]

NOISE = 5.0
"""Of the force [N]; the deflection's is a micrometre."""


def driven(numbers: np.random.Generator) -> Recording:
    """Return slow cycles, fast ones, a hold and the slow ones again on the baseline tire, with the noise alone."""
    deep = numbers.uniform(0.012, 0.022)
    slow, fast = numbers.uniform(0.05, 0.2), numbers.uniform(0.8, 3.0)
    frequency = np.repeat([slow, fast, 0.0, slow], [3000, 1500, 1000, 3000])
    phase = np.cumsum(frequency) * 0.01
    x = 0.5 * deep * (1.0 - np.cos(2.0 * np.pi * phase)) + 1e-6 * numbers.normal(size=phase.size)
    time: FloatArray = np.asarray(np.arange(x.size) * 0.01, dtype=np.float64)
    silent = Recording("drawn", time, x, np.full(x.size, np.inf), np.zeros(x.size))
    force = simulate(TireModel(), silent) + NOISE * numbers.normal(size=x.size)
    return Recording("drawn", time, x, silent.surface_radius, force)


def wave(recording: Recording, numbers: np.random.Generator) -> FloatArray:
    """Return a smooth function of deflection and time, of mean square 1."""
    places = [recording.deflection / recording.deflection.max(), recording.time / recording.time[-1]]
    angles = sum(2.0 * np.pi * numbers.uniform(0.0, 1.5) * p for p in places) + numbers.uniform(
        0.0, 2.0 * np.pi
    )
    values = np.sin(angles)
    return np.asarray(values / np.sqrt(np.mean(values**2)))


def covered(seed: int, number: int) -> list[tuple[str, float]]:
    """Return of each determined parameter of one draw its name and how many standard errors it is off."""
    numbers = np.random.default_rng([seed, number])
    names = candidates()
    effect = CATALOGUE[names[number % len(names)]]
    quiet = driven(numbers)
    scales = dataset_of([quiet], TireModel()).scales
    values: Sequence[float] = [
        p.start if p.prior is None or p.optional else quantile(p, float(numbers.uniform(0.05, 0.95)), scales)
        for p in effect.parameters
    ]
    bare = simulate(TireModel(), quiet)
    wanted = NOISE * float(np.exp(numbers.uniform(np.log(3.0), np.log(300.0))))
    for _ in range(3):
        response = simulate(arranged(TireModel(), [(effect.name, tuple(values))]), quiet) - bare
        size = float(np.sqrt(np.mean(response**2)))
        if size > 0.0:
            values = strengthened(effect, values, min(wanted, 0.3 * float(np.std(bare))) / size)
    response = simulate(arranged(TireModel(), [(effect.name, tuple(values))]), quiet) - bare
    if np.sqrt(np.mean(response**2)) < NOISE:
        return []  # nothing of it shows on this drive
    force = quiet.force + response * (1.0 + effect.form_error * wave(quiet, numbers))
    recording = Recording(quiet.name, quiet.time, quiet.deflection, quiet.surface_radius, force)
    found = explain_misfit([recording], TireModel(), [effect.name], lambda stage: None)
    true = {p.name: v for p, v in zip(effect.parameters, values, strict=True)}
    return [
        (f"{effect.name}: {e.name}", (e.value - true[e.name]) / max(e.deviation, 1e-300))
        for e in estimates_of(found.of([effect.name]).model.fit)
        if e.determined
    ]


@click.command()
@click.option("--seed", type=int, required=True)
@click.option("--draws", type=click.IntRange(min=1), default=200, show_default=True)
def main(seed: int, draws: int) -> None:
    """Print how many 95 % intervals hold the value that made the recording, and of which effects they do not."""
    tasks: dict[str, tuple[Any, ...]] = {str(n): (seed, n) for n in range(draws)}
    found: list[tuple[str, float]] = []
    for done in work(covered, tasks, Cores(), "covering"):
        if done.value is None:
            click.echo(f"draw {done.key} failed: {done.error}")
        else:
            found += done.value
    within = float(norm.ppf(0.975))
    rate = Rate.of(abs(z) <= within for _, z in found)
    low, high = rate.interval
    click.echo(
        f"{rate.hits} of {rate.trials} intervals of {draws} draws hold the value"
        f" ({100 * low:.0f} to {100 * high:.0f} %)"
    )
    for name in sorted({n for n, _ in found}):
        own = [abs(z) for n, z in found if n == name]
        if np.mean([z <= within for z in own]) < 0.9:
            click.echo(
                f"  {name}: {sum(z <= within for z in own)} of {len(own)}, largest {max(own):.1f} standard errors"
            )


if __name__ == "__main__":
    main()
