"""What a fitted tire leaves is noise where it has a memory, comes to its whole variation, and nothing of the motion."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import butter, lfilter
from tirelab.preprocessing.driven import Driven
from tirelab.preprocessing.noise import noise_left, noise_of

FloatArray = NDArray[np.float64]

INTERVAL = 1.0 / 400.0
COUNT = 6000


def ride(seed: int, count: int = COUNT) -> Driven:
    """A ride: many sines of up to 30 Hz, whose amplitudes fall with the frequency."""
    random, time = np.random.default_rng(seed), INTERVAL * np.arange(count)
    frequencies = random.uniform(1.0, 30.0, 40)
    phases, sizes = random.uniform(0.0, 2.0 * np.pi, 40), 3e-3 / frequencies
    turns = 2.0 * np.pi * frequencies * time[:, None] + phases
    deflection = 0.01 + np.sin(turns) @ sizes
    rate = np.cos(turns) @ (2.0 * np.pi * frequencies * sizes)
    acceleration = -np.sin(turns) @ ((2.0 * np.pi * frequencies) ** 2 * sizes)
    return Driven(INTERVAL, deflection, rate, acceleration, np.zeros(count, dtype=np.intp))


def filtered(seed: int, cut_off: float, count: int = COUNT) -> FloatArray:
    """Noise of standard deviation 1 behind a filter at this part of half the sampling rate."""
    white = np.random.default_rng(seed).normal(size=count + 500)
    noise = lfilter(*butter(2, cut_off), white)[500:]
    return np.asarray(noise / np.std(noise))


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("cut_off", [0.15, 0.25, 0.35])
def test_filtered_noise_of_a_ride_is_seen_in_what_the_tire_leaves(cut_off: float, seed: int) -> None:
    """The levels of noise behind a filter approach the whole from either side, within a lag's factor of growth."""
    found = noise_left(filtered(seed, cut_off), ride(seed))
    assert found is not None
    assert found.level == pytest.approx(1.0, rel=0.15)
    assert 2 <= found.memory <= 16


def test_beside_a_misfit_as_quick_the_same_noise_is_not_seen() -> None:
    """Why what is left is asked again: beside forty times the noise of a stiffer tire only its white part shows."""
    motion = ride(1)
    misfit = filtered(1, 0.25) + 40.0 * (motion.deflection - 0.01) / 3e-3
    assert noise_of(misfit, motion).level < 0.5


def test_white_noise_needs_no_second_look() -> None:
    assert noise_left(np.random.default_rng(3).normal(size=COUNT), ride(3)) is None


MISSED = {
    "a spring": lambda m: m.deflection,
    "a damper": lambda m: m.rate,
    "a mass": lambda m: m.acceleration,
    "friction": lambda m: np.sign(m.rate),
    "a stop": lambda m: np.maximum(m.deflection - np.quantile(m.deflection, 0.9), 0.0),
    "a ripple": lambda m: np.sin(m.deflection / 3e-4),
    "louder where quicker": lambda m: (
        np.random.default_rng(9).normal(size=m.rate.size) * np.abs(m.rate) / np.abs(m.rate).max()
    ),
}


@pytest.mark.parametrize("name", MISSED)
def test_what_follows_the_motion_is_no_noise(name: str) -> None:
    """As large as the noise beside it, so that half of the variance is noise."""
    motion = ride(4)
    missed = MISSED[name](motion)
    missed = (missed - missed.mean()) / np.std(missed)
    assert noise_left(filtered(4, 0.25) + missed, motion) is None


def test_a_short_recording_is_judged_by_as_many_shapes_as_it_has_memories_for() -> None:
    """1500 samples have some two hundred memories, too few for forty shapes; ten and five of each kind are asked."""
    found = noise_left(filtered(5, 0.2, 1500), ride(5, 1500))
    assert found is not None
    assert found.level == pytest.approx(1.0, rel=0.15)
    motion = ride(5, 1500)
    spring = (motion.deflection - motion.deflection.mean()) / np.std(motion.deflection)
    assert noise_left(filtered(5, 0.2, 1500) + spring, motion) is None


def shaken(seed: int) -> Driven:
    """A mass and a damper under a force as quick as filtered noise, such as that of a motor whose current is random."""
    acceleration = filtered(seed, 0.4)
    rate = lfilter([INTERVAL], [1.0, 3.0 * INTERVAL - 1.0], acceleration)
    surface = np.zeros(COUNT, dtype=np.intp)
    return Driven(INTERVAL, INTERVAL * np.cumsum(rate), rate, acceleration, surface)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("later", [3, 4])
def test_a_mass_whose_force_is_read_late_is_no_noise(later: int, seed: int) -> None:
    """At its own instant the acceleration shows nothing of such a force, which has the memory of a noise."""
    motion = shaken(seed)
    force = np.roll(motion.acceleration, later)
    assert abs(np.corrcoef(force, motion.acceleration)[0, 1]) < 0.4
    assert noise_left(force, motion) is None


@pytest.mark.parametrize("seed", range(8))
def test_a_noise_as_quick_as_the_motion_of_a_mass_is_seen(seed: int) -> None:
    found = noise_left(filtered(seed + 90, 0.4), shaken(seed))
    assert found is not None
    assert found.level == pytest.approx(1.0, rel=0.15)
