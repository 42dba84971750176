"""Arrays beside time, deflection, force and radius."""

from __future__ import annotations

import numpy as np
import pytest
from house_form import loading
from tirelab.recordings.recording import Recording, RecordingError

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
