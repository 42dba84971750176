"""Motions, a bench and measures of a loop that the tests of the rig share."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from concealed.bench import Bench
from concealed.effects import Effect
from concealed.motion import FloatArray, Motion
from concealed.tires import article_tire

#: Samples of one cycle of the sine.
CYCLE = 4000


@pytest.fixture
def bench() -> Bench:
    """The article's tire with nothing hidden in it."""
    return Bench(article_tire())


@pytest.fixture
def flat_motion() -> Callable[[FloatArray, FloatArray], Motion]:
    """A motion on the flat whose every sample is recorded."""

    def make(time: FloatArray, deflection: FloatArray) -> Motion:
        return Motion("test", time, deflection, np.full(time.size, math.inf))

    return make


@pytest.fixture
def sine_motion(flat_motion: Callable[[FloatArray, FloatArray], Motion]) -> Callable[..., Motion]:
    """Three cycles of a sine of a frequency [Hz] between two deflections [m]."""

    def make(frequency: float, low: float = 0.0, high: float = 0.025) -> Motion:
        time = np.arange(3 * CYCLE + 1) / (frequency * CYCLE)
        return flat_motion(time, low + (high - low) * (0.5 - 0.5 * np.cos(2.0 * np.pi * frequency * time)))

    return make


@pytest.fixture
def added(bench: Bench) -> Callable[[Effect, Motion], FloatArray]:
    """What an effect adds to the force of the article's tire [N]."""

    def difference(effect: Effect, motion: Motion) -> FloatArray:
        return Bench(bench.tire, (effect,)).force(motion) - bench.force(motion)

    return difference


@pytest.fixture
def loop_area() -> Callable[[Motion, FloatArray], float]:
    """Work [J] that a force [N] takes up over the last cycle of the sine."""

    def area(motion: Motion, force: FloatArray) -> float:
        x, f = motion.deflection[-CYCLE - 1 :], force[-CYCLE - 1 :]
        return float(np.sum(0.5 * (f[1:] + f[:-1]) * np.diff(x)))

    return area
