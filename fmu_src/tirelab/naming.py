"""What a settled set is called in a verdict, and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .explain.beyond import AGNOSTIC_FAMILIES, SURFACE
from .explain.search import Settled
from .titles import UNKNOWN

BEYOND = frozenset(f.name for f in (*AGNOSTIC_FAMILIES, SURFACE))

FORM_DOUBT = 0.5
"""Power to which odds between sets are taken: the forms of two sets err independently, each as allowed for."""

SUREST = 0.9
"""No verdict is surer than this: of 89 verdicts that nothing rivalled, on 140 trials of the independent rig, 81 were
right (its seeds 6400 to 6539)."""


CONCERNS: tuple[tuple[frozenset[str], frozenset[str]], ...] = (
    (
        frozenset({"deflection", "direction", "surface"}),
        frozenset(
            {
                "recalibration",
                "deflection_offset",
                "series_compliance",
                "gas_compression",
                "bottoming",
                "saturation",
            }
        ),
    ),
    (
        frozenset({"time", "time, added", "jump", "period", "period, added"}),
        frozenset({"pressure_leak", "warm_up", "force_drift", "mullins_softening"}),
    ),
    # Whatever changes with time has a mean, which is a factor or an offset.
    (frozenset({"time", "jump"}), frozenset({"recalibration"})),
    (frozenset({"time, added"}), frozenset({"force_offset"})),
    (
        frozenset({"rate", "rate and deflection", "acceleration", "resonance"}),
        frozenset({"viscous_damping", "viscoelastic_relaxation", "force_lag", "inertia"}),
    ),
)
"""Coordinates, and the effects that are told by them: where one stays unexplained, its effects cannot be named."""


SHADOW = 0.5
"""Beside something unknown an effect is named where its own part is at least this part of the unknown one: a smaller
one may be the unknown's shadow, which smooth functions alone do not follow."""


def named(settled: Settled) -> tuple[str, ...]:
    """Return the names of a settled set as a verdict gives them: none that may come from what stays unexplained."""
    beyond = BEYOND & set(settled.names)
    if not beyond:
        return tuple(n for n in settled.names if n != "shape")
    explained = settled.candidate.explained
    doubtful = beyond | {n for coordinates, effects in CONCERNS if coordinates & beyond for n in effects}
    unknown = max(s for n, s in zip(settled.names, explained.size, strict=True) if n in doubtful)
    known = [
        n
        for n, own in zip(settled.names, explained.unique, strict=True)
        if n not in doubtful and n != "shape" and own >= SHADOW * unknown
    ]
    return (*known, UNKNOWN)


def confidence_of(settled: Sequence[Settled]) -> float:
    """Return the probability of the first set's names among all sets that were settled."""
    logs = np.array([s.log_evidence for s in settled])
    weights = np.exp(FORM_DOUBT * (np.where(np.isfinite(logs), logs, -np.inf) - logs[0]))
    same = np.array([named(s) == named(settled[0]) for s in settled])
    return SUREST * float(np.sum(weights[same]) / np.sum(weights))
