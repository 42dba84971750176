"""How well the place of a confined effect was found: overlap of the stated span with the true one.

J = |stated and true| / |stated or true|   (Jaccard index of spans of one coordinate, 0 to 1)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..diagnosis.diagnosis_file import StatedPlace
from ..recordings.recording import Recording
from ..recordings.units import UnitError, conversion

STATED_PART = 0.8
"""Part of the squared error stated along one coordinate whose spans, the weightiest first, are the stated region."""

UNITS = {"time": "s", "deflection": "m", "force": "N", "rate": "m/s", "radius": "m", "history": "m"}
"""SI unit of the coordinates that have one."""

Span = tuple[float, float]


@dataclass(frozen=True)
class PlaceScore:
    """Overlap for one confined effect along one coordinate; 0 where the verdict names no place along it."""

    effect: str
    by: str
    overlap: float


def place_scores(
    where: Sequence[Mapping[str, Any]], stated: Sequence[StatedPlace], recordings: Sequence[Recording]
) -> tuple[PlaceScore, ...]:
    """Return the overlap for every effect and coordinate in the answer's `where`.

    The stated region along a coordinate is made of its stated spans in falling order of their share of the squared
    error, until they hold `STATED_PART` of what all of them hold together. The mean over the recordings with samples
    in the true place counts; a place stated without its recording is meant in each of them. A direction is found or
    not: 1 or 0.
    """
    groups: dict[tuple[str, str], dict[str, list[Mapping[str, Any]]]] = {}
    for place in where:
        by_recording = groups.setdefault((str(place["effect"]), str(place["by"])), {})
        by_recording.setdefault(str(place["recording"]), []).append(place)
    by_name = {f"{r.name}.csv": r for r in recordings}
    scores = []
    for (effect, by), by_recording in groups.items():
        overlaps = []
        for name, places in by_recording.items():
            said = [
                p for p in stated if p.by == by and p.recording in (None, name, name.removesuffix(".csv"))
            ]
            if by == "direction":
                overlaps.append(_direction_overlap(str(places[0]["from"]), said))
            else:
                values = _coordinate(by, by_name[name])
                true = _inside(values, [_span(place["from"], place["to"]) for place in places])
                if true.any():
                    overlaps.append(_jaccard(true, _inside(values, _stated_region(said, by))))
        if overlaps:
            scores.append(PlaceScore(effect, by, float(np.mean(overlaps))))
    return tuple(scores)


def _direction_overlap(true: str, said: Sequence[StatedPlace]) -> float:
    if not said:
        return 0.0
    place = max(said, key=lambda p: p.share)
    ends = (place.begin, place.end)
    if any(isinstance(end, str) for end in ends):
        return float(true in ends)
    # as a number, unloading is negative
    middle = sum(float(end) for end in ends if end is not None)
    return float((middle < 0.0) == (true == "unloading"))


def _stated_region(said: Sequence[StatedPlace], by: str) -> list[Span]:
    whole = sum(p.share for p in said)
    region: list[Span] = []
    held = 0.0
    for place in sorted(said, key=lambda p: -p.share):
        if held >= STATED_PART * whole:
            break
        held += place.share
        factor = _to_si(place.unit, by)
        if factor is not None and not isinstance(place.begin, str) and not isinstance(place.end, str):
            low, high = _span(place.begin, place.end)
            region.append((factor * low, factor * high))
    return region


def _to_si(unit: str, by: str) -> float | None:
    if by not in UNITS:
        return 1.0
    try:
        found = conversion(unit, UNITS[by])
    except UnitError:
        return None
    return float(found.multiply / found.divide)


def _coordinate(by: str, recording: Recording) -> NDArray[np.float64]:
    if by == "rate":
        # over twenty steps, so that the gauge's noise does not drown it
        half = min(10, (len(recording) - 1) // 2)
        padded = [np.pad(v, half, mode="edge") for v in (recording.deflection, recording.time)]
        change, interval = (v[2 * half :] - v[: v.size - 2 * half] for v in padded)
        return np.asarray(change / interval)
    known = {"time": recording.time, "deflection": recording.deflection, "force": recording.force}
    return known.get(by, np.full(len(recording), np.nan))


def _span(begin: float | None, end: float | None) -> Span:
    return -np.inf if begin is None else float(begin), np.inf if end is None else float(end)


def _inside(values: NDArray[np.float64], spans: Sequence[Span]) -> NDArray[np.bool_]:
    """The samples that lie in one of the spans."""
    inside = np.zeros(values.shape, dtype=bool)
    for low, high in spans:
        inside |= (low <= values) & (values <= high)
    return inside


def _jaccard(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    either = int(np.sum(first | second))
    return float(np.sum(first & second) / either) if either else 0.0
