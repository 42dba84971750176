"""Noise of the rig: its size, its colour, and the spectrum by which detectability is judged."""

import numpy as np
import pytest
from concealed.measurement import Instrument, drawn_instrument
from scipy.fft import dct

COLOURS = {
    "white": Instrument(white=5.0),
    "smoothed": Instrument(white=5.0, cut_off=0.2),
    "slow": Instrument(white=3.0, drifting=4.0, correlation_time=0.5),
    "pink": Instrument(white=3.0, pink=4.0),
    "hum": Instrument(white=3.0, hum=4.0, mains=50.0),
}


@pytest.mark.parametrize("instrument", COLOURS.values(), ids=COLOURS)
def test_the_rms_is_what_it_says(instrument: Instrument) -> None:
    """Over 40 recordings of 80 s: slow noise of 0.5 s has 80 independent parts in each, so 3 %."""
    draws = [instrument.force_error(np.random.default_rng(i), 8000, 0.01) for i in range(40)]
    assert np.sqrt(np.mean(np.square(draws))) == pytest.approx(5.0 if instrument.noise > 4 else 3.0, rel=0.03)
    assert instrument.noise == pytest.approx(5.0)


@pytest.mark.parametrize("instrument", COLOURS.values(), ids=COLOURS)
def test_the_spectrum_whitens_the_noise(instrument: Instrument) -> None:
    """Coefficients over their stated spread have a mean square of one, in every band of the spectrum."""
    spread = np.sqrt(instrument.spectrum(4000, 0.01, 0.0))
    draws = [instrument.force_error(np.random.default_rng(i), 4000, 0.01) for i in range(60)]
    squares = np.mean([(dct(d, norm="ortho") / spread) ** 2 for d in draws], axis=0)
    for band in np.array_split(squares[4:], 8):
        assert np.mean(band) == pytest.approx(1.0, abs=0.1)


def test_slow_noise_is_correlated_over_its_own_time() -> None:
    """Autocorrelation exp(-t/tau) of a first-order Markov process; 2000 correlation times give 5 %."""
    error = Instrument(white=0.0, drifting=4.0, correlation_time=0.5).force_error(
        np.random.default_rng(2), 100_000, 0.01
    )
    lagged = np.mean(error[:-50] * error[50:]) / np.mean(error**2)
    assert lagged == pytest.approx(np.exp(-1.0), abs=0.05)


def test_a_filter_leaves_little_above_its_cut_off() -> None:
    """Butterworth of order 2, bilinear: power gain 1 / (1 + r^4), r = tan(pi f / 2) / tan(pi c / 2); the mean over f is
    about 1.11 c. A hundredth is unfiltered.
    """
    cut_off, above = 0.1, 0.4
    error = Instrument(white=5.0, cut_off=cut_off).force_error(np.random.default_rng(4), 200_000, 0.01)
    power = np.abs(np.fft.rfft(error)) ** 2
    ratio = np.tan(0.5 * np.pi * above) / np.tan(0.5 * np.pi * cut_off)
    low = 0.99 / (1.11 * cut_off)
    expected = (0.01 + low / (1.0 + ratio**4)) / low
    assert np.mean(power[39_000:41_000]) / np.mean(power[:2000]) == pytest.approx(expected, rel=0.1)


def test_mains_hum_is_seen_where_sampling_folds_it() -> None:
    """50.3 Hz at 20 samples a second stands at 10 - |50.3 mod 20 - 10| = 9.7 Hz."""
    error = Instrument(white=0.0, hum=3.0, mains=50.3).force_error(np.random.default_rng(0), 2000, 0.05)
    frequencies = np.fft.rfftfreq(2000, 0.05)
    assert frequencies[np.argmax(np.abs(np.fft.rfft(error)))] == pytest.approx(9.7, abs=0.011)


def test_spikes_are_few_and_large() -> None:
    instrument = Instrument(white=1e-9, pink=0.0, quantum=12.0**0.5, spikes=4, spike_size=10.0)
    error = instrument.force_error(np.random.default_rng(1), 5000, 0.01)
    assert 1 <= np.sum(np.abs(error) > 4.9) <= 4


def test_the_converter_makes_steps() -> None:
    force = Instrument(white=1.0, quantum=0.5).converted(np.array([0.1, 0.26, 1.9]))
    assert force.tolist() == [0.0, 0.5, 2.0]


def test_every_error_is_there_or_not_at_random() -> None:
    drawn = [drawn_instrument(np.random.default_rng(i)) for i in range(200)]
    assert all(2.9 < i.noise < 12.2 for i in drawn)
    for part in ("drifting", "pink", "hum", "quantum", "spikes", "gauge", "cut_off"):
        share = np.mean([getattr(i, part) > 0 for i in drawn])
        assert 0.1 < share < 0.8, part
