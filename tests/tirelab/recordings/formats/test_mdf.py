"""The recording comes the same from MDF4, and what is none is refused."""

from pathlib import Path

import numpy as np
import pytest
from one_recording import DEFLECTION, FORCE, SAMPLES, TIME, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording


class TestMdf:
    @pytest.fixture
    def path(self, tmp_path: Path) -> Path:
        asammdf = pytest.importorskip("asammdf")
        signal = asammdf.Signal
        slow = slice(None, None, 10)
        with asammdf.MDF(version="4.10") as mdf:
            invalid = np.arange(SAMPLES) == 8
            mdf.append(
                [
                    signal(DEFLECTION, TIME, unit="mm", name="Stroke"),
                    signal(FORCE, TIME, unit="kN", name="Load"),
                    signal(FORCE, TIME, unit="kN", name="Flagged", invalidation_bits=invalid),
                ]
            )
            mdf.append([signal(FORCE[slow], TIME[slow], unit="kN", name="Slow")])
            mdf.append([signal(FORCE, TIME + 0.005, unit="kN", name="Late")])
            mdf.append([signal(FORCE, TIME, name="Stroke")])
            mdf.save(tmp_path / "a.mf4")
        return tmp_path / "a.mf4"

    def test_channels_with_the_units_and_the_time_of_the_file(self, path: Path) -> None:
        columns = {"deflection": "0/Stroke", "force": "Load"}
        assert_the_recording(read_recording(path, columns=columns, radius="flat"))

    def test_samples_marked_invalid_are_blanks(self, path: Path) -> None:
        recording = read_recording(
            path, columns={"deflection": "0/Stroke", "force": "Flagged"}, radius="flat"
        )
        assert len(recording) == SAMPLES - 1
        assert "skipped for want of force: sample 9" in recording.notes

    @pytest.mark.parametrize(
        ("force", "said"), [("Slow", "unequal numbers"), ("Late", "sampled at different times")]
    )
    def test_channels_of_other_times_are_not_resampled(self, path: Path, force: str, said: str) -> None:
        assert said in refusal(path, columns={"deflection": "0/Stroke", "force": force})

    def test_a_channel_that_can_be_done_without_is_left_out_instead(self, tmp_path: Path) -> None:
        asammdf = pytest.importorskip("asammdf")
        with asammdf.MDF(version="4.10") as mdf:
            mdf.append([asammdf.Signal(FORCE[::10], TIME[::10], unit="degC", name="Temperature")])
            mdf.append(
                [
                    asammdf.Signal(DEFLECTION, TIME, unit="mm", name="Stroke"),
                    asammdf.Signal(FORCE, TIME, unit="kN", name="Load"),
                ]
            )
            mdf.save(tmp_path / "b.mf4")
        recording = read_recording(tmp_path / "b.mf4", radius="flat")
        np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=3e-16)
        assert recording.temperature is None
        assert "'Temperature' not read: it was sampled at different times" in recording.notes
