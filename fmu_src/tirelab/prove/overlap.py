"""How well the place of a confined effect was found: overlap of the stated span with the true one.

J = |stated and true| / |stated or true|   (Jaccard index of spans of one coordinate, 0 to 1)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..recording import Recording
from ..stated import StatedPlace
from ..units import UnitError, conversion

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
    error, until they hold `STATED_PART` of what all of them hold together. Both regions are cut to what the recordings
    cover. An effect confined differently in several recordings (times) counts with the mean over them; a place stated
    without its recording counts for each of them. A direction is found or not: 1 or 0.
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
                within = _covered(by, [by_name[name]] if by == "time" else list(recordings))
                true = [_cut(place["from"], place["to"], within) for place in places]
                overlaps.append(_jaccard(true, _stated_region(said, by, within)))
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


def _stated_region(said: Sequence[StatedPlace], by: str, within: Span) -> list[Span]:
    whole = sum(p.share for p in said)
    region: list[Span] = []
    held = 0.0
    for place in sorted(said, key=lambda p: -p.share):
        if held >= STATED_PART * whole:
            break
        held += place.share
        factor = _to_si(place.unit, by)
        begin, end = place.begin, place.end
        if factor is None or isinstance(begin, str) or isinstance(end, str):
            continue
        region.append(
            _cut(None if begin is None else factor * begin, None if end is None else factor * end, within)
        )
    return region


def _to_si(unit: str, by: str) -> float | None:
    if by not in UNITS:
        return 1.0
    try:
        found = conversion(unit, UNITS[by])
    except UnitError:
        return None
    return float(found.multiply / found.divide)


def _covered(by: str, recordings: Sequence[Recording]) -> Span:
    values = np.concatenate([_coordinate(by, r) for r in recordings])
    return (float(np.min(values)), float(np.max(values))) if values.size else (-np.inf, np.inf)


def _coordinate(by: str, recording: Recording) -> NDArray[np.float64]:
    if by == "rate":
        # twenty steps apart, so that the gauge's noise does not widen the range
        lag = min(20, len(recording) - 1)
        x, t = recording.deflection, recording.time
        return np.asarray((x[lag:] - x[:-lag]) / (t[lag:] - t[:-lag]))
    known = {"time": recording.time, "deflection": recording.deflection, "force": recording.force}
    return known.get(by, np.empty(0))


def _cut(begin: float | None, end: float | None, within: Span) -> Span:
    low = within[0] if begin is None else float(begin)
    high = within[1] if end is None else float(end)
    return max(low, within[0]), min(high, within[1])


def _jaccard(first: Sequence[Span], second: Sequence[Span]) -> float:
    """Jaccard index of two unions of spans: on the grid of all ends, each cell lies in a union or not."""
    ends = np.unique([end for span in (*first, *second) if span[1] > span[0] for end in span])
    if ends.size < 2:
        return 0.0
    middles, widths = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
    inside = [
        np.any(
            [(low < middles) & (middles < high) for low, high in spans] or [np.zeros(middles.size, bool)],
            axis=0,
        )
        for spans in (first, second)
    ]
    return float(np.sum(widths[inside[0] & inside[1]]) / np.sum(widths[inside[0] | inside[1]]))
