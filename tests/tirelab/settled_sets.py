"""Settled sets as the search returns them, of which only names, evidence and sizes are known."""

from __future__ import annotations

import numpy as np
from tirelab.engine.columns import Layout
from tirelab.engine.evidence import Explained, Products
from tirelab.engine.judge import Candidate
from tirelab.engine.place import Point
from tirelab.engine.search import Settled


def settled(evidence: float, sizes: dict[str, float]) -> Settled:
    """Return a set with its log evidence; sizes: of each of its families over the noise, nothing shared with others."""
    own = tuple(sizes.values())
    explained = Explained(evidence, 1.0, (), own, own, 0.0)
    return Settled(
        Candidate(tuple(sizes), evidence, evidence, (), explained),
        Point(np.zeros((1, 4))),
        Products(np.zeros((0, 0)), np.zeros(0), 1.0, 1, np.zeros(0)),
        Layout({}, {}, {}, {}),
    )
