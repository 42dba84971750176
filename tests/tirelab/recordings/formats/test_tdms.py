"""The recording comes the same from TDMS, and what is none is refused."""

from pathlib import Path

import numpy as np
import pytest
from one_recording import DEFLECTION, FORCE, SAMPLES, TIME, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording


class TestTdms:
    @pytest.fixture
    def path(self, tmp_path: Path) -> Path:
        nptdms = pytest.importorskip("nptdms")
        clock = {"wf_increment": 0.01, "wf_start_offset": 0.0}
        with nptdms.TdmsWriter(tmp_path / "a.tdms") as writer:
            writer.write_segment(
                [
                    nptdms.ChannelObject(
                        "rig", "Stroke", DEFLECTION, properties={**clock, "unit_string": "mm"}
                    ),
                    nptdms.ChannelObject("rig", "Load", FORCE, properties={**clock, "unit_string": "kN"}),
                    nptdms.ChannelObject("rig", "Force (kN)", FORCE, properties={"wf_increment": 0.01}),
                    nptdms.ChannelObject("slow", "Slow", FORCE[::10], properties={"unit_string": "kN"}),
                    nptdms.ChannelObject(
                        "slow", "Late", FORCE, properties={"wf_increment": 0.02, "unit_string": "kN"}
                    ),
                    nptdms.ChannelObject("slow", "Clock", TIME, properties={"unit_string": "s"}),
                    nptdms.ChannelObject("slow", "Remark", ["a"] * SAMPLES),
                ]
            )
        return tmp_path / "a.tdms"

    @pytest.mark.parametrize("force", ["Load", "Force"])
    def test_channels_with_units_and_waveform_time(self, path: Path, force: str) -> None:
        columns = {"deflection": "Stroke", "force": force}
        recording = read_recording(path, columns=columns, radius="flat")
        np.testing.assert_allclose(recording.time, TIME, atol=1e-15)
        np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=3e-16)

    def test_time_in_a_channel(self, path: Path) -> None:
        columns = {"time": "Clock", "deflection": "Stroke", "force": "Load"}
        assert_the_recording(read_recording(path, columns=columns, radius="flat"))

    @pytest.mark.parametrize(
        ("force", "said"),
        [
            ("Slow", "unequal numbers"),
            ("Late", "start or step differently"),
            ("Remark", "holds text, 'a' the first"),
        ],
    )
    def test_other_channels_are_refused(self, path: Path, force: str, said: str) -> None:
        assert said in refusal(path, columns={"deflection": "Stroke", "force": force}, units={"force": "N"})


def test_units_as_labview_writes_them(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    clock = {"wf_increment": 0.01, "wf_start_offset": 0.0}
    channels = [("Stroke", DEFLECTION, "mm"), ("Load", FORCE, "kN")]
    with nptdms.TdmsWriter(tmp_path / "a.tdms") as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject("rig", n, v, {**clock, "NI_UnitDescription": unit})
                for n, v, unit in channels
            ]
        )
    recording = read_recording(tmp_path / "a.tdms", radius="flat")
    np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=3e-16)
    np.testing.assert_allclose(recording.deflection, DEFLECTION / 1000.0, rtol=3e-16)


@pytest.mark.parametrize(
    ("temperature", "step", "said"),
    [
        (FORCE[::10], 0.1, f"has {SAMPLES // 10} samples, the others {SAMPLES}"),
        (FORCE[::10], None, f"has {SAMPLES // 10} samples, the others {SAMPLES}"),
        (FORCE, 0.02, "starts or steps differently in time"),
    ],
)
def test_a_channel_that_can_be_done_without_is_left_out_where_it_was_recorded_apart(
    tmp_path: Path, temperature: np.ndarray, step: float | None, said: str
) -> None:
    nptdms = pytest.importorskip("nptdms")
    channels = [
        ("Temp", temperature, "degC", step),
        ("Stroke", DEFLECTION, "mm", 0.01),
        ("Load", FORCE, "kN", 0.01),
    ]
    with nptdms.TdmsWriter(tmp_path / "a.tdms") as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject(
                    "rig", n, v, {"unit_string": unit, **({} if dt is None else {"wf_increment": dt})}
                )
                for n, v, unit, dt in channels
            ]
        )
    recording = read_recording(tmp_path / "a.tdms", radius="flat")
    np.testing.assert_allclose(recording.time, TIME, atol=1e-15)
    np.testing.assert_allclose(recording.force, FORCE * 1000.0, rtol=3e-16)
    assert recording.temperature is None
    assert f"'Temp' not read: it {said}" in recording.notes
