"""The noise is found from the data: its size, its colour, its spikes."""

import numpy as np
import pytest
from scipy.fft import dct, idct
from scipy.signal import lfilter
from tirelab.preprocessing.noise_model import MEAN_DRIFT, Noise, first_guess, noise_of

COUNT = 8000


def quiet(values):
    return noise_of(values, np.zeros(values.size), 0.0, np.ones(values.size, dtype=bool))


def test_white_noise_has_its_size_and_no_colour():
    noise = quiet(6.0 * np.random.default_rng(1).standard_normal(COUNT))
    # The standard deviation of 8000 draws is known to 0.8 %: four of those.
    assert noise.level == pytest.approx(6.0, rel=0.032)
    assert noise.correlation_samples < 1.3


def test_an_autoregression_is_whitened():
    # AR(1) with phi = 0.9: innovations of 2 N have a level of 2 / sqrt(1 - 0.81) = 4.59 N.
    values = lfilter([1.0], [1.0, -0.9], 2.0 * np.random.default_rng(2).standard_normal(COUNT))
    noise = quiet(values)
    assert noise.innovation == pytest.approx(2.0, rel=0.05)
    assert noise.level == pytest.approx(4.59, rel=0.1)
    white = noise.whitened(values)[20:]
    # The first autocorrelation of white noise is 0 within 1 / sqrt(8000): four of those.
    assert abs(float(white[1:] @ white[:-1]) / float(white @ white)) < 0.045
    # Variance of a long mean of AR(1) over that of white noise of its level: (1 + phi) / (1 - phi) = 19.
    assert noise.correlation_samples == pytest.approx(19.0, rel=0.25)


def test_lone_spikes_are_set_aside_and_long_ones_are_not():
    values = np.random.default_rng(3).standard_normal(COUNT)
    values[[100, 2000, 5000]] += 40.0
    values[6000:6050] += 40.0
    noise = quiet(values)
    assert np.all(noise.weight[[100, 2000, 5000]] == 0.0)
    assert np.mean(noise.weight[6002:6048]) > 0.9


def test_the_deflections_noise_widens_where_the_tire_is_stiff():
    rng = np.random.default_rng(4)
    through = np.where(np.arange(COUNT) < COUNT // 2, 0.0, 8.0)
    noise = noise_of(
        rng.standard_normal(COUNT) * np.hypot(6.0, through), through, 0.0, np.ones(COUNT, dtype=bool)
    )
    # sqrt(36 + 64) / 6, from a noise of the force that is itself estimated.
    assert noise.spread[-1] / noise.spread[0] == pytest.approx(10.0 / 6.0, rel=0.25)


def test_the_first_guess_does_not_see_a_smooth_misfit():
    smooth = 300.0 * np.sin(np.linspace(0.0, 20.0, COUNT))
    guess = first_guess(smooth + 5.0 * np.random.default_rng(5).standard_normal(COUNT))
    assert guess.level == pytest.approx(5.0, rel=0.06)


def test_the_mean_counts_only_as_far_as_it_does_not_drift():
    """The likelihood of a constant is that of the covariance I + w^2 1 1', written as a matrix and solved."""
    noise = Noise(6.0, 6.0, np.ones(1), np.ones(40), np.ones(40))
    values = 6.0 * np.random.default_rng(7).standard_normal(40) + 3.0
    covariance = 36.0 * np.eye(40) + (MEAN_DRIFT * 6.0) ** 2 * np.ones((40, 40))
    constant = np.full(40, 2.0)
    direction, part = noise.mean_drift
    for a, b in ((values, values), (values, constant), (constant, constant)):
        left, right = noise.whitened(a), noise.whitened(b)
        likelihood = left @ right - part * (direction @ left) * (direction @ right)
        assert likelihood == pytest.approx(a @ np.linalg.solve(covariance, b), rel=1e-9)


@pytest.mark.parametrize("gathered", [True, False])
def test_outliers_that_gather_under_the_largest_loads_are_no_spikes(gathered):
    rng = np.random.default_rng(8)
    load = 1000.0 + 1000.0 * np.sin(np.linspace(0.0, 40.0 * np.pi, COUNT))
    values = 6.0 * rng.standard_normal(COUNT)
    # Twenty lone readings of -60 N: one at the top of each cycle, or anywhere.
    tops = np.arange(100, COUNT, COUNT // 20)[:20]
    assert np.all(load[tops] > np.quantile(load, 0.95))
    out = tops if gathered else rng.choice(COUNT, 20, replace=False)
    values[out] = -60.0
    ones = np.ones(COUNT, dtype=bool)
    noise = noise_of(values, np.zeros(COUNT), 0.0, ones, load=load)
    assert np.all(noise.weight[out] == (1.0 if gathered else 0.0))


def test_spikes_are_counted():
    values = np.random.default_rng(9).standard_normal(COUNT)
    values[[100, 2000, 5000]] += 40.0
    assert quiet(values).spikes == 3


def test_a_noise_without_any_weight_has_no_drift():
    noise = Noise(6.0, 6.0, np.ones(1), np.ones(40), np.zeros(40))
    direction, part = noise.mean_drift
    assert part == 0.0
    assert not np.any(direction)


def test_columns_are_whitened_like_single_ones():
    values = lfilter([1.0], [1.0, -0.9], np.random.default_rng(10).standard_normal((COUNT, 2)), axis=0)
    noise = quiet(values[:, 0])
    for i in range(2):
        np.testing.assert_allclose(noise.whitened(values)[:, i], noise.whitened(values[:, i]), rtol=1e-12)


def test_samples_at_corners_of_the_motion_are_left_out_unless_most_are():
    values = np.random.default_rng(11).standard_normal(COUNT)
    for every, left_out in ((10, True), (2, False)):
        resolved = np.arange(COUNT) % every != 0
        noise = noise_of(values, np.zeros(COUNT), 0.0, resolved)
        assert np.all(noise.weight[~resolved][1:] == (0.0 if left_out else 1.0))


def test_a_fit_of_half_as_many_coefficients_has_taken_half_of_the_variance():
    # A projection onto COUNT / 2 columns leaves sigma^2 / 2: the cosines of every second frequency.
    values = 6.0 * np.random.default_rng(12).standard_normal(COUNT)
    spectrum = dct(values, norm="ortho")
    spectrum[::2] = 0.0
    left = idct(spectrum, norm="ortho")
    noise = noise_of(left, np.zeros(COUNT), COUNT / 2, np.ones(COUNT, dtype=bool))
    assert np.std(left) == pytest.approx(6.0 / np.sqrt(2.0), rel=0.03)
    assert noise.innovation == pytest.approx(6.0, rel=0.05)


def test_slow_noise_that_a_model_has_fitted_counts_in_the_level():
    # White noise of 1 N beside a relaxation of 1 N; the model has fitted the lowest frequencies.
    rng = np.random.default_rng(13)
    decay = np.exp(-1.0 / 100.0)
    slow = lfilter([np.sqrt(1.0 - decay**2)], [1.0, -decay], rng.standard_normal(COUNT))
    spectrum = dct(rng.standard_normal(COUNT) + slow, norm="ortho")
    leverage = np.where(np.arange(COUNT) < 60, 1.0, 0.0)
    left = idct(np.where(leverage > 0.0, 0.0, spectrum), norm="ortho")
    ones = np.ones(COUNT, dtype=bool)
    level = noise_of(left, np.zeros(COUNT), 60.0, ones, leverage).level
    assert np.std(left) < 1.15
    assert level == pytest.approx(np.sqrt(2.0), rel=0.1)


def test_most_samples_are_never_left_out():
    values = np.random.default_rng(14).standard_normal(200)
    # Three samples of four at a corner would leave a quarter; they are taken as resolved then.
    assert np.all(noise_of(values, np.zeros(200), 0.0, np.arange(200) % 4 == 0).weight == 1.0)
