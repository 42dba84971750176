"""What the accepted set leaves of the recordings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drives import flat_force, read, ride
from radialtire import TireModel
from tirelab.diagnosis.errors_left import FittedData, left_by
from tirelab.diagnosis.held_out import validation_on
from tirelab.diagnosis.localization import Span
from tirelab.estimation.explanation import explain_misfit
from tirelab.preprocessing.samples import OF_TIME, raw_dataset_of
from tirelab.recordings.recording import Recording


@pytest.mark.parametrize("triangle", [True, False])
def test_the_acceleration_of_a_drive_at_one_rate_is_no_place(triangle: bool) -> None:
    """Five decimals of a millimetre; what smoothing leaves of them between the turns is no acceleration."""
    time = 0.01 * np.arange(6000)
    phase = time / 20.0 % 1.0
    x = 0.02 * (1.0 - np.abs(2.0 * phase - 1.0)) if triangle else 0.01 * (1.0 - np.cos(2.0 * np.pi * phase))
    recording = Recording("press", time, np.round(x, 8), np.full(time.size, np.inf), 1e5 * x)
    data = FittedData(TireModel(), [recording], [], raw_dataset_of([recording], TireModel()), [])
    assert ("acceleration" in data.unknown) is triangle
    places = [
        Span(by, 0.0, 1.0, "", "", None, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0) for by in ("rate", "acceleration")
    ]
    assert [place.by for place in data.shown(places)] == ["rate", "acceleration"][: 2 - triangle]


def test_without_measured_times_nothing_that_needs_them_is_shown() -> None:
    time, x, _ = ride(3)
    recording = replace(Recording("ride", time, x, np.full(time.size, np.inf), flat_force(x)), timed=False)
    data = FittedData(TireModel(), [recording], [], raw_dataset_of([recording], TireModel()), [])
    assert not data.timed
    assert data.unknown >= set(OF_TIME)


def test_the_errors_are_those_of_all_samples_and_a_ripple_stays_over_the_deflection() -> None:
    """Two rides of 4000 and 2000 samples, whose ripples of 25 and 40 N leave a root mean square of 22 N under 5 N of
    noise: sqrt((4000 x 25^2 + 2000 x 40^2) / 6000 / 2), where their deflection goes over whole waves.
    """
    recordings = []
    for name, size, ripple in (("long", 4000, 25.0), ("short", 2000, 40.0)):
        time, x, _ = (values[:size] for values in ride(5))
        force = flat_force(x) + ripple * np.sin(2.0 * np.pi * x / 0.0035)
        recordings.append(read(name, time, x, force, 6))
    tire, samples = TireModel(), raw_dataset_of(recordings, TireModel())
    residuals = [r.force - flat_force(r.deflection) for r in recordings]
    explanation = explain_misfit(recordings, tire, ["viscous_damping"], lambda stage: None).of(())
    data = FittedData(tire, recordings, [], samples, residuals)
    validation = validation_on(recordings, [], samples, residuals)(explanation)
    left = left_by(explanation, validation, data)
    assert left.fit.before == pytest.approx(np.sqrt(np.mean(np.concatenate(residuals) ** 2)), rel=1e-3)
    assert left.fit.noise == pytest.approx(5.0, rel=0.2)
    assert left.remainder.size * left.fit.noise == pytest.approx(22.0, rel=0.1)
    assert "deflection" in left.unexplained
    assert [model.by for model in left.models] == list(left.unexplained)
