"""Recordings that cannot be diagnosed are refused with the reason; the least that can is not."""

from typing import Any

import numpy as np
import pytest
from radialtire import TireModel
from tirelab.preprocessing.data_checks import (
    FEWEST_SAMPLES,
    FEWEST_STEPS,
    PoorRecording,
    check_recordings,
    check_signal,
)
from tirelab.preprocessing.dataset import dataset_of
from tirelab.recordings.recording import Recording

TIME = np.arange(2000) * 0.01
DEFLECTION = 10e-3 * (1.0 - np.cos(2.0 * np.pi * 0.25 * TIME))
FORCE = 1e5 * DEFLECTION


def recording(**channels: np.ndarray) -> Recording:
    given: dict[str, Any] = {"time": TIME, "deflection": DEFLECTION, "force": FORCE, **channels}
    return Recording("a", surface_radius=np.full(len(given["time"]), np.inf), **given)


def refused(*recordings: Recording) -> str:
    with pytest.raises(PoorRecording) as caught:
        check_recordings(recordings)
    return str(caught.value)


def checked(level: float = 0.0, **channels: np.ndarray) -> None:
    """Check a good recording and one with these channels."""
    pair = [recording(), recording(**channels)]
    check_signal(dataset_of(pair, TireModel()), ["good.csv", "bad.csv"], [0.0, level])


def first(samples: int) -> dict[str, np.ndarray]:
    return {"time": TIME[:samples], "deflection": DEFLECTION[:samples], "force": FORCE[:samples]}


def test_a_good_recording_passes() -> None:
    check_recordings([recording(), recording(**first(FEWEST_SAMPLES))])
    checked()


def test_nothing_is_refused() -> None:
    assert refused() == "no recording was given; name at least one to diagnose"


@pytest.mark.parametrize(
    ("channels", "reason"),
    [
        (first(FEWEST_SAMPLES - 1), "has 99 samples; at least 100"),
        ({"deflection": np.full(2000, 0.01)}, "has one constant deflection"),
        ({"force": np.full(2000, 10.0)}, "has one constant force"),
        ({"deflection": DEFLECTION - 0.03}, "never loads the tire"),
        (
            {"deflection": np.where(TIME < 10.0, 0.0, 0.01)},
            f"has only 2 distinct deflections; sample each cycle at {FEWEST_STEPS} or more points",
        ),
    ],
)
def test_what_holds_no_cycle_is_refused(channels: dict[str, np.ndarray], reason: str) -> None:
    assert f"recording a {reason}" in refused(recording(), recording(**channels))


@pytest.mark.parametrize(
    ("channels", "reason"),
    [
        (
            {"deflection": 1e-3 * np.random.default_rng(1).standard_normal(2000)},
            "the deflection of recording bad.csv is noise",
        ),
        (
            {"force": np.random.default_rng(2).standard_normal(2000)},
            "does not follow its deflection (correlation",
        ),
        (
            {"deflection": 10e-3 * (1.0 - np.cos(2.0 * np.pi * 13.0 * TIME))},
            "recording bad.csv has about one sample per cycle",
        ),
    ],
)
def test_a_signal_without_a_tire_in_it_is_refused(channels: dict[str, np.ndarray], reason: str) -> None:
    with pytest.raises(PoorRecording) as caught:
        checked(**channels)
    assert reason in str(caught.value)


def test_a_force_that_follows_the_rate_for_the_most_part_is_a_tires() -> None:
    """Damping of ten times the spring's force leaves it a correlation of a tenth with the deflection."""
    rate = np.gradient(DEFLECTION, TIME)
    force = FORCE + 10.0 * float(np.std(FORCE)) / float(np.std(rate)) * rate
    assert abs(np.corrcoef(DEFLECTION, force)[0, 1]) < 0.2
    checked(force=force)


def test_a_force_that_is_noise_for_the_most_part_is_refused() -> None:
    checked(0.5 * float(np.std(FORCE)))
    with pytest.raises(
        PoorRecording, match=r"the force of recording bad\.csv does not follow its deflection"
    ):
        checked(float(np.std(FORCE)))


def test_a_force_that_relaxes_in_a_hold_is_not_refused() -> None:
    """A ramp of 1 s and 200 s of rest: over all samples the force falls while the sensor creeps on."""
    time = np.linspace(0.0, 201.0, 4000)
    deflection = np.where(time < 1.0, 0.03 * time, 0.03 + 1e-6 * (time - 1.0))
    force = 4e4 * deflection * np.where(time < 1.0, 1.0, 0.3 + 0.7 * np.exp(-(time - 1.0) / 20.0))
    assert np.corrcoef(force, deflection)[0, 1] < 0.2
    held = Recording("held.csv", time, deflection, np.full(4000, np.inf), force)
    check_signal(dataset_of([held], TireModel()), [held.name], [0.0])
