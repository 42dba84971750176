"""The facts of the recommended test in a reader's units."""

from __future__ import annotations

from tirelab.report.next_test import next_test


def test_facts_have_the_readers_units_and_what_is_not_there_is_left_out() -> None:
    test = {
        "waveform": "sweep",
        "surfaces": ["inf", -0.381],
        "amplitude": 0.022,
        "rate_max": 0.25,
        "separation": 210.0,
        "sentence": "Drive a sweep.",
    }
    shown = next_test(test, {"time": [0.0, 1.0, 2.0], "deflection": [0.0, 0.022, 0.0]})
    assert shown is not None
    assert dict(shown["facts"]) == {
        "Motion": "sweep",
        "Surface": "flat ground and concave, radius 38.1 cm",
        "Largest deflection": "22.0 mm",
        "Fastest rate": "250 mm/s",
        "Predicted difference": "210 times the noise, over all samples",
    }
    assert "deflection [mm]" in shown["picture"]
    assert next_test(None, None) is None
