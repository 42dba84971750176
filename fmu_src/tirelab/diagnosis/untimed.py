"""What can still be told of recordings whose time was not measured: nothing over time, rate or acceleration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..estimation.remainder import Remainder
from ..preprocessing.dataset import Recorded
from .localization import Span

OF_TIME = frozenset({"time", "rate", "acceleration"})
"""Coordinates that need the times of the samples."""


def is_timed(recordings: Sequence[Recorded]) -> bool:
    """Whether the time of every recording was measured; one that does not say it was."""
    return all(getattr(recording, "timed", True) for recording in recordings)


def places_told(places: Sequence[Span], timed: bool) -> tuple[Span, ...]:
    """Return the places that can be told."""
    return tuple(place for place in places if timed or place.by not in OF_TIME)


def remainder_told(remainder: Remainder, timed: bool) -> Remainder:
    """Return a remainder without what it depends on in time."""
    if timed:
        return remainder
    return replace(remainder, depends=tuple(d for d in remainder.depends if d.coordinate not in OF_TIME))
