"""Numbers that stand side by side in a row of C: they are copied at once."""

from __future__ import annotations

import re

WIDTH = 116

PLACE = re.compile(r"^(.+)\[(\d+)\]$")
"""A number at a constant place of a row or of an array."""

LONG = 4
"""Fewest neighbours that are copied together."""


def run_of(texts: list[str]) -> int:
    """Return how many texts from the first on name neighbours: x[3], x[4], x[5]."""
    found = [PLACE.match(text) for text in texts]
    count = 1
    while count < len(texts):
        a, b = found[count - 1], found[count]
        if a is None or b is None or a[1] != b[1] or int(b[2]) != int(a[2]) + 1:
            break
        count += 1
    return count
