"""What the page's header shows: the first screen with its picture and its links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import first_screen, titles, words
from .delivered import delivered_of
from .loops import Case
from .places import Located, draw_where, shaded

MOST_PLACES = 8
"""Places from which those of the picture are chosen."""

MOST_TOLD = 2
"""Places that the first screen tells in words."""


def header(diagnosis: Mapping[str, Any], fitted: Sequence[Case], reasons: Sequence[str]) -> dict[str, Any]:
    """What the first screen shows: see `first_screen`."""
    verdict, noise = diagnosis["verdict"], float(diagnosis["fit"]["noise"])
    residuals = diagnosis["located"]
    if not residuals or [len(r) for r in residuals] != [len(c.recording) for c in fitted]:
        residuals = [c.recording.force - c.before for c in fitted]
    located = [
        Located(c.recording, np.asarray(r, float), c.before) for c, r in zip(fitted, residuals, strict=True)
    ]
    where = words.foremost(diagnosis["where"], MOST_PLACES)
    worst = max(located, key=lambda at: float(np.sum(at.residual**2)))
    places = shaded(where, worst)
    test = verdict["separating_test"] or {}
    return {
        "headline": first_screen.headline(diagnosis),
        "lead": first_screen.lead(diagnosis),
        "sure": first_screen.sureness(verdict),
        "undecided": first_screen.undecided(verdict),
        "figures": first_screen.figures(diagnosis),
        "picture": draw_where(worst, places, noise, "where"),
        "recording": worst.recording.name if len(located) > 1 else "",
        "where": _where(places or where[:MOST_TOLD]),
        "is_shaded": bool(places),
        "next": (step := first_screen.next_step(diagnosis, reasons)),
        "drive": test.get("file") if step.drive else None,
        "links": [
            (title, name)
            for title, name in (
                *delivered_of(diagnosis).files,
                ("Drive file", test.get("file")),
                ("Plot data", diagnosis.get("data")),
                ("Numbers", "diagnosis.json" if diagnosis.get("tire") else None),
            )
            if name
        ],
    }


def _where(places: Sequence[Mapping[str, Any]]) -> str:
    """Return the first MOST_TOLD places in words, a coordinate once, and how many more there are."""
    if not places:
        return "no place differs from noise"
    told = []
    for before, place in zip([None, *places], places[:MOST_TOLD], strict=False):
        new = before is None or before["by"] != place["by"]
        phrase = words.where_phrase(place, coordinate_too=new)
        told.append(f"{phrase} ({words.percent(place['share'])}{' of the error' if before is None else ''})")
    more = len(places) - len(told)
    return titles.listed([*told, f"{more} more"] if more > 0 else told)
