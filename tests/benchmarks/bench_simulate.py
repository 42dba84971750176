"""Speed of the compiled simulation (`pytest tests/benchmarks/bench_simulate.py`): ratios asserted, seconds reported."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from pytest_benchmark.fixture import BenchmarkFixture
from radialtire import CATALOGUE, TireModel
from tirelab.simulation.simulate import UPSTREAM, elastic_stage, respond_series, simulate, track

FloatArray = NDArray[np.float64]

READING_NOISE = 8e-6
"""Standard deviation [m] of the noise in the measured deflection."""

SETS = [
    (),
    ("deflection_offset", "rate_independent_hysteresis", "pressure_leak"),
    ("rate_independent_hysteresis", "viscous_damping", "viscoelastic_relaxation"),
    ("series_compliance", "viscous_damping", "viscoelastic_relaxation"),
]


@dataclass(frozen=True)
class Motion:
    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray


def motion(count: int) -> Motion:
    """Two beating sines at 400 Hz on four surfaces, with READING_NOISE."""
    t = np.arange(count) * 2.5e-3
    noise = READING_NOISE * np.random.default_rng(0).standard_normal(count)
    x = 0.012 + 0.01 * np.sin(20.0 * t) * np.sin(0.1 * t) + noise
    return Motion(t, x, np.repeat([np.inf, 0.3, -0.5, 0.08], count // 4))


def tire_of(names: tuple[str, ...]) -> TireModel:
    chosen = tuple((effect, effect.nominal) for name, effect in CATALOGUE.items() if name in names)
    return TireModel(effects=chosen, reading_noise=READING_NOISE)


def seconds(work: Callable[[], object]) -> float:
    """Return the least time of three."""
    took = []
    for _ in range(3):
        began = time.perf_counter()
        work()
        took.append(time.perf_counter() - began)
    return min(took)


@pytest.mark.parametrize("names", SETS, ids=lambda names: "+".join(names) or "bare")
def test_a_million_samples(benchmark: BenchmarkFixture, names: tuple[str, ...]) -> None:
    tire, recording = tire_of(names), motion(1_000_000)
    benchmark.pedantic(simulate, (tire, recording), warmup_rounds=1, rounds=5)


@pytest.mark.parametrize("name", CATALOGUE)
def test_one_effect_on_a_million_samples(benchmark: BenchmarkFixture, name: str) -> None:
    effect = CATALOGUE[name]
    recording = motion(1_000_000)
    history, force = elastic_stage(tire_of((name,)), recording)
    signal = recording.deflection if effect.place in UPSTREAM else force
    benchmark.pedantic(respond_series, (effect, effect.nominal, signal, history), warmup_rounds=1, rounds=5)


def test_tracking_a_million_samples(benchmark: BenchmarkFixture) -> None:
    m = motion(1_000_000)
    benchmark.pedantic(track, (m.time, m.deflection, READING_NOISE), warmup_rounds=1, rounds=5)


def test_it_is_a_hundred_times_faster_than_the_steps() -> None:
    tire, recording = tire_of(SETS[2]), motion(4000)
    state = tire.initial_state

    def step_through() -> None:
        nonlocal state
        for x, t in zip(recording.deflection.tolist(), recording.time.tolist(), strict=True):
            _, state = tire.step(x, 0.3, t, state)

    simulate(tire, recording)
    long = motion(400_000)
    compiled = seconds(lambda: simulate(tire, long)) / 400_000
    assert seconds(step_through) / 4000 > 100.0 * compiled


def test_the_cost_grows_with_the_samples_and_no_faster() -> None:
    tire = tire_of(SETS[2])
    short, long = motion(100_000), motion(1_000_000)
    simulate(tire, short)
    assert seconds(lambda: simulate(tire, long)) < 15.0 * seconds(lambda: simulate(tire, short))


def test_a_million_samples_take_under_200_megabytes() -> None:
    tire, recording = tire_of(SETS[2]), motion(1_000_000)
    simulate(tire, recording)
    tracemalloc.start()
    simulate(tire, recording)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 200e6
