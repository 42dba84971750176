"""The recommended next test: its facts and its motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import titles, words
from .sketches import draw_waveform

FACTS = (  # key of diagnosis.json, title, unit, and what stands in place of the unit
    ("waveform", "Motion", "", ""),
    ("surfaces", "Surface", "", ""),
    ("begins_at", "Least deflection", "m", ""),
    ("amplitude", "Largest deflection", "m", ""),
    ("rate_max", "Fastest rate", "m/s", ""),
    ("duration", "Duration", "s", ""),
    ("separation", "Predicted difference", "1", "times the noise, over all samples"),
    ("file", "File for the rig", "", ""),
)


def next_test(test: Mapping[str, Any] | None, waveform: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """Return the sentence, facts and picture of the recommended test; None where there is none.

    test: `separating_test` of diagnosis.json; waveform: its "time" [s] and "deflection" [m]
    """
    if test is None:
        return None
    facts = []
    for key, title, unit, remark in FACTS:
        value = test.get(key)
        if not value:  # a tire is pressed from 0
            continue
        if key == "surfaces":
            text = titles.listed([words.surface(radius) for radius in value])
        elif isinstance(value, (int, float)):
            factor, name = words.scaled(unit)
            text = words.with_unit(words.number(factor * value), remark or name)
        else:
            text = str(value)
        facts.append((title, text))
    drawn = draw_waveform(waveform["time"], waveform["deflection"], "w") if waveform else None
    return {
        "sentence": test.get("sentence", ""),
        "facts": facts,
        "picture": drawn,
    }
