"""Arrays beside time, deflection, force and radius."""

from __future__ import annotations

import datetime
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from house_form import loading, refusal
from tirelab.recordings.recording import Recording, RecordingError, read_recording

TIME, DEFLECTION_CM, FORCE = loading()
DEFLECTION = DEFLECTION_CM / 100.0


def test_channels_beside_the_force() -> None:
    beside = {
        "pressure": np.full(101, 2.5),
        "temperature": 20.0 + 0.01 * TIME,
        "speed": np.full(101, 36.0),
    }
    recording = Recording.from_arrays(
        *(TIME, DEFLECTION, FORCE, "flat"),
        **beside,
        believed_force=0.9 * FORCE,
        units={"pressure": "bar", "temperature": "degC", "speed": "km/h", "believed_force": "N"},
    )
    for name, values in (("pressure", 2.5e5), ("temperature", 293.15 + 0.01 * TIME), ("speed", 10.0)):
        np.testing.assert_allclose(getattr(recording, name), values, rtol=1e-12)
    np.testing.assert_array_equal(recording.believed_force, 0.9 * FORCE)
    plain = Recording.from_arrays(TIME, DEFLECTION, FORCE, "flat", pressure=np.full(101, 3e5), speed=None)
    assert plain.pressure is not None
    assert plain.pressure[0] == 3e5
    assert plain.speed is plain.temperature is plain.believed_force is None
    with pytest.raises(
        TypeError, match="unexpected keyword argument 'presure'; beside those of the signature"
    ):
        Recording.from_arrays(TIME, DEFLECTION, FORCE, "flat", presure=np.zeros(101))  # type: ignore[call-arg]
    with pytest.raises(RecordingError, match="pressure: is float, not one value per sample"):
        Recording.from_arrays(TIME, DEFLECTION, FORCE, "flat", pressure=3e5)


BEGIN = datetime.datetime(2025, 6, 3, 14, 5)


@pytest.mark.parametrize(
    ("of_time", "name"),
    [
        (lambda t: datetime.timedelta(seconds=t), "time"),
        (lambda t: BEGIN + datetime.timedelta(seconds=t), "time"),
        (lambda t: (BEGIN + datetime.timedelta(seconds=t)).time(), "time"),
        (lambda t: Decimal(f"{t:.3f}"), "time [s]"),
    ],
    ids=["durations", "dates", "times of day", "decimals"],
)
def test_times_that_a_frame_holds_as_objects(of_time: Callable[[float], Any], name: str) -> None:
    pandas = pytest.importorskip("pandas")
    times = [of_time(t) for t in TIME.tolist()]
    frame = pandas.DataFrame(
        {name: pandas.Series(times, dtype=object), "stroke [m]": DEFLECTION, "load [N]": FORCE}
    )
    np.testing.assert_allclose(Recording.from_dataframe(frame, radius="flat").time, TIME, atol=1e-6)
    if name == "time":
        found = Recording.from_arrays(times, DEFLECTION, FORCE, "flat")
        np.testing.assert_allclose(found.time, TIME, atol=1e-6)


@pytest.mark.parametrize("of_numpy", [np.float32, np.float64, np.int64])
def test_a_radius_of_any_library_of_numbers(of_numpy: Callable[[float], Any]) -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"time [s]": TIME, "stroke [m]": DEFLECTION, "load [N]": FORCE})
    found = Recording.from_dataframe(frame, radius=of_numpy(2.0))
    np.testing.assert_array_equal(found.surface_radius, np.full(TIME.size, 2.0))


@pytest.mark.parametrize("orient", ["split", "table"])
def test_a_frame_that_pandas_wrote_as_json(tmp_path: Path, orient: str) -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"stroke [m]": DEFLECTION, "load [N]": FORCE})
    clocks = {"index": TIME, "date": pandas.Timestamp(BEGIN) + pandas.to_timedelta(TIME, unit="s")}
    clocks |= {"duration": pandas.to_timedelta(TIME, unit="s")} if orient == "table" else {}
    for kind, clock in clocks.items():
        own = frame.set_index(pandas.Index(clock, name="time [s]" if kind == "index" else "time"))
        own = own if kind == "index" else own.reset_index()
        own.to_json(tmp_path / "a.json", orient=orient, date_format="iso", double_precision=15)
        if (orient, kind) == ("split", "index"):  # it keeps no name of an index
            assert "name it with --columns time=#1" in refusal(tmp_path / "a.json", radius="flat")
            continue
        np.testing.assert_allclose(read_recording(tmp_path / "a.json", radius="flat").time, TIME, atol=1e-6)
