"""Mains hum in a reading: one steady line at the frequency of the mains, folded by the sampling."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len, rfft

FloatArray = NDArray[np.float64]

MAINS, DEVIATION = (50.0, 60.0), 0.2
"""Frequencies of the mains [Hz], and by how much they deviate at most in steady state: Commission Regulation (EU)
2017/1485, Annex III, for Continental Europe; those of 60 Hz deviate less."""

FEWEST_BINS, PADDED = 20, 8
"""Fewest neighbouring independent frequencies among which a line is looked for, and how many times as fine they are
computed: a line between two of them then loses less than a fiftieth of its power."""


def mains_hum(values: FloatArray, interval: float, slowest: float, chance: float) -> FloatArray:
    """Return the hum of the mains in values (n,) with an interval [s] between them; zeros where there is none.

    slowest: period, in samples, of the slowest line that may be one: the motion has slower ones of its own
    chance: with which white noise shows a line of the same part of the power of its neighbourhood (R. A. Fisher, Proc.
    R. Soc. A 125 (1929) 54-59). None where the sampling is so slow that by this chance any line folds to the mains.
    """
    rate, hum = 1.0 / interval, np.zeros(values.size)
    if 2.0 * DEVIATION * len(MAINS) > chance * 0.5 * rate:
        return hum
    centred, length = values - values.mean(), next_fast_len(PADDED * values.size, real=True)
    power, step = np.abs(rfft(centred, length)) ** 2, rate / length
    slowest_bin, strongest = int(np.ceil(rate / (slowest * step))), 0.0
    for mains in MAINS:
        folded = abs(mains - rate * round(mains / rate)) / step
        half = max(DEVIATION / step, 0.5 * PADDED * FEWEST_BINS)
        at = np.arange(max(int(np.ceil(folded - half)), 0), min(int(folded + half) + 1, power.size))
        beside = power[at]
        may = (np.abs(at - folded) <= DEVIATION / step + 0.5 * PADDED) & (at >= slowest_bin)
        if not np.any(beside[may]):
            continue
        peak = int(np.argmax(np.where(may, beside, 0.0)))
        independent, share = at.size / PADDED, beside[peak] * PADDED / beside.sum()
        by_chance = len(MAINS) * at.size * max(1.0 - share, 0.0) ** (independent - 1.0)
        if by_chance < chance and beside[peak] > strongest:
            strongest = float(beside[peak])
            hum = _line(centred, 2.0 * np.pi * float(at[peak]) / length)
    return hum


def _line(values: FloatArray, phase: float) -> FloatArray:
    """Return the sine in values (n,) by least squares; phase [rad]: from one sample to the next, nearly."""
    at = np.arange(values.size) - 0.5 * (values.size - 1)
    waves = np.column_stack([np.cos(phase * at), np.sin(phase * at)])
    # Waves that grow along the recording are what another frequency differs by, to the first order.
    waves = np.column_stack([waves, waves * (at / values.size)[:, None]])
    return np.asarray(waves @ np.linalg.lstsq(waves, values, rcond=None)[0])
