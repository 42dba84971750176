"""A recording of another tire among others is named."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording

TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)


def pressed(name: str, coefficient: float, seed: int) -> Recording:
    """Three cycles on the flat of a tire F = A x^1.42, with 4 N of noise."""
    time = np.linspace(0.0, 60.0, 900)
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * time / 20.0))
    noise = np.random.default_rng(seed).normal(0.0, 4.0, time.size)
    return Recording(name, time, x, np.full(time.size, np.inf), coefficient * (100.0 * x) ** 1.42 + noise)


def test_the_one_of_another_tire_is_named() -> None:
    several = [pressed("a", 550.0, 1), pressed("b", 550.0, 2), pressed("soft", 440.0, 3)]
    summary = diagnose(several, TIRE).summary
    assert "Recording soft contradicts the others" in summary
    # A fifth of 550 x^1.42 at up to 2.2 cm: a root mean square of about 160 N.
    assert "it is 1" in summary


def test_of_two_nobody_can_tell_which() -> None:
    summary = diagnose([pressed("a", 550.0, 1), pressed("soft", 440.0, 3)], TIRE).summary
    assert "Recordings a and soft contradict each other" in summary


@pytest.mark.parametrize("coefficient", [550.0, 440.0])
def test_recordings_of_one_tire_do_not_contradict_each_other(coefficient: float) -> None:
    several = [pressed("a", coefficient, 1), pressed("b", coefficient, 2)]
    assert "contradict" not in diagnose(several, TIRE).summary
