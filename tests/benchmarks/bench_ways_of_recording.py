"""What a diagnosis makes of single effects under the ways in which recordings are made and exported.

    python tests/benchmarks/bench_ways_of_recording.py [--way adaptive] [--effect inertia]

Each effect is computed here from its equation on a motion of 49 s in steps of 1 ms (triangles to two depths, three
speeds, a hold, sines to 4 Hz, the first triangle again), beside the law of the article on flat ground, and recorded in
each way: 100 Hz with a noise of 0.3 % of the force and 2 um of the gauge, and one thing more. A verdict is right that
names the effect above 50 % and no other; under another law the refitted law may be named too.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from itertools import product

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from scipy.signal import butter, lfilter, sosfilt
from tirelab import Recording, diagnose
from tirelab.errors import TirelabError

FloatArray = NDArray[np.float64]

STEP, EACH = 1e-3, 10
"""Step of the simulation [s], and how many of them a sample is apart."""

SIZE = 0.03
"""Size of an effect as a part of the force."""

FORCE_NOISE, GAUGE_NOISE = 3e-3, 2e-6
"""Noise of the force as a part of it, and of the deflection [m]."""


def driven() -> tuple[FloatArray, FloatArray]:
    """Return time [s] and deflection [m], its corners rounded over 42 ms."""
    parts, here = [np.array([0.004])], 0.004

    def go(to: float, speed: float) -> None:
        nonlocal here
        count = max(1, round(abs(to - here) / speed / STEP))
        parts.append(here + (to - here) * np.arange(1, count + 1) / count)
        here = to

    def hold(seconds: float) -> None:
        parts.append(np.full(round(seconds / STEP), here))

    hold(1.0)
    for top in (0.012, 0.020):
        go(top, 0.006)
        go(0.004, 0.006)
    hold(2.0)
    for speed in (0.02, 0.06, 0.15):
        for _ in range(2):
            go(0.020, speed)
            go(0.004, speed)
        hold(0.5)
    go(0.018, 0.1)
    hold(6.0)
    go(0.004, 0.1)
    hold(3.0)
    go(0.008, 0.05)
    for frequency in (0.5, 1.0, 2.0, 4.0):
        count = round(max(3, round(3 * frequency)) / frequency / STEP)
        parts.append(here + 0.005 * (1.0 - np.cos(2.0 * np.pi * frequency * STEP * np.arange(1, count + 1))))
    go(0.004, 0.05)
    hold(1.0)
    for to in (0.012, 0.020, 0.004):
        go(to, 0.006)
    hold(1.0)
    path = np.concatenate(parts)
    window = np.hanning(43)[1:-1]
    padded = np.concatenate([np.full(41, path[0]), path, np.full(41, path[-1])])
    rounded = np.convolve(padded, window / window.sum(), "same")[41:-41]
    return np.arange(path.size) * STEP, np.asarray(rounded)


def law(deflection: FloatArray) -> FloatArray:
    """Return the article's force [N] on flat ground."""
    return np.asarray(550.9 * np.maximum(100.0 * deflection, 0.0) ** 1.422)


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def late(values: FloatArray, constant: float) -> FloatArray:
    """Return values behind a filter of first order with a time constant [s]."""
    part = 1.0 - np.exp(-STEP / constant)
    return np.asarray(lfilter([part], [1.0, part - 1.0], values - values[0]) + values[0])


def slipping(deflection: FloatArray) -> FloatArray:
    """Return Dahl's friction, from -1 to 1."""
    state = np.zeros_like(deflection)
    for i, step in enumerate(np.diff(deflection)):
        state[i + 1] = np.clip(state[i] + step / 1e-3 * (1.0 - np.sign(step) * state[i]), -1.0, 1.0)
    return state


def sprung(x: FloatArray, compliance: float) -> FloatArray:
    """Return the deflection [m] of the tire before a spring [m/N]."""
    tire = x.copy()
    for _ in range(80):
        tire = 0.5 * tire + 0.5 * (x - compliance * law(tire))
    return tire


def with_effect(name: str, time: FloatArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the deflection [m] as read and the force [N] with an effect, without noise."""
    force = law(x)
    size, part, rate = rms(force), time / time[-1], np.gradient(x, STEP)
    constant = SIZE * size / rms(np.gradient(force, STEP))

    def beside(response: FloatArray) -> FloatArray:
        return np.asarray(force + SIZE * size * response / rms(response))

    decaying = lfilter([1.0], [1.0, -np.exp(-STEP / 0.7)], np.diff(force, prepend=force[0]))
    forces: dict[str, Callable[[], FloatArray]] = {
        "none": lambda: force,
        "viscous_damping": lambda: beside(rate),
        "rate_independent_hysteresis": lambda: beside(slipping(x)),
        "inertia": lambda: beside(np.gradient(rate, STEP)),
        "force_lag": lambda: late(force, constant),
        "deflection_lag": lambda: force,
        "series_compliance": lambda: law(sprung(x, SIZE * rms(x) / size)),
        "viscoelastic_relaxation": lambda: beside(decaying),
        "bottoming": lambda: beside(np.maximum(x - 0.0165, 0.0)),
        "saturation": lambda: np.minimum(force, force.max() * (1.0 - 3.0 * SIZE)),
        "pressure_leak": lambda: force * np.exp(-2.0 * SIZE * part),
        "warm_up": lambda: force * (1.0 + 2.0 * SIZE * (1.0 - np.exp(-time / 15.0))),
        "mullins_softening": lambda: (
            force * (1.0 - 3.0 * SIZE * np.tanh((np.maximum.accumulate(x) - x) / 0.004))
        ),
        "force_drift": lambda: force + 2.0 * SIZE * size * part,
        "force_offset": lambda: force + SIZE * size,
        "deflection_offset": lambda: force,
        "gas_compression": lambda: force * (1.0 + 4.0 * SIZE * (x / x.max()) ** 1.5),
    }
    read = {"deflection_lag": late(x, constant), "deflection_offset": x + 0.012 * SIZE}
    return read.get(name, x), np.asarray(forces[name]())


EFFECTS = (
    *("none", "viscous_damping", "rate_independent_hysteresis", "inertia", "force_lag", "deflection_lag"),
    *("series_compliance", "viscoelastic_relaxation", "bottoming", "saturation", "pressure_leak", "warm_up"),
    *("mullins_softening", "force_drift", "force_offset", "deflection_offset", "gas_compression"),
)

WAYS = {
    "plain": "nothing more",
    "adaptive": "a sample each 0.2 mm or 0.5 s",
    "jitter_known": "samples late by 1.5 ms at random, with their times",
    "jitter_hidden": "the same, the times written as even",
    "averaged": "means of 0.1 s",
    "filtered": "both channels behind a filter of second order at 10 Hz",
    "steps": "force in steps of 0.5 % of the largest, deflection of 0.05 mm",
    "coloured": "a noise with a memory of twenty samples",
    "load_noise": "1 % of the force as noise beside it",
    "outliers": "one sample of a hundred off by thirty times the noise",
    "hum": "1 % of mains hum",
    "gauge_noise": "20 um of the gauge",
    "cut": "begun in the first triangle",
    "gap": "the logger paused for 3.5 s",
    "loading_only": "the ways back left out",
    "slow10": "10 Hz",
    "drift_slow": "a random walk of the force's zero",
    "law": "another tire: a fifth stiffer, its exponent 0.1 higher",
}


def recorded(way: str, x: FloatArray, force: FloatArray, random: np.random.Generator) -> Recording:
    """Return the recording of a motion [m] and a force [N] on the fine instants."""
    time, size, normal = np.arange(x.size) * STEP, rms(force), random.standard_normal
    noise, at = FORCE_NOISE * size, np.arange(0, x.size, EACH)
    if way == "filtered":
        low = butter(2, 10.0, fs=1.0 / STEP, output="sos")
        x, force = (sosfilt(low, v - v[0]) + v[0] for v in (x, force))
    if way == "hum":
        force = force + 0.01 * size * np.sin(2.0 * np.pi * 50.3 * time)
    if way == "averaged":
        many = 10 * EACH
        count = x.size // many
        means = [v[: count * many].reshape(count, many).mean(1) for v in (time, x, force)]
        return Recording.from_arrays(
            means[0], means[1] + GAUGE_NOISE * normal(count), means[2] + noise * normal(count), "flat"
        )
    if way == "adaptive":
        kept = [0]
        for i in at[1:].tolist():
            if abs(x[i] - x[kept[-1]]) > 2e-4 or time[i] - time[kept[-1]] > 0.5:
                kept.append(i)
        at = np.array(kept)
    if way.startswith("jitter"):
        moved = at + np.round(random.normal(0.0, 1.5, at.size)).astype(int)
        at = np.unique(np.maximum.accumulate(np.clip(moved, 0, x.size - 1)))
    if way == "cut":
        at = at[at > 0.03 * x.size + 57]
    if way == "gap":
        at = at[(at < 0.35 * x.size) | (at > 0.42 * x.size)]
    if way == "loading_only":
        at = at[np.gradient(x)[at] >= -1e-9]
    if way == "slow10":
        at = np.arange(0, x.size, 10 * EACH)
    clock, read, true = time[at], x[at], force[at]
    if way == "jitter_hidden":
        clock = EACH * STEP * np.arange(at.size)
    white = normal(at.size)
    if way == "coloured":
        white = lfilter([np.sqrt(1.0 - 0.95**2)], [1.0, -0.95], white)
    told = true + noise * white
    read = read + GAUGE_NOISE * normal(at.size)
    if way == "load_noise":
        told = told + 0.01 * true * normal(at.size)
    if way == "outliers":
        told = told + (random.random(at.size) < 0.01) * normal(at.size) * noise * 30.0
    if way == "steps":
        step = 0.005 * float(force.max())
        told, read = np.round(told / step) * step, np.round(read / 5e-5) * 5e-5
    if way == "gauge_noise":
        read = read + 2e-5 * normal(at.size)
    if way == "drift_slow":
        told = told + 0.02 * noise * np.cumsum(normal(at.size))
    if way == "law":
        told = 1.2 * told * (100.0 * np.maximum(read, 1e-4)) ** 0.1
    return Recording.from_arrays(clock, read, told, "flat")


def cases() -> Iterator[tuple[str, str, Recording]]:
    """Yield way, effect and recording of each case."""
    time, x = driven()
    for number, (way, effect) in enumerate(product(WAYS, EFFECTS)):
        yield way, effect, recorded(way, *with_effect(effect, time, x), np.random.default_rng(number))


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--way", default="", help="only ways whose names begin so")
    parser.add_argument("--effect", default="", help="only effects whose names begin so")
    given = parser.parse_args()
    right, wrong, unsure, refused, count = 0, 0, 0, 0, 0
    for way, effect, recording in cases():
        if not (way.startswith(given.way) and effect.startswith(given.effect)):
            continue
        count += 1
        try:
            verdict = diagnose(recording, TireModel())
        except TirelabError as error:
            print(f"{way}, {effect}: {error}", flush=True)
            refused += 1
            continue
        free = {"recalibration"} if way == "law" else set()
        likely = {e.name for e in verdict.effects if e.probability >= 0.5} - free
        true = likely == {effect} - {"none"}
        right, wrong = right + true, wrong + bool(likely - {effect})
        unsure += not true and not likely - {effect}
        told = ", ".join(f"{e.name} {100 * e.probability:.0f} %" for e in verdict.effects) or "nothing"
        print(f"{way}, {effect}: {'right' if true else 'NOT right'}: {told}", flush=True)
    print(
        f"of {count} cases {right} right, {wrong} with another effect above 50 %, {unsure} undecided, {refused} refused"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
