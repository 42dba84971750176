"""A force read late: a pure delay, or a low-pass of first or second order."""

from __future__ import annotations

import numpy as np
from scipy.signal import cont2discrete, lfilter, lfilter_zi

from ..preprocessing.kinematics import FloatArray

QUALITY = 0.6
"""Of a low-pass of second order: between Bessel's, 1/sqrt(3), and Butterworth's, 1/sqrt(2)."""


def lagged(time: FloatArray, values: FloatArray, lag: float, stages: int) -> FloatArray:
    """Return `values` (n, k) read through a lag [s]: a pure delay, or a low-pass of the order `stages`, 1 or 2."""
    if lag <= 0.0:
        return values
    if stages == 0:
        step = float(np.median(np.diff(time)))
        whole = int(lag / step)
        part = lag / step - whole
        padded = np.concatenate([np.repeat(values[:1], whole + 1, axis=0), values])
        count = values.shape[0]
        return np.asarray((1.0 - part) * padded[1 : count + 1] + part * padded[:count])
    # A low-pass answers exactly to a signal linear between samples.
    step = float(np.median(np.diff(time)))
    poles = [lag, 1.0] if stages == 1 else [(QUALITY * lag) ** 2, lag, 1.0]
    above, below, _ = cont2discrete(([1.0], poles), step, method="foh")
    above = above.ravel()
    rest = lfilter_zi(above, below)[:, None] * values[:1]
    return np.asarray(lfilter(above, below, values, axis=0, zi=rest)[0])
