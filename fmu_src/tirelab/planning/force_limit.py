"""How deep a rig may go where its load cell, or its press, takes no more than some force."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from .waveforms import Limits

HALVINGS = 10
"""Halvings of the stroke: it is known to a thousandth."""


def depth_within(force: float, deepest: float, peak: Callable[[float], float]) -> float:
    """Return the largest depth [m] up to `deepest` at which no motion exceeds a force [N]; 0.0 if there is none.

    peak: the largest force [N] of either sign over all motions to a depth [m], which grows with it
    """
    if math.isinf(force) or peak(deepest) <= force:
        return deepest
    within, beyond = 0.0, deepest
    for _ in range(HALVINGS):
        middle = 0.5 * (within + beyond)
        if peak(middle) <= force:
            within = middle
        else:
            beyond = middle
    return within


def limits_within_force(limits: Limits, peak: Callable[[Limits], float]) -> Limits | None:
    """Return limits with the stroke that keeps within their force; None if no stroke does. peak: see `depth_within`."""
    depth = depth_within(limits.force, limits.deepest, lambda deepest: peak(replace(limits, deepest=deepest)))
    return replace(limits, deepest=depth) if depth else None
