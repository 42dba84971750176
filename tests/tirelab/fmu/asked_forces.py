"""The forces for which other people's importers ask an FMU of the article's tire, and those that they print."""

from __future__ import annotations

import json
import math

INPUTS = [[0.02, 1e5], [0.02, 0.254], [0.01, -0.381]]
"""Deflections [m] and surface radii [m]: flat, convex and concave."""

FORCES = [
    550.9 * 2**1.422,
    (550.9 - 337.8 * math.exp(-0.2519 * 25.4)) * 2 ** (1.422 - 0.2469 * math.exp(-0.1651 * 25.4)),
    550.9 + 7822.0 * math.exp(-0.1398 * 38.1),
]
"""The forces [N] there, from equations 2, 5 and 6 of the article."""


def forces(printed: str) -> list[float]:
    """Return the forces that a host has printed."""
    (line,) = [line for line in printed.splitlines() if line.startswith("forces ")]
    found = json.loads(line.removeprefix("forces "))
    assert isinstance(found, list)
    return found
