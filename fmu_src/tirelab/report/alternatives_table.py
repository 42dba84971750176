"""The alternative models: as differences from the verdict, under what decides."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import titles, words


def alternatives(verdict: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The alternatives by their reasons, each of them once: what decides, and the sets as differences."""
    names = [effect["name"] for effect in verdict["effects"]]
    details = verdict.get("alternative_details") or [
        {"difference": titles.difference(names, other), "probability": None, "reason": "", "action": ""}
        for other in verdict["alternatives"]
    ]
    groups: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for d in words.likeliest(details):
        chance = "not seen" if d["probability"] is None else words.percent(d["probability"])
        groups.setdefault((d["reason"], d["action"]), []).append((d["difference"], chance))
    return [
        {"reason": f"{reason}." if reason else "", "action": words.sentence(action), "sets": sets}
        for (reason, action), sets in groups.items()
    ]
