"""Random ground against the standard: the spectrum of its heights, estimated with Welch's method."""

import numpy as np
import pytest
from scipy.signal import welch
from tirelab.errors import TirelabError
from tirelab.terrain import iso8608
from tirelab.terrain.iso8608 import spectral_density

# ISO 8608, table C.1 of 2016: geometric means of Gd(n0), in 1e-6 m^3.
STANDARD = {"A": 16, "B": 64, "C": 256, "D": 1024, "E": 4096, "F": 16384, "G": 65536, "H": 262144}


@pytest.mark.parametrize(("road_class", "mean"), STANDARD.items())
def test_classes_of_the_standard(road_class: str, mean: int) -> None:
    density = spectral_density([0.1, 1.0], road_class)
    np.testing.assert_allclose(density, [mean * 1e-6, mean * 1e-8], rtol=1e-12)


@pytest.mark.parametrize("road_class", ["A", "D", "F"])
def test_spectrum_of_the_heights(road_class: str) -> None:
    profile = iso8608(road_class, 4000.0, seed=7, spacing=0.02)
    frequency, density = welch(profile.z, 1.0 / (profile.s[1] - profile.s[0]), "hann", nperseg=10_000)
    for low in 0.08 * 2.0 ** np.arange(7):
        octave = (frequency >= low) & (frequency < 2.0 * low)
        ratio = np.mean(density[octave] / spectral_density(frequency[octave], road_class))
        # 39 half-overlapping segments and 16 bins in the first octave: about 6 %; leakage of n^-2 adds a few per cent.
        assert ratio == pytest.approx(1.0, abs=0.2 if low < 0.1 else 0.1)


def test_heights_have_the_variance_of_the_band() -> None:
    # Integral of Gd from 0.05 to 10 cycle/m: 256e-6 m^3 x 0.1^2 x (1/0.05 - 1/10) m.
    expected = np.sqrt(256e-6 * 0.01 * (20.0 - 0.1))
    assert np.std(iso8608("C", 2000.0, seed=3).z) == pytest.approx(expected, rel=0.05)


def test_nothing_outside_the_band() -> None:
    profile = iso8608("E", 1000.0, seed=5)
    frequency, density = welch(profile.z, 1.0 / (profile.s[1] - profile.s[0]), "hann", nperseg=20_000)
    # Above the band only the window's leakage is left.
    assert np.max(density[frequency > 10.5]) < 1e-6 * spectral_density(10.0, "E")


def test_a_seed_gives_the_same_ground_and_another_a_different_one() -> None:
    first, again, other = (iso8608("D", 50.0, seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.z, again.z)
    assert np.max(np.abs(first.z - other.z)) > 0.01


def test_short_ground_is_not_periodic() -> None:
    profile = iso8608("D", 20.0, seed=1)
    assert profile.length == pytest.approx(20.0)
    assert abs(profile.z[-1] - profile.z[0]) > 1e-3


@pytest.mark.parametrize(
    ("road_class", "length", "seed", "spacing", "sentence"),
    [
        ("I", 50.0, 1, 0.01, "knows no class 'I'; choose one of A, B, C"),
        ("D", 50.0, -1, 0.01, "seed -1"),
        ("D", 50.0, 1, 0.05, "give at most 0.025 m"),
        ("D", 50.0, 1, np.nan, "give at most 0.025 m"),
        ("D", 0.0, 1, 0.01, "length 0 m"),
    ],
)
def test_bad_wishes(road_class: str, length: float, seed: int, spacing: float, sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence):
        iso8608(road_class, length, seed, spacing)
