"""Slow noise is read off a spectrum, and whitened whatever its slowest time."""

import numpy as np
import pytest
from scipy.fft import dct
from scipy.signal import lfilter
from tirelab.preprocessing.coloured_noise import MOST_SLOW_VARIANCE, SLOW_TIME, slow_noise

COUNT = 8000


def markov(seed, time, deviation):
    """Return first-order Markov noise of a correlation time [samples], stationary from its first sample."""
    keep = np.exp(-1.0 / time)
    steps = deviation * np.sqrt(1.0 - keep**2) * np.random.default_rng(seed).standard_normal(COUNT)
    steps[0] = deviation * np.random.default_rng(seed + 1).standard_normal()
    return lfilter([1.0], [1.0, -keep], steps)


def white(seed, deviation=1.0):
    return deviation * np.random.default_rng(seed).standard_normal(COUNT)


def evenness(values):
    """Return the powers of six octaves of the cosine spectrum over that of the whole."""
    power = dct(values, norm="ortho")[1:] ** 2
    octaves = np.split(power, [64, 128, 256, 512, 1024])
    return np.array([o.mean() for o in octaves]) / power.mean()


def test_white_noise_is_left_as_it_is():
    found = slow_noise(white(1, 3.0))
    # The variance of 8000 draws is known to 1.6 %: three of those, of a standard deviation half of that.
    assert found.level == pytest.approx(3.0, rel=0.024)
    assert found.times.size == 0
    np.testing.assert_array_equal(found.whitened(white(2)), white(2))


@pytest.mark.parametrize("time", [10.0, 60.0, 400.0])
def test_a_slow_noise_beside_white_noise_is_whitened(time):
    values = white(3) + markov(4, time, 0.7)
    found = slow_noise(values)
    assert found.level == pytest.approx(np.sqrt(1.49), rel=0.1)
    # Below the corner the raw spectrum stands above the white one by 2 tau 0.49; white octaves of n powers scatter by
    # sqrt(2/n): 18 % at 64 of them, of which three.
    assert evenness(values)[0] > 2.0
    assert np.all(np.abs(evenness(found.whitened(values)) - 1.0) < 3.0 * np.sqrt(2.0 / 64.0))


def test_pink_noise_is_a_sum_of_relaxations():
    fall = np.concatenate([[0.0], 1.0 / np.arange(1, COUNT)])
    waves = np.sqrt(0.5 * COUNT * fall / fall.sum()) * white(5)
    pink = dct(waves, type=3, norm="ortho")
    found = slow_noise(white(6) + pink)
    assert found.times.size >= 2
    assert np.all(np.abs(evenness(found.whitened(white(6) + pink)) - 1.0) < 3.0 * np.sqrt(2.0 / 64.0))


def test_the_whitening_filter_is_the_inverse_root_of_the_spectrum():
    found = slow_noise(white(7) + markov(8, 100.0, 0.7))
    impulse = np.zeros(4 * COUNT)
    impulse[0] = 1.0
    passed = np.abs(np.fft.rfft(found.whitened(impulse))) ** 2
    angle = np.linspace(0.0, np.pi, passed.size)
    keep = np.exp(-1.0 / found.times)
    spectrum = found.white + np.sum(
        found.variances * (1 - keep**2) / (1 - 2 * keep * np.cos(angle[:, None]) + keep**2), axis=1
    )
    # The product is the innovation's variance at every frequency: the sum's own definition against the cascade.
    assert np.ptp(passed * spectrum) < 1e-6 * np.mean(passed * spectrum)
    assert found.gain**2 == pytest.approx(passed[0], rel=1e-9)


def test_what_a_model_has_taken_does_not_hide_the_noise():
    values = white(9) + markov(10, 150.0, 0.8)
    waves = np.stack([np.cos(np.pi * k * (np.arange(COUNT) + 0.5) / COUNT) for k in range(12)], axis=1)
    left = values - waves @ np.linalg.lstsq(waves, values, rcond=None)[0]
    taken = np.where(np.arange(COUNT) < 12, 1.0, 0.0)
    told, untold = slow_noise(left, taken), slow_noise(left)
    # The white part is known to a percent; the slow part has some 8000 / 150 independent values, so to a fifth.
    assert told.variances.sum() == pytest.approx(0.64, rel=0.4)
    assert told.variances.sum() > untold.variances.sum()


def test_what_is_louder_than_white_noise_is_not_taken_for_noise():
    found = slow_noise(white(11) + markov(12, 200.0, 20.0))
    slow = found.times > SLOW_TIME
    quick = found.white + found.variances[~slow].sum()
    assert found.variances[slow].sum() == pytest.approx(MOST_SLOW_VARIANCE * quick)


def test_a_line_is_no_noise():
    hum = 4.0 * np.sin(0.9 * np.arange(COUNT))
    # A line and its two neighbours, of 8000 frequencies, count as LINE times the spectrum there; the whole is 3 N.
    assert slow_noise(white(13) + hum).level == pytest.approx(1.0, rel=0.1)


def test_short_residuals_have_white_noise_alone():
    assert slow_noise(np.random.default_rng(14).standard_normal(40)).times.size == 0
