"""What a diagnosis makes of single effects where a cycle of the motion has few samples.

    python tests/benchmarks/bench_few_samples.py --seed 5 [--effect inertia] [--motion sine]

Each effect is computed here from its equation on a motion twenty times as fine as the samples that are kept, beside
the law of the article on flat ground, 4 % of the force (root mean square), with a noise of 0.3 % and of 0.01 % of it
and a gauge as good. A verdict is right that names the effect above 50 % and no other; a refitted law counts as none.
In a sine of one frequency a mass may be another law, and a late force a damper, so not all can be told.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from itertools import product

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfilt
from tirelab import Recording, diagnose
from tirelab.errors import TirelabError

FloatArray = NDArray[np.float64]

COUNT, STEP, FINER = 1500, 0.01, 20
"""Samples of a recording, their interval [s], and the fine instants of the simulation in each."""

INSTANTS = np.linspace(0.0, COUNT - 1.0, (COUNT - 1) * FINER + 1)
"""Fine instants of the simulation [samples]."""

MIDDLE, STROKE = 0.012, 0.008
"""Middle and half the stroke of the deflection [m]."""

SIZE, REACH = 0.04, 1e-3
"""Size of an effect as a part of the force, and the deflection [m] over which a friction breaks away."""

NOISES = (3e-3, 1e-4)
"""Noise of the force as a part of it; the gauge has a tenth of that part of 20 mm."""


def sine(samples: float) -> FloatArray:
    """Return a sine of so many samples a cycle."""
    return np.asarray(MIDDLE + STROKE * np.sin(2.0 * np.pi * np.arange(COUNT) / samples))


def sines() -> FloatArray:
    """Return six sines one after another, of 160 to 6 samples a cycle."""
    cycle = np.repeat([160.0, 80.0, 40.0, 20.0, 10.0, 6.0], COUNT // 6)
    return np.asarray(MIDDLE + STROKE * np.sin(np.cumsum(2.0 * np.pi / cycle)))


def sweep() -> FloatArray:
    """Return a sweep from 200 to 7 samples a cycle."""
    return np.asarray(MIDDLE + STROKE * np.sin(2.0 * np.pi * np.cumsum(np.geomspace(1 / 200, 1 / 7, COUNT))))


def road(random: np.random.Generator) -> FloatArray:
    """Return a random motion of 200 to 17 samples a cycle, with next to nothing beyond."""
    own = sosfilt(butter(6, [0.01, 0.12], "bandpass", output="sos"), random.standard_normal(COUNT))
    return np.asarray(MIDDLE + STROKE * own / np.abs(own).max())


def triangle(samples: float) -> FloatArray:
    """Return a triangle of so many samples a cycle, with its corners between them, at the fine instants."""
    phase = (INSTANTS / samples + 0.13) % 1.0
    return np.asarray(MIDDLE + STROKE * (1.0 - 2.0 * np.abs(2.0 * phase - 1.0)))


def fine(motion: FloatArray) -> FloatArray:
    """Return the motion at the fine instants of one that is smooth between the samples."""
    return np.asarray(CubicSpline(np.arange(COUNT), motion)(INSTANTS))


MOTIONS: dict[str, Callable[[np.random.Generator], FloatArray]] = {
    "sine of 6.4": lambda random: fine(sine(6.4)),
    "sine of 8.7": lambda random: fine(sine(8.7)),
    "sine of 16.3": lambda random: fine(sine(16.3)),
    "six sines": lambda random: fine(sines()),
    "sweep": lambda random: fine(sweep()),
    "road": lambda random: fine(road(random)),
    "triangle of 20": lambda random: triangle(20.0),
    "triangle of 40.3": lambda random: triangle(40.3),
}
"""Motions at the fine instants, by name."""


def law(deflection: FloatArray) -> FloatArray:
    """Return the article's force [N] on flat ground."""
    return np.asarray(550.9 * np.maximum(100.0 * deflection, 0.0) ** 1.422)


def late(values: FloatArray, constant: float) -> FloatArray:
    """Return values behind a filter of first order, its time constant in fine instants."""
    kept, part = np.empty_like(values), 1.0 - np.exp(-1.0 / constant)
    kept[0] = values[0]
    for i in range(1, values.size):
        kept[i] = kept[i - 1] + part * (values[i] - kept[i - 1])
    return kept


def slipping(deflection: FloatArray) -> FloatArray:
    """Return Dahl's friction, from -1 to 1."""
    state = np.zeros_like(deflection)
    for i, step in enumerate(np.diff(deflection), start=1):
        state[i] = np.clip(state[i - 1] + step / REACH * (1.0 - np.sign(step) * state[i - 1]), -1.0, 1.0)
    return state


def driven(effect: str, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return deflection [m] as read and force [N] at the samples, with an effect, without noise.

    motion: at the fine instants
    """
    rate = np.gradient(motion)
    acceleration, force = np.gradient(rate), law(motion)
    size, read = float(np.sqrt(np.mean(force**2))), motion

    def sized(response: FloatArray) -> FloatArray:
        return np.asarray(SIZE * size * response / np.sqrt(np.mean(response**2)))

    if effect == "viscous_damping":
        force = force + sized(rate)
    elif effect == "inertia":
        force = force + sized(acceleration)
    elif effect == "rate_independent_hysteresis":
        force = force * (1.0 + SIZE * slipping(motion))
    elif effect in ("force_lag", "deflection_lag"):
        constant = SIZE * size / float(np.sqrt(np.mean(np.gradient(force) ** 2)))
        read, force = (
            (late(motion, constant), force) if effect == "deflection_lag" else (motion, late(force, constant))
        )
    return read[::FINER], force[::FINER]


EFFECTS = ("viscous_damping", "inertia", "rate_independent_hysteresis", "force_lag", "deflection_lag", "none")


def cases(seed: int) -> Iterator[tuple[str, str, float, Recording]]:
    """Yield effect, motion, noise and recording of each case."""
    for number, (effect, name, noise) in enumerate(product(EFFECTS, MOTIONS, NOISES)):
        random = np.random.default_rng([seed, number])
        read, force = driven(effect, MOTIONS[name](random))
        size = float(np.sqrt(np.mean(force**2)))
        force = force + noise * size * random.standard_normal(COUNT)
        read = read + 0.1 * noise * 0.02 * random.standard_normal(COUNT)
        yield effect, name, noise, Recording.from_arrays(STEP * np.arange(COUNT), read, force, "flat")


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--effect", default="", help="only effects whose names begin so")
    parser.add_argument("--motion", default="", help="only motions whose names begin so")
    given = parser.parse_args()
    right, wrong, unsure, count = 0, 0, 0, 0
    for effect, motion, noise, recording in cases(given.seed):
        if not (effect.startswith(given.effect) and motion.startswith(given.motion)):
            continue
        count += 1
        try:
            verdict = diagnose(recording, TireModel())
        except TirelabError as error:
            print(f"{effect}, {motion}, noise {noise:g}: {error}")
            continue
        likely = {e.name for e in verdict.effects if e.probability >= 0.5} - {"recalibration"}
        true = likely == {effect} - {"none"}
        right, wrong = right + true, wrong + bool(likely - {effect})
        unsure += not true and not likely - {effect}
        told = ", ".join(f"{e.name} {100 * e.probability:.0f} %" for e in verdict.effects) or "nothing"
        print(f"{effect}, {motion}, noise {noise:g}: {'right' if true else 'NOT right'}: {told}", flush=True)
    print(f"of {count} cases {right} right, {wrong} with another effect above 50 %, {unsure} undecided")
    return 0


if __name__ == "__main__":
    sys.exit(main())
