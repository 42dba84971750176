"""Noise with a memory beside a motion as quick, told from what a misfit that follows the motion has."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import chirp
from tirelab.preprocessing.driven import Driven
from tirelab.preprocessing.noise import Noise, noise_of

FloatArray = NDArray[np.float64]

DEPTH = 25e-3


def swept(count: int, highest: float) -> Driven:
    """Return a sine whose frequency rises fifteenfold to `highest` cycles per sample."""
    deflection = 0.5 * DEPTH * (1.0 + chirp(np.arange(count), highest / 15.0, count, highest))
    rate = np.gradient(deflection)
    return Driven(1.0, deflection, rate, np.gradient(rate), np.zeros(count, dtype=np.intp))


def left_by_products(driven: Driven, values: FloatArray) -> FloatArray:
    """Return what a model of the products of deflection and rate leaves of values (n,) or (n, k)."""
    columns = np.column_stack([driven.signals, np.ones(driven.deflection.size)])
    basis, _ = np.linalg.qr(columns / np.linalg.norm(columns, axis=0))
    return np.asarray(values - basis @ (basis.T @ values))


@pytest.mark.parametrize(
    ("count", "highest", "length"),
    [(1500, 0.02, 4), (1500, 0.06, 4), (3000, 0.02, 4), (3000, 0.06, 4), (3000, 0.02, 8), (6000, 0.03, 8)],
)
def test_filtered_noise_is_seen_beside_a_quick_motion(count: int, highest: float, length: int) -> None:
    """A kink could vary as quickly as this noise; the noise has none, as ten of its memories for each shape show."""
    driven = swept(count, highest)
    white = np.random.default_rng(0).normal(size=count + length - 1)
    noise = np.sqrt(length) * np.convolve(white, np.ones(length) / length, mode="valid")
    found = noise_of(
        left_by_products(driven, noise), driven, lambda signals: left_by_products(driven, signals)
    )
    assert found.level == pytest.approx(1.0, rel=0.25)
    assert found.memory in (length // 2, length)


@pytest.mark.parametrize("seed", range(4))
def test_what_rises_to_the_longest_lag_of_a_random_motion_is_no_noise(seed: int) -> None:
    """A damper whose resistance is switched, and that not recorded: its force is as random as the motion and slower
    than noise of 1 N.
    """
    drawn = np.random.default_rng(seed)
    frequencies = np.linspace(2e-4, 1e-2, 60)
    phases = drawn.uniform(0.0, 2.0 * np.pi, 60)
    deflection = 2e-3 * np.cos(2.0 * np.pi * frequencies * np.arange(4000.0)[:, None] + phases).sum(axis=1)
    rate = np.gradient(deflection)
    driven = Driven(1.0, deflection, rate, np.gradient(rate), np.zeros(4000, dtype=np.intp))
    smooth = np.convolve(drawn.normal(size=4120), np.hanning(121), mode="valid")
    missed = 200.0 * np.tanh(smooth / smooth.std()) * np.tanh(2.0 * rate / rate.std())
    force = missed + drawn.normal(size=4000)
    found = noise_of(
        left_by_products(driven, force), driven, lambda signals: left_by_products(driven, signals)
    )
    assert found.level < 3.0
    assert found.memory == 1


@pytest.mark.parametrize("size", [5.0, 30.0])
@pytest.mark.parametrize(("count", "highest"), [(600, 0.02), (600, 0.04), (2400, 0.04)])
def test_friction_that_a_model_cannot_follow_is_no_noise_beside_a_quick_motion(
    count: int, highest: float, size: float
) -> None:
    """What products leave of a force that changes sign with the rate is half of it, and varies within a few samples."""
    driven = swept(count, highest)
    force = size * np.sign(driven.rate) + np.random.default_rng(0).normal(size=count)
    found = noise_of(
        left_by_products(driven, force), driven, lambda signals: left_by_products(driven, signals)
    )
    assert found.memory == 1
    assert found.level < 1.3


@pytest.mark.parametrize(
    ("count", "highest", "period", "size"),
    [(600, 0.04, 20.0, 8.0), (1200, 0.06, 25.0, 8.0), (1200, 0.02, 40.0, 20.0), (3000, 0.06, 40.0, 20.0)],
)
def test_an_oscillation_that_a_model_leaves_is_no_noise(
    count: int, highest: float, period: float, size: float
) -> None:
    """It swells by two fifths over the recording; no lag that the sweep allows is long enough to see it fall."""
    driven, time = swept(count, highest), np.arange(float(count))
    swelling = size * np.sqrt(2.0) * np.linspace(0.8, 1.2, count) * np.sin(2.0 * np.pi * time / period)
    force = swelling + np.random.default_rng(2).normal(size=count)
    found = noise_of(
        left_by_products(driven, force), driven, lambda signals: left_by_products(driven, signals)
    )
    assert found.level == pytest.approx(1.0, rel=0.15)
    assert found.memory == 1


def test_a_slow_line_that_a_model_leaves_does_not_hide_filtered_noise() -> None:
    """Driven at one frequency; what the form of an effect misses has the fifth harmonic, of the noise's size."""
    time = np.arange(8000.0)
    deflection = 0.5 * DEPTH * (1.0 - np.cos(2.0 * np.pi * time / 1600.0))
    rate = np.gradient(deflection)
    driven = Driven(1.0, deflection, rate, np.gradient(rate), np.zeros(time.size, dtype=np.intp))
    noise = 2.0 * np.convolve(np.random.default_rng(3).normal(size=8003), np.ones(4) / 4.0, mode="valid")
    force = noise + np.sqrt(2.0) * np.sin(2.0 * np.pi * time / 320.0)
    found = noise_of(
        left_by_products(driven, force), driven, lambda signals: left_by_products(driven, signals)
    )
    assert found.level == pytest.approx(1.0, rel=0.1)
    assert found.memory == 4


@pytest.mark.parametrize("highest", [0.01, 0.02, 0.03, 0.05])
@pytest.mark.parametrize("count", [2000, 5000, 16000])
def test_a_ripple_that_a_quick_motion_passes_in_a_few_samples_is_no_noise(count: int, highest: float) -> None:
    """Nine knobs of 30 N along the stroke of a sweep: at its end each passes in a few samples, at its begin in fifteen
    times as many; over all samples the third differences show 20 N. All visits of a place see the same ripple; of the
    shortest of these sweeps they know the noise to a third.
    """
    driven = swept(count, highest)
    ripple = 30.0 * np.sin(2.0 * np.pi * driven.deflection / (DEPTH / 9.0))
    found = noise_of(ripple + np.random.default_rng(5).normal(size=count), driven)
    assert 0.9 < found.level < 1.6


def many_rates(count: int) -> Driven:
    """Return triangles of 20 mm, each quicker than the one before: from 300 samples a stroke to 30."""
    strokes, at = np.geomspace(300.0, 30.0, 60), np.arange(float(count))
    turns = np.concatenate([[0.0], np.cumsum(np.tile(strokes, 1 + count // int(strokes.sum())))])
    deflection = 20e-3 * np.interp(at, turns, np.arange(turns.size) % 2)
    rate = np.gradient(deflection)
    return Driven(1.0, deflection, rate, np.gradient(rate), np.zeros(count, dtype=np.intp))


def test_a_stick_and_slip_that_no_visit_repeats_is_no_noise() -> None:
    """It slips after about 1.5 mm of path each: within 23 samples where the motion is slow, within 2 where it is quick.
    Its saw teeth are 40 N high, eight times the noise; where most of them lie does not come again.
    """
    driven, drawn = many_rates(12000), np.random.default_rng(6)
    path = np.cumsum(np.abs(driven.rate))
    slips = np.cumsum(drawn.uniform(0.5e-3, 2.5e-3, int(path[-1] / 0.5e-3)))
    since = path - np.concatenate([[0.0], slips])[np.searchsorted(slips, path)]
    force = 40.0 * np.sign(driven.rate) * (since / 1.5e-3 - 0.5)
    assert noise_of(force + drawn.normal(size=path.size), driven).level < 4.0


@pytest.mark.parametrize("louder", [0.0, 1.0])
def test_filtered_noise_beside_many_rates_is_seen(louder: float) -> None:
    """Also of a machine that is louder the quicker it moves: its noise is larger there, but no rougher."""
    driven = many_rates(12000)
    speed = np.abs(driven.rate) / np.abs(driven.rate).max()
    white = np.random.default_rng(0).normal(size=12007)
    noise = np.sqrt(8.0) * np.convolve(white, np.ones(8) / 8.0, mode="valid") * (1.0 + louder * speed)
    found = noise_of(noise, driven)
    assert found.level == pytest.approx(float(np.std(noise)), rel=0.25)
    assert found.memory in (4, 8)


def test_filtered_noise_beside_one_rate_is_seen() -> None:
    """No half of the samples is quicker than the other."""
    deflection = 1e-5 * np.arange(4000.0)
    driven = Driven(1.0, deflection, np.full(4000, 1e-5), np.zeros(4000), np.zeros(4000, dtype=np.intp))
    white = np.random.default_rng(0).normal(size=4003)
    found = noise_of(2.0 * np.convolve(white, np.ones(4) / 4.0, mode="valid"), driven)
    assert found.level == pytest.approx(1.0, rel=0.25)
    assert found.memory == 4


@pytest.mark.parametrize(
    ("rate_of_motion", "known", "hums"),
    [(10.0, 0.0, False), (9.73, 0.0, True), (10.0, 2.0, True), (10.0, 1.0, False)],
)
def test_the_fifth_harmonic_of_a_motion_is_no_hum(rate_of_motion: float, known: float, hums: bool) -> None:
    """A line of 2 N at 50 Hz beside noise of 1 N: it comes again in each cycle of 10 Hz, and in none of 9.73 Hz. Where
    another recording of the series has a hum as loud, it is one.
    """
    time = np.arange(8000) / 1000.0
    angle = 2.0 * np.pi * rate_of_motion * time
    deflection, rate = DEPTH * (1.0 - np.cos(angle)), DEPTH * 2.0 * np.pi * rate_of_motion * np.sin(angle)
    driven = Driven(1e-3, deflection, rate, np.gradient(rate, 1e-3), np.zeros(8000, dtype=np.intp))
    line = np.sqrt(8.0) * np.sin(2.0 * np.pi * 50.0 * time + 0.3)
    other = Noise(3.0, 1, known)
    found = noise_of(line + np.random.default_rng(4).normal(size=8000), driven, known=[other.of_mains])
    assert found.level == pytest.approx(np.sqrt(5.0) if hums else 1.0, rel=0.1)
    assert found.hum == pytest.approx(2.0 if hums else 0.0, rel=0.05)


def random_motion(drawn: np.random.Generator, count: int = 1500) -> Driven:
    """Return a motion of random phases up to 0.04 cycles a sample, whose products are as quick as the noise."""
    frequencies = np.linspace(1e-3, 0.04, 60)
    phases = drawn.uniform(0.0, 2.0 * np.pi, 60)
    deflection = 2e-3 * np.cos(2.0 * np.pi * frequencies * np.arange(count)[:, None] + phases).sum(axis=1)
    rate = np.gradient(deflection)
    return Driven(1.0, deflection, rate, np.gradient(rate), np.zeros(count, dtype=np.intp))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("level", "memory", "believed"), [(1.0, 4, True), (3.0, 4, False), (1.0, 32, False)])
def test_a_noise_that_the_motion_could_make_is_believed_of_another_recordings_amplifier(
    seed: int, level: float, memory: int, believed: bool
) -> None:
    """A mean of six white samples: alone it may be what follows so quick a motion. Another amplifier proves nothing."""
    drawn = np.random.default_rng(seed)
    driven = random_motion(drawn)
    noise = np.sqrt(6.0) * np.convolve(drawn.normal(size=1505), np.ones(6) / 6.0, mode="valid")
    assert noise_of(noise, driven).memory == 1
    found = noise_of(noise, driven, known=[Noise(level, memory)])
    assert (found.memory in (4, 8)) == believed
    assert found.level == pytest.approx(1.0, rel=0.15) if believed else found.level < 0.75


@pytest.mark.parametrize("seed", range(6))
def test_what_follows_the_motion_is_no_noise_of_another_recordings_amplifier(seed: int) -> None:
    """A force of the rate, as large as that noise, keeps rising over longer lags."""
    drawn = np.random.default_rng(seed)
    driven = random_motion(drawn)
    force = driven.rate / np.std(driven.rate) + 0.1 * drawn.normal(size=1500)
    assert noise_of(force, driven, known=[Noise(1.0, 4)]).level < 0.2
