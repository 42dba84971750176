"""Diagnoses by hand, for what is told of them first."""

from __future__ import annotations

from typing import Any


def diagnosis(
    sizes: dict[str, float | None], confidence: float = 0.95, load: float | None = 500.0, **more: Any
) -> dict[str, Any]:
    """A diagnosis in which each effect adds so many newtons."""
    fit = {"noise": 6.0, "before": 60.0, "after": 6.1, "held_out_before": 61.0, "held_out_after": 6.2}
    effects = [{"name": name, "share": 0.5, "size": size} for name, size in sizes.items()]
    verdict: dict[str, Any] = {"effects": effects, "confidence": confidence, "remainder": {"rms": 20.0}}
    verdict |= {"alternatives": [], "unexplained": False, "separating_test": None}
    return {
        "verdict": {**verdict, **{k: v for k, v in more.items() if k in verdict}},
        "fit": {**fit, "load": load, **{k: v for k, v in more.items() if k in fit}},
    }
