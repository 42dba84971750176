"""Presses of a tire on one surface, which the tests of identification read."""

from __future__ import annotations

import math

import numpy as np
from radialtire import TireModel
from tirelab.article import press as rig
from tirelab.recordings.recording import Recording

ARTICLE = TireModel()


def on(radius: float, deflection: np.ndarray, force: np.ndarray, name: str = "press") -> Recording:
    time = np.arange(deflection.size) / 5.0
    return Recording(name, time, deflection, np.full(deflection.size, radius), force)


def triangle(
    radius: float = math.inf, tire: TireModel = ARTICLE, noise: float = 0.0, seed: int = 0
) -> Recording:
    return rig.record(tire, radius, noise=rig.ForceNoise(noise, seed=(seed,)))
