"""A force read late: a pure delay, or a chain of equal first-order stages."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from .motion import FloatArray


def lagged(time: FloatArray, values: FloatArray, lag: float, stages: int) -> FloatArray:
    """Return `values` (n, k) read through a lag [s]: a pure delay, or `stages` equal first-order stages."""
    if lag <= 0.0:
        return values
    if stages == 0:
        step = float(np.median(np.diff(time)))
        whole = int(lag / step)
        part = lag / step - whole
        padded = np.concatenate([np.repeat(values[:1], whole + 1, axis=0), values])
        count = values.shape[0]
        return np.asarray((1.0 - part) * padded[1 : count + 1] + part * padded[:count])
    # Each stage answers exactly to a signal linear between samples.
    step = float(np.median(np.diff(time)))
    ratio = step * stages / lag
    decay = np.exp(-ratio)
    gain = -np.expm1(-ratio) / ratio
    for _ in range(stages):
        values, _ = lfilter([1.0 - gain, gain - decay], [1.0, -decay], values, axis=0, zi=gain * values[:1])
    return np.asarray(values)
