"""What was left out: each effect with its parameters or the refitted law, and the remainder's regressions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from radialtire import CATALOGUE

from ..names import REFITTED_LAW
from . import titles, words
from .look_alikes import look_alike_of
from .sketches import draw_correction, draw_sketch


def effect_shown(
    effect: Mapping[str, Any], sketches: Mapping[str, Any], kind: str = "tire"
) -> dict[str, Any]:
    """Return an entry of the verdict's effects in words, each parameter with its sketch where there is one.

    kind: what is tested, "tire" or "part"
    """
    name = effect["name"]
    known = CATALOGUE.get(name)
    sketch = sketches.get(name)
    return {
        "title": titles.full_title(name),
        "size": words.number(effect.get("size")) if effect.get("size") is not None else "",
        "statement": words.LAW_STATEMENT if name == REFITTED_LAW else "",
        "tell_tale": known.tell_tale if known else "",
        "imitators": titles.listed([titles.short_title(n) for n in known.imitators]) if known else "",
        "look_alike": look_alike_of(name),
        "source": known.source if known else "",
        "share": effect["share"],
        "law": [words.law_row(row, kind) for row in effect.get("law", [])],
        "sketched": sketch is not None,
        "parameters": [
            (
                titles.effect_title(parameter),
                words.estimate(e["value"], e["std"], e["unit"]),
                words.interval(e["value"], e["std"], e["unit"], words.bounds(name, parameter)),
                words.meaning(name, parameter),
                draw_sketch(sketch, parameter) if sketch else "",
            )
            for parameter, e in effect["parameters"].items()
            if not ("law" in effect and words.is_of_a_surface(parameter))
        ],
    }


def corrections(found: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None) -> list[dict[str, Any]]:
    """Return the regressions of the remainder with their pictures."""
    corrections = [found] if isinstance(found, Mapping) else list(found or [])
    shown = []
    for i, c in enumerate(corrections):
        by = titles.dependence(c["by"])
        picture = draw_correction(
            by.removeprefix("the "), c["unit"], c["x"], c["force"], c.get("std"), f"c{i}x"
        )
        shown.append({"by": by, "repeats": c["repeats"], "picture": picture})
    return shown
