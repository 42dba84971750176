"""A gauge at the end of its travel is said, and no physics is made of it; what is short is not nothing."""

from __future__ import annotations

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from rivals import rivals
from tirelab.diagnosis.diagnose import diagnose
from tirelab.planning.menu import drive_of
from tirelab.planning.rig import Rig
from tirelab.recordings.recording import Recording
from tirelab.report import first_screen

TIRE = TireModel(PowerLaw(550.0, 1.42), tested_range=None)


def test_no_bottoming_is_made_of_a_clipped_reading() -> None:
    """Three cycles to 22 mm of exactly that tire, with 4 N of noise, through a gauge that ends at 19 mm."""
    rng = np.random.default_rng(1)
    time = np.linspace(0.0, 60.0, 1800)
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * time / 20.0))
    force = 550.0 * (100.0 * x) ** 1.42 + rng.normal(0.0, 4.0, time.size)
    reading = np.minimum(x, 0.019) + rng.normal(0.0, 5e-6, time.size)
    recording = Recording("clipped", time, reading, np.full(time.size, np.inf), force)
    verdict = diagnose(recording, TIRE, catalogue=rivals("bottoming"))
    assert verdict.names == ()
    assert "In clipped the deflection's reading stands still at 19 mm" in verdict.summary
    assert "record with more travel" in verdict.summary
    # 6 mm beyond the end would leave 400 N; what is compared leaves its noise alone, known to 3 % from 1200 samples.
    assert abs(verdict.fit.before - 4.0) < 0.5
    told = verdict.to_dict()
    assert first_screen.lead(told).startswith("Where the gauges follow")
    assert first_screen.next_step(told).why.endswith("record with more travel.")


@pytest.mark.slow
def test_noise_of_the_reading_is_nothing_unknown() -> None:
    """A mass of 15 kg through the corners of fast triangles, read with 6 um of noise.

    The tire in its FMU has to average that noise and follows the corners late; with the noise-free motion it does not.
    """
    rng = np.random.default_rng(3)
    recordings = []
    for waveform, radius in (("fast triangles", 0.254), ("small sines about two means", np.inf)):
        drive = drive_of(waveform, 0.25, radius, Rig(stroke=0.02, speed=0.2, surfaces=(radius,), time=60.0))
        x, time = drive.deflection, drive.time
        acceleration = np.gradient(np.gradient(x, time), time)
        force = 550.0 * (100.0 * x) ** 1.42 + 15.0 * acceleration + rng.normal(0.0, 6.0, time.size)
        reading = x + rng.normal(0.0, 6e-6, time.size)
        recordings.append(Recording(waveform, time, reading, drive.surface_radius, force))
    verdict = diagnose(recordings, TIRE, catalogue=rivals("inertia"))
    assert verdict.names == ("inertia",)
    assert verdict.fit.after > 1.5 * verdict.fit.noise > verdict.fit.left


@pytest.mark.slow
def test_a_short_disturbance_is_not_called_nothing() -> None:
    """20 cycles of exactly that tire with 4 N of noise; once, for 0.6 s of 200, a cable pulls with 20 N."""
    rng = np.random.default_rng(2)
    time = np.linspace(0.0, 200.0, 10_000)
    x = 0.011 * (1.0 - np.cos(2.0 * np.pi * time / 10.0))
    pulled = np.where((time > 81.0) & (time < 81.6), 20.0, 0.0)
    force = 550.0 * (100.0 * x) ** 1.42 + pulled + rng.normal(0.0, 4.0, time.size)
    reading = x + rng.normal(0.0, 1e-6, time.size)
    recording = Recording("pulled", time, reading, np.full(time.size, np.inf), force)
    verdict = diagnose(recording, TIRE, catalogue=rivals("force_drift"))
    assert verdict.names == ("unknown",)
    where = next(place for place in verdict.where if place.by == "time")
    assert 80.8 < where.start < 81.2
    assert 81.4 < where.stop < 81.8
