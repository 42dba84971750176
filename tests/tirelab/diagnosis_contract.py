"""The contract of diagnosis.json, schema 2, written out by hand."""

from __future__ import annotations

import math
from typing import Any

from radialtire import CATALOGUE

NUMBER = (int, float)


def check_contract(content: Any) -> None:
    """Assert that a diagnosis has every entry of the contract, and no other."""
    top = {"schema", "verdict", "where", "fit", "tire", "corrected_fmu", "report", "data"}
    assert content.keys() == top | {"held_out_by", "baseline_tire", "corrected_tire"}
    assert content["schema"] == 2
    assert (content["tire"], content["corrected_fmu"], content["report"], content["data"]) == (
        "tire.json",
        "BicycleTire.fmu",
        "report.html",
        "plots.csv",
    )

    verdict = content["verdict"]
    keys = {"effects", "confidence", "alternatives", "unexplained", "summary", "separating_test"}
    assert verdict.keys() - {"corrections"} == keys | {
        "remainder",
        "doubted",
        "grounds",
        "alternative_details",
        "not_compared",
        "contradiction",
    }
    assert all(map(math.isfinite, verdict["grounds"].values()))
    assert len(verdict["alternative_details"]) == len(verdict["alternatives"])
    assert ("corrections" in verdict) == verdict["unexplained"]
    for effect in verdict["effects"]:
        own = {"name", "parameters", "share", "probability", "grounds", "in_baseline", "size"}
        assert effect.keys() - {"law"} == own
        assert all(map(math.isfinite, effect["grounds"].values()))
        assert 0.0 < effect["size"] < content["fit"]["load"]
        assert 0.0 <= effect["probability"] <= 1.0
        assert effect["name"] in {*CATALOGUE, "recalibration"}
        assert 0.0 <= effect["share"] <= 1.0
        for parameter in effect["parameters"].values():
            assert parameter.keys() == {"value", "std", "unit"}
            assert math.isfinite(parameter["value"])
            assert parameter["std"] is None or parameter["std"] >= 0.0
            assert isinstance(parameter["unit"], str)
    assert 0.0 <= verdict["confidence"] <= 1.0
    for names in verdict["alternatives"]:
        assert isinstance(names, list)
        assert all(isinstance(name, str) for name in names)
    assert isinstance(verdict["unexplained"], bool)
    assert verdict["remainder"].keys() == {"share", "size", "rms", "uncompared", "of_forms", "depends_on"}
    assert 0.0 <= verdict["remainder"]["share"] <= 1.0
    assert verdict["remainder"]["size"] >= 0.0
    assert verdict["remainder"]["rms"] >= 0.0
    assert 0.0 <= verdict["remainder"]["uncompared"] <= 1.0
    assert 0.0 <= verdict["remainder"]["of_forms"] <= 1.0
    for dependence in verdict["remainder"]["depends_on"]:
        assert dependence.keys() == {"by", "share", "from", "to"}
    assert isinstance(verdict["summary"], str)
    assert verdict["summary"]
    assert verdict["separating_test"] is None or isinstance(verdict["separating_test"], dict)

    for place in content["where"]:
        keys = {"by", "from", "to", "unit", "share", "mean_residual"}
        assert place.keys() - {"recording"} == keys | {"label", "samples", "chance", "size"}
        assert isinstance(place["by"], str)
        assert isinstance(place["unit"], str)
        assert all(
            isinstance(place[edge], NUMBER) or place[edge] in ("inf", "-inf") for edge in ("from", "to")
        )
        assert 0.0 <= place["share"] <= 1.0
        assert math.isfinite(place["mean_residual"])

    fit = content["fit"]
    errors = {
        "before",
        "after",
        "held_out_before",
        "held_out_after",
        "after_noise_free",
        "held_out_noise_free",
    }
    assert fit.keys() == {"noise", "load"} | errors
    for name, value in fit.items():
        assert (value is None and name.startswith("held_out")) or value >= 0.0
