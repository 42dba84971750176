"""Recordings that contradict each other: one of them is of another tire, pressure or zero.

Where something stays unexplained, the verdict's set and a refitted law are fitted once more without each recording in
turn. A recording contradicts the others where they are explained without it, and it is not explained by them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..estimation.explanation import Explanation
from ..names import REFITTED_LAW
from ..preprocessing.dataset import Recorded
from ..preprocessing.kinematics import FloatArray
from .held_out import rmse

EXPLAINED = 0.5
"""Part of the error on the others that is left where they are explained without the one that contradicts them."""


@dataclass(frozen=True)
class Contradiction:
    """names: of the recordings, one of three or more, or both of two; without [N]: error on the others where they are
    fitted alone, together [N]: where all are; own [N]: error of the fit to the others on the one itself.
    """

    names: tuple[str, ...]
    without: float
    together: float
    own: float

    @property
    def sentence(self) -> str:
        """What is said of it."""
        if len(self.names) > 1:
            whose = f"Recordings {' and '.join(self.names)} contradict each other"
            each = f"each alone is explained to {self.without:.3g} N, both together to {self.together:.3g} N"
        else:
            whose = f"Recording {self.names[0]} contradicts the others"
            each = (
                f"they are explained to {self.without:.3g} N without it, and it is {self.own:.3g} N off them"
            )
        return f"{whose}: {each}; check tire, pressure and zero of each, or diagnose them apart."


def contradiction_of(explanation: Explanation, recordings: Sequence[Recorded]) -> Contradiction | None:
    """Return the recording that contradicts the others, None where there is none or all are explained together."""
    if len(recordings) < 2 or not explanation.remainder.unexplained:
        return None
    found = []
    for chosen in _with_law(explanation):
        for number, recording in enumerate(recordings):
            kept = [np.full(r.time.size, i != number) for i, r in enumerate(recordings)]
            residuals = chosen.refitted(kept).residuals
            without, together = (_others(r, number) for r in (residuals, chosen.residuals))
            own, level = rmse([residuals[number]]), chosen.floors[number].level
            if without < EXPLAINED * together and own > max(rmse([chosen.residuals[number]]), 3.0 * level):
                found.append(Contradiction((recording.name,), without, together, own))
    if not found:
        return None
    if len(recordings) == 2 and len({c.names for c in found}) == 2:
        both = tuple(r.name for r in recordings)
        whole = rmse(explanation.residuals)
        return Contradiction(both, max(c.without for c in found), whole, max(c.own for c in found))
    return min(found, key=lambda c: c.without)


def _with_law(explanation: Explanation) -> list[Explanation]:
    """Return the verdict's set, and the refitted law alone where it was fitted and the set has none."""
    names = {e.name for e in explanation.effects}
    if REFITTED_LAW in names or (REFITTED_LAW,) not in {e.names for e in explanation.evidence}:
        return [explanation]
    return [explanation, explanation.of((REFITTED_LAW,))]


def _others(residuals: Sequence[FloatArray], number: int) -> float:
    return rmse([r for i, r in enumerate(residuals) if i != number])
