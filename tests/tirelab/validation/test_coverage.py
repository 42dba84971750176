"""The command that counts intervals: its drawn responses are what it says, and a wrong interval is counted as one."""

from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner
from radialtire import TireModel
from tirelab.simulation.simulate import simulate
from tirelab.validation import coverage
from tirelab.validation.coverage import NOISE, covered, driven, main, wave


def test_a_drive_is_the_baseline_tire_under_the_stated_noise() -> None:
    recording = driven(np.random.default_rng(1))
    left = recording.force - simulate(TireModel(), recording)
    # The deflection's micrometre adds 0.1 N at 100 kN/m.
    assert np.std(left) == pytest.approx(NOISE, rel=0.03)
    rate = np.abs(np.gradient(recording.deflection, recording.time))
    assert np.median(rate[4600:5400]) < 1e-3 < np.median(rate[3000:4400])


def test_a_form_error_has_the_mean_square_one_and_is_smooth() -> None:
    recording = driven(np.random.default_rng(2))
    values = wave(recording, np.random.default_rng(3))
    assert np.mean(values**2) == pytest.approx(1.0)
    # At most three turns over deflection and time together on each way.
    assert np.abs(np.diff(values)).max() < 0.2


def test_one_draw_names_its_parameters_and_how_far_off_they_are() -> None:
    found = covered(6, 0)
    assert found
    assert all(np.isfinite(z) for _, z in found)
    assert len({name.split(":")[0] for name, _ in found}) == 1


def test_an_interval_that_is_too_narrow_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def drawn(seed: int, number: int) -> list[tuple[str, float]]:
        return [("spring: k", 0.5), ("damper: c", 4.0 if number else 0.1)]

    def inline(function: object, tasks: dict[str, tuple[int, int]], *more: object) -> object:
        return [type("Done", (), {"key": k, "value": drawn(*t), "error": None})() for k, t in tasks.items()]

    monkeypatch.setattr(coverage, "work", inline)
    said = CliRunner().invoke(main, ["--seed", "1", "--draws", "2"]).output
    assert "3 of 4 intervals" in said
    assert "damper: c: 1 of 2, largest 4.0 standard errors" in said
    assert "spring" not in said
