"""An effect and the remainder's regressions as the page shows them."""

from __future__ import annotations

from typing import Any

import pytest
from tirelab.report.left_out import corrections, effect_shown
from tirelab.report.shape_sketch import shape_sketch

X = [0.0, 0.01, 0.02]


def effect(name: str, **more: Any) -> dict[str, Any]:
    return {"name": name, "share": 0.5, "parameters": {}, **more}


def test_a_parameter_has_value_interval_meaning_and_sketch() -> None:
    given = effect(
        "viscous_damping", size=12.3, parameters={"damping": {"value": 300.0, "std": 10.0, "unit": "N.s/m"}}
    )
    sketch = {"deflection": X, "force": X, "varied": {"damping": [1.5 * x for x in X]}}
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
    assert effect_shown(given, {}, "part")["law"][0]["surface"] == "the part"
    assert "not missing physics" in shown["statement"]
    of_curve = effect_shown({**given, "law": []}, {})
    assert [row[0] for row in of_curve["parameters"]] == ["bend"]
    assert of_curve["law"] == []


def test_a_sketch_that_would_show_one_curve_says_so() -> None:
    given = effect(
        "rate_independent_hysteresis",
        parameters={p: {"value": 1.0, "std": 0.7, "unit": "1"} for p in ("seat", "rebound")},
    )
    curves = {"seat": [1.01 * x for x in X], "rebound": [1.3 * x for x in X]}
    shown = effect_shown(
        given, {"rate_independent_hysteresis": {"deflection": X, "force": X, "varied": curves}}
    )
    drawn = {row[0]: str(row[-1]) for row in shown["parameters"]}
    assert drawn["seat"] == "too small to draw"
    assert "<svg" in drawn["rebound"]
    # seat lies between its bounds, whatever the deviation
    assert {row[0]: row[2] for row in shown["parameters"]}["seat"].endswith(" to 1.00")


def test_bend_and_twist_have_a_sketch() -> None:
    change = {"value": 0.02, "std": 0.01, "unit": "1"}
    twisted = {"value": -0.9, "std": 0.2, "unit": "1"}
    row = {
        "radius": "inf",
        "A": {"before": 500.0, "after": 550.0, "std": 5.5},
        "B": {"before": 1.4, "after": 1.4, "std": 0.01},
    }
    given = effect("recalibration", parameters={"bend": change, "twist": twisted}, law=[row])
    shape = {"bend": 0.02, "twist": -0.05, "reference": 0.0125}
    diagnosis = {
        "verdict": {"effects": [given]},
        "corrected_tire": {"effects": [{"name": "elastic_shape", "parameters": shape}]},
        "law_changes": [{"radius": "inf", "deflection": [0.0, 0.025], "difference": [0.0, 1.0]}],
    }
    sketch = shape_sketch(diagnosis)
    curve = sketch["recalibration"]
    # at twice the reference, by hand: 550 2.5^1.4 (exp(0.02 ln(2)^2 - 0.05 ln(2)^3) - 1)
    assert curve["force"][-1] == pytest.approx(-13.92, abs=0.005)
    assert curve["force"][0] == 0.0
    shown = effect_shown(given, sketch)
    assert all("<svg" in str(row[-1]) for row in shown["parameters"])
    assert shown["parameters"][1][2].startswith("−1.00 to ")  # the least that is allowed
    assert shape_sketch({**diagnosis, "corrected_tire": {"effects": []}}) == {}


@pytest.mark.parametrize("several", [False, True])
def test_one_regression_or_many(several: bool) -> None:
    one = {"by": "deflection", "unit": "m", "x": X, "force": X, "repeats": "It repeats."}
    shown = corrections([one, {**one, "by": "rate", "unit": "m/s"}] if several else one)
    assert [c["by"] for c in shown] == ["the deflection", "the rate of deflection"][: 1 + several]
    assert "deflection [mm]" in shown[0]["picture"]
    assert corrections(None) == []
