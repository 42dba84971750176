"""Alternatives under what decides them, the likeliest first."""

from __future__ import annotations

from tirelab.report.alternatives_table import alternatives


def detail(difference: str, probability: float | None, reason: str, action: str) -> dict[str, object]:
    return {"difference": difference, "probability": probability, "reason": reason, "action": action}


def test_each_reason_stands_once_over_its_sets() -> None:
    details = [
        detail("+ inertia", 0.02, "one speed only", "repeat at 30 mm/s"),
        detail("+ series spring", 0.2, "no hold", "hold 10 s at 14 mm"),
        detail("+ force lag", None, "one speed only", "repeat at 30 mm/s"),
    ]
    hold, speed = alternatives({"effects": [], "alternatives": [], "alternative_details": details})
    assert hold == {
        "reason": "no hold.",
        "action": "Hold 10 s at 14 mm.",
        "sets": [("+ series spring", "20 %")],
    }
    assert speed["sets"] == [("+ inertia", "2 %"), ("+ force lag", "not seen")]


def test_sets_without_details_are_differences_all_the_same() -> None:
    verdict = {"effects": [{"name": "inertia"}], "alternatives": [["force_lag"], []]}
    (group,) = alternatives(verdict)
    assert group["sets"] == [("force lag instead of inertia", "not seen"), ("− inertia", "not seen")]
    assert (group["reason"], group["action"]) == ("", "")
