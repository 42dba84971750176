"""What a settled set is called in a verdict."""

from __future__ import annotations

from ..names import UNKNOWN
from .beyond import AGNOSTIC_FAMILIES, SURFACE
from .search import Settled

BEYOND = frozenset(f.name for f in (*AGNOSTIC_FAMILIES, SURFACE))

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
    # What acts on one way only has half of itself in the mean of both.
    (frozenset({"rate and deflection"}), frozenset({"bottoming", "saturation"})),
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
