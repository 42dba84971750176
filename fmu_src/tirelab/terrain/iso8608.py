"""Random ground with the spectrum that ISO 8608 gives its road classes.

    Gd(n) = Gd(n0) (n / n0)^-w,    n0 = 0.1 cycle/m, w = 2

Gd [m^3] is the one-sided power spectral density of the height over the spatial frequency n [cycle/m]. The classes A
(very good) to H differ by Gd(n0), whose geometric means are 4^k x 10^-6 m^3: 16, 64, 256, 1024, 4096, 16384, 65536,
262144.

Reference: ISO 8608:2016, Mechanical vibration - Road surface profiles - Reporting of measured data; its notes give
0.05 cycle/m as the lower limit for off-road vehicles and 10 cycle/m as the upper one, above which the tire envelops
what is left.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..errors import TirelabError
from .profile import Floats, Profile, grid

REFERENCE_FREQUENCY = 0.1
"""n0 [cycle/m]."""

WAVINESS = 2.0
"""w [1]."""

LOWEST_FREQUENCY = 0.05
HIGHEST_FREQUENCY = 10.0
"""Band [cycle/m] of the standard's notes for off-road vehicles and for what a tire envelops."""

GEOMETRIC_MEAN = {road_class: 4.0**k * 1e-6 for k, road_class in enumerate("ABCDEFGH", start=2)}
"""Gd(n0) [m^3] of each class."""

SHORTEST_PERIOD = 10.0 / LOWEST_FREQUENCY
"""Ground is drawn at least this long [m] and then cut, so that the longest waves differ from draw to draw."""


def spectral_density(frequency: ArrayLike, road_class: str) -> Floats:
    """Return Gd [m^3] of `road_class` ('A' to 'H') at the spatial `frequency` [cycle/m] > 0."""
    density: Floats = (
        _geometric_mean(road_class)
        * (np.asarray(frequency, dtype=np.float64) / REFERENCE_FREQUENCY) ** -WAVINESS
    )
    return density


def iso8608(road_class: str, length: float, seed: int, spacing: float = 0.01) -> Profile:
    """Return `length` [m] of random ground of `road_class` ('A' to 'H'), the same for the same `seed`.

    Sum of harmonics of random phase, z = sum sqrt(2 Gd(n_k) dn) cos(2 pi n_k s + phi_k), over the band 0.05 to
    10 cycle/m. spacing: distance of points [m], at most 0.025 (four points on the shortest wave).
    """
    mean = _geometric_mean(road_class)
    if not 0.0 < spacing <= 0.25 / HIGHEST_FREQUENCY:
        raise TirelabError(
            f"ISO 8608 ground with a point every {spacing:g} m; the shortest wave is {1 / HIGHEST_FREQUENCY:g} m, give "
            f"at most {0.25 / HIGHEST_FREQUENCY:g} m"
        )
    if seed < 0:
        raise TirelabError(f"ISO 8608 ground with the seed {seed}; give a whole number of 0 or more")
    s = grid(length, spacing)
    step = s[1]
    points = max(s.size, round(np.ceil(SHORTEST_PERIOD / step)))
    frequency = np.fft.rfftfreq(points, step)
    band = (frequency >= LOWEST_FREQUENCY) & (frequency <= HIGHEST_FREQUENCY)
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, int(np.count_nonzero(band)))
    amplitude = np.sqrt(2.0 * spectral_density(frequency[band], road_class) * frequency[1])
    spectrum = np.zeros(frequency.size, dtype=np.complex128)
    spectrum[band] = 0.5 * points * amplitude * np.exp(1j * phase)
    z = np.fft.irfft(spectrum, points)[: s.size]
    return Profile(
        s,
        z,
        f"ISO 8608 class {road_class.upper()}, seed {seed}",
        notes=(f"random ground with Gd(0.1 cycle/m) = {mean * 1e6:g}e-6 m^3 between 0.05 and 10 cycle/m",),
    )


def _geometric_mean(road_class: str) -> float:
    try:
        return GEOMETRIC_MEAN[road_class.upper()]
    except KeyError:
        raise TirelabError(
            f"ISO 8608 knows no class '{road_class}'; choose one of {', '.join(GEOMETRIC_MEAN)}"
        ) from None
