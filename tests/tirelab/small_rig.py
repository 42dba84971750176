"""A small rig and few effects, so that a plan takes seconds."""

import pytest
import tirelab.planning.responses as responses
from tirelab.planning.rig import Rig

RIG = Rig(stroke=0.02, speed=0.1, time=40.0, sampling=0.01, noise=5.0)

EFFECTS = ("viscous_damping", "rate_independent_hysteresis", "force_drift")


def few_effects(monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...] = EFFECTS) -> None:
    monkeypatch.setattr(responses, "candidates", lambda: names)


def silent(sentence: str) -> None:
    pass
