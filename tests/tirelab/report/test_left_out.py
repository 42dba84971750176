"""An effect and the remainder's regressions as the page shows them."""

from __future__ import annotations

from typing import Any

import pytest
from tirelab.report.left_out import corrections, effect_shown

X = [0.0, 0.01, 0.02]


def effect(name: str, **more: Any) -> dict[str, Any]:
    return {"name": name, "share": 0.5, "parameters": {}, **more}


def test_a_parameter_has_value_interval_meaning_and_sketch() -> None:
    given = effect(
        "viscous_damping", size=12.3, parameters={"damping": {"value": 300.0, "std": 10.0, "unit": "N.s/m"}}
    )
    sketch = {"deflection": X, "force": X, "varied": {"damping": X}}
    shown = effect_shown(given, {"viscous_damping": sketch})
    ((name, value, interval, meaning, drawn),) = shown["parameters"]
    assert (name, value, interval) == ("damping", "300 ± 10 N·s/m", "280 to 320 N·s/m")  # 300 ± 1.96 * 10
    assert meaning
    assert "<svg" in drawn
    assert shown["size"] == "12.3"
    assert effect_shown(given, {})["parameters"][0][-1] == ""


def test_a_refitted_law_is_shown_by_a_and_b_and_not_by_their_logarithms() -> None:
    change = {"value": 0.1, "std": 0.01, "unit": "1"}
    law = [
        {
            "radius": "inf",
            "A": {"before": 500.0, "after": 552.6, "std": 5.5},
            "B": {"before": 1.4, "after": 1.41, "std": 0.01},
        }
    ]
    given = effect("recalibration", parameters={"log factor on A, flat": change, "bend": change}, law=law)
    shown = effect_shown(given, {})
    assert [row[0] for row in shown["parameters"]] == ["bend"]
    assert shown["law"][0]["surface"] == "flat ground"
    assert "not missing physics" in shown["statement"]


@pytest.mark.parametrize("several", [False, True])
def test_one_regression_or_many(several: bool) -> None:
    one = {"by": "deflection", "unit": "m", "x": X, "force": X, "repeats": "It repeats."}
    shown = corrections([one, {**one, "by": "rate", "unit": "m/s"}] if several else one)
    assert [c["by"] for c in shown] == ["the deflection", "the rate of deflection"][: 1 + several]
    assert "deflection [mm]" in shown[0]["picture"]
    assert corrections(None) == []
