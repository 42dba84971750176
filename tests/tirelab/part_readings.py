"""Readings of parts, each made by one of the laws that are compared."""

from __future__ import annotations

import numpy as np
from tirelab.recordings.recording import Recording

X = np.linspace(0.0, 0.02, 600)
"""[m]."""


BOTH = np.linspace(-0.02, 0.02, 900)


def recording(x: np.ndarray, force: np.ndarray, noise: float = 2.0, **more: np.ndarray) -> Recording:
    read = force + noise * np.random.default_rng(8).standard_normal(x.size)
    return Recording("part", np.arange(x.size) / 50.0, x, np.full(x.size, np.inf), read, **more)


MADE = {
    "constant": (BOTH, np.full(BOTH.size, 85.0), {"F0": 85.0}),
    "linear": (BOTH, 15.0 + 40e3 * BOTH, {"F0": 15.0, "k": 40.0}),
    "linear_gap": (X, 90e3 * np.maximum(X - 0.004, 0.0), {"k": 90.0, "x0": 4.0}),
    "power": (BOTH, 700.0 * np.sign(BOTH) * np.abs(100.0 * BOTH) ** 1.45, {"A": 700.0, "B": 1.45}),
    "power_preload": (
        BOTH,
        120.0 + 700.0 * np.sign(BOTH) * np.abs(100.0 * BOTH) ** 1.6,
        {"F0": 120.0, "A": 700.0, "B": 1.6},
    ),
    "power_gap": (
        X,
        700.0 * np.maximum(100.0 * (X - 0.003), 0.0) ** 1.45,
        {"A": 700.0, "B": 1.45, "x0": 3.0},
    ),
    "polynomial": (
        BOTH,
        20.0 + 30e3 * BOTH - 4e5 * BOTH**2 + 8e7 * BOTH**3,
        {"F0": 20.0, "k1": 30.0, "k2": -0.4, "k3": 0.08},
    ),
    "piecewise": (BOTH, np.interp(BOTH, [-0.02, -0.012, 0.004, 0.02], [-300.0, 0.0, 0.0, 900.0]), {}),
}
